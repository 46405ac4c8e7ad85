"""Figures in real time: a simulated wire on a pseudo-terminal, and real masters, threads and sleeps on this host."""
import json
import os
import random
import subprocess
import time

import masters
import scenes
import traces
from figures import histogram, median, pair_ratios, percentile, ratio, spread, summary
from in_virtual_time import BIN, BINS
from simulated_wire import SimulatedWire

WIRE_PRIORITY = 50
"""Of the simulated wire, where the host permits it: what is measured is the master, not the wire."""


def bench(programs, what, *options):
    """What bus_benchmark prints: both ends in one process."""
    command = [os.path.join(programs, 'bus_benchmark'), what, '--realtime-priority', WIRE_PRIORITY] + list(options)
    output = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, check=True)
    return json.loads(output.stdout.decode())


def wire_error(programs, calls):
    """The simulated wire's own timing error, in parts of a character, and what a master sees of wire and host together."""
    found = []
    for baud in (9600, 19200, 115200):
        played = bench(programs, 'wire', '--inverters', 1, '--baud', baud, '--calls', calls)
        found.append({'baud': baud, 'character': played['character'], 'mean': played['mean'], 'latest': played['latest'],
                      'share': played['mean'] / played['character'], 'seen_median': median(played['seen']),
                      'seen_p99': percentile(played['seen'], 0.99)})
    return found


# --- refresh ---------------------------------------------------------------------------------------------------------

def watch(programs, scene, begin, seconds, before):
    """One master on a wire of its own. begin(wire, time that it runs) starts it; `before` [s] pass before anything counts."""
    with SimulatedWire(programs, scene, WIRE_PRIORITY) as wire:
        master = begin(wire, before + seconds + 3.0)
        time.sleep(before)
        start = time.monotonic()
        time.sleep(seconds)
        frames = traces.within(wire.frames(), start, start + seconds)
        master.end()
        wire.end()
        return {'cycle': traces.cycle(frames), 'wire_use': traces.wire_use(frames, scene.baud, seconds),
                'early': traces.early_share(frames), 'wire_late': wire.late}


def driver(programs, wire, seconds):
    """It starts all motors shortly before it is measured."""
    return masters.Driver(programs, wire, seconds, scenes.warm_up(wire.scene) - 2.0)


def refresh(programs, before_programs, scene, rounds, seconds):
    """Cycles of this driver, the build before, and the plain loop with and without legal gaps, in alternation."""
    contestants = [('legal', programs, lambda wire, run: masters.PlainLoop(programs, wire, run, 'legal'), 1.0),
                   ('illegal', programs, lambda wire, run: masters.PlainLoop(programs, wire, run, 'none'), 1.0),
                   ('driver', programs, lambda wire, run: driver(programs, wire, run), scenes.warm_up(scene))]
    if before_programs:
        contestants.append(('before', programs, lambda wire, run: driver(before_programs, wire, run),
                            scenes.warm_up(scene)))
    cycles = {name: [] for name, *_ in contestants}
    found = {}
    for _ in range(rounds):
        for name, simulator, begin, warm_up in contestants:
            seen = watch(simulator, scene, begin, seconds, warm_up)
            cycles[name].append(seen['cycle'])
            found[name] = {'cycle': median(cycles[name]), 'spread': spread(cycles[name]), 'wire_use': seen['wire_use'],
                           'early': seen['early']}
    for other in cycles:
        if other != 'driver':
            found[other]['ratio'] = median(pair_ratios(cycles['driver'], cycles[other]))
            found[other]['ratio_spread'] = spread(pair_ratios(cycles['driver'], cycles[other]))
    return found


def whole_status(programs, seconds):
    """5 MX2 at 19200 whose map is used, against the plain loop without legal gaps in the same run."""
    scene = scenes.MAPPED
    try:
        seen = watch(programs, scene, lambda wire, run: driver(programs, wire, run), seconds, scenes.warm_up(scene))
    except RuntimeError as error:
        return {'missing': 'this build has no configure_map' if 'configure_map' in str(error) else str(error)}
    loop = watch(programs, scenes.SCENES[1], lambda wire, run: masters.PlainLoop(programs, wire, run, 'none'), seconds, 1.0)
    return {'cycle': seen['cycle'], 'illegal': loop['cycle'], 'ratio': ratio(seen['cycle'], loop['cycle'])}


# --- latencies -------------------------------------------------------------------------------------------------------

def stops(programs, inverters, dead, calls):
    played = bench(programs, 'stops', '--inverters', inverters, '--dead', dead, '--calls', calls, '--warm-up',
                   scenes.warm_up(scenes.Scene(inverters, 19200, 'omron_mx2')))
    return {'inverters': inverters, 'dead': dead, 'stops': summary(played['stops']),
            'confirmed': summary(played['confirmed']), 'wake_ups': summary(played['wake_ups']),
            'histogram': histogram(played['stops'], BIN, BINS)}


def commands(programs, inverters, load, calls):
    played = bench(programs, 'commands', '--inverters', inverters, '--load', load, '--calls', calls, '--warm-up',
                   scenes.warm_up(scenes.Scene(inverters, 19200, 'omron_mx2')))
    return {'inverters': inverters, 'load': load, 'commands': summary(played['commands']),
            'wake_ups': summary(played['wake_ups'])}


# --- cost ------------------------------------------------------------------------------------------------------------

def cost(programs, drivers, scene, seconds):
    """CPU and memory of the driver without ROS. drivers: where its program is."""
    with SimulatedWire(programs, scene, WIRE_PRIORITY) as wire:
        master = masters.Driver(drivers, wire, seconds, scenes.warm_up(scene))
        output = master.wait(scenes.warm_up(scene) + seconds + 30.0)
        figures = json.loads(output.strip().splitlines()[-1])
    return {'share': figures['cpu'] / figures['seconds'], 'resident_kb': figures['resident_kb'],
            'per_exchange': ratio(figures['cpu'], figures['exchanges']), 'exchanges': figures['exchanges'],
            'seconds': figures['seconds']}


# --- others ----------------------------------------------------------------------------------------------------------

def contestants(programs):
    """(name, why not, scene, how it begins, [s] until it counts) of everybody who can be on the wire."""
    five, one = scenes.Scene(5, 19200, 'omron_mx2'), scenes.Scene(1, 19200, 'omron_mx2')
    pump = scenes.Scene(1, 19200, 'toshiba_vfs15')
    linuxcnc, pymodbus = masters.lacks_linuxcnc(), masters.lacks_pymodbus()

    def ours(scene):
        return ('inverter_bus', None, scene, lambda wire, run: driver(programs, wire, run), scenes.warm_up(scene))

    return [ours(five),
            ('libmodbus loop, legal gaps', None, five, lambda wire, run: masters.PlainLoop(programs, wire, run, 'legal'), 1.0),
            ('libmodbus loop', None, five, lambda wire, run: masters.PlainLoop(programs, wire, run, 'none'), 1.0),
            ('pymodbus loop', pymodbus, five, lambda wire, run: masters.Pymodbus(programs, wire, run), 3.0),
            ('mb2hal', linuxcnc, five, lambda wire, run: masters.Mb2hal(programs, wire, run), 5.0),
            ours(one), ('wj200_vfd', linuxcnc, one, lambda wire, run: masters.Wj200(programs, wire, run), 6.0),
            ours(pump), ('vfs11_vfd', linuxcnc, pump, lambda wire, run: masters.Vfs11(programs, wire, run), 8.0)]


def stop_latencies(wire, master, stations, calls, chance):
    """[s] from a stop to the first byte of its frame, at random instants."""
    asked = []
    for _ in range(calls):
        time.sleep(chance.uniform(0.1, 0.4))
        station = chance.randint(1, stations)
        asked.append((time.monotonic(), station))
        master.stop(station)
        time.sleep(1.2 if hasattr(master, 'run') else 0.4)
        if hasattr(master, 'run'):
            master.run()
            time.sleep(0.8)
    frames = wire.frames()
    return [traces.delay_to(frames, since, master.stopped(station)) for since, station in asked]


def beside(programs, contestant, seconds, calls, chance):
    """Everything about one contestant on its wire: cycle, then stops, then (with several drives) one that is dead."""
    name, missing, scene, begin, warm_up = contestant
    found = {'name': name, 'scene': scenes.title(scene), 'missing': missing}
    if missing:
        return found
    with SimulatedWire(programs, scene, WIRE_PRIORITY) as wire:
        master = begin(wire, warm_up + 2 * seconds + 4.0 * calls + 60.0)
        time.sleep(warm_up)
        start = time.monotonic()
        time.sleep(seconds)
        frames = traces.within(wire.frames(), start, start + seconds)
        found.update(cycle=traces.cycle(frames), wire_use=traces.wire_use(frames, scene.baud, seconds),
                     early=traces.early_share(frames))
        stations = 1 if hasattr(master, 'run') else scene.inverters
        found['stops'] = summary(stop_latencies(wire, master, stations, calls, chance))
        if scene.inverters > 2:
            wire.command('belt_3 offline')
            time.sleep(5.0)
            start = time.monotonic()
            time.sleep(max(seconds, 8.0))
            live = [frame for frame in traces.within(wire.frames(), start, time.monotonic()) if frame.station != '3']
            found['one_dead'] = traces.cycle(live)
        master.end()
    return found


def others(programs, seconds, calls):
    chance = random.Random(1)
    return [beside(programs, contestant, seconds, calls, chance) for contestant in contestants(programs)]
