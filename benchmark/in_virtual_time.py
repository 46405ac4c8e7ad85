"""Figures in virtual time (virtual_benchmark): no host is in them, and every machine gets the same."""
import json
import os
import subprocess

import scenes
from figures import histogram, mean, median, ratio, summary

BAUDS = (2400, 4800, 9600, 19200, 38400, 57600, 115200)
NUMBERS = (1, 2, 5, 10, 20, 31)
DEAD = (1, 3, 6, 15)
STOP_CASES = ((0, 'silent'), (3, 'silent'), (15, 'silent'), (3, 'late'), (15, 'late'), (3, 'broken'), (15, 'broken'))
BIN = 0.005
"""[s] width of a bar in the pictures of stop latencies."""
BINS = 22


def play(programs, what, *options):
    """What virtual_benchmark prints; None where the build has none (it needs GoogleTest)."""
    program = os.path.join(programs, 'virtual_benchmark')
    if not os.path.exists(program):
        return None
    output = subprocess.run([program, what] + [str(option) for option in options], stdout=subprocess.PIPE, check=True)
    return json.loads(output.stdout.decode())


def options_of(scene):
    return ['--inverters', scene.inverters, '--baud', scene.baud, '--drive', scene.drive] + (['--mapped'] if scene.mapped else [])


def refresh(programs, scene, seconds):
    """Periods [s] of the driver and of the plain loop with legal gaps, by median and mean."""
    played = play(programs, 'refresh', '--seconds', seconds, *options_of(scene))
    if played is None:
        return None
    driver, plain = played['driver']['periods'], played['plain']['periods']
    return {'median': median(driver), 'mean': mean(driver), 'plain': median(plain), 'wire_use': played['driver']['wire_use'],
            'plain_wire_use': played['plain']['wire_use'], 'ratio': ratio(median(driver), median(plain)),
            'mean_ratio': ratio(mean(driver), mean(plain))}


def curve(programs, chosen, seconds):
    """refresh() of several scenes: what is drawn as a line."""
    found = [(scene, refresh(programs, scene, seconds)) for scene in chosen]
    return [dict(one, inverters=scene.inverters, baud=scene.baud) for scene, one in found if one is not None]


def against_baud(programs, seconds):
    return curve(programs, [scenes.Scene(5, baud, 'omron_mx2') for baud in BAUDS], seconds)


def against_number(programs, seconds):
    return curve(programs, [scenes.Scene(number, 19200, 'omron_mx2') for number in NUMBERS], seconds)


def dead_drives(programs, seconds):
    """31 MX2 at 19200, some of them silent: cycle of the others, alone and beside them, and [s] until all are back."""
    found = []
    for dead in DEAD:
        played = play(programs, 'dead', '--inverters', 31, '--dead', dead, '--seconds', seconds)
        if played is None:
            return []
        beside, alone = median(played['periods']), median(played['alone'])
        found.append({'dead': dead, 'beside': beside, 'alone': alone, 'ratio': ratio(beside, alone),
                      'mean_ratio': ratio(mean(played['periods']), mean(played['alone'])),
                      'back': max(played['back']) if min(played['back']) >= 0 else None,
                      'plain': median(played['plain']['periods'])})
    return found


def stops(programs, instants):
    """31 MX2 at 19200 under full load, stops at random instants: latency of the driver and of a queue."""
    found = []
    for dead, fault in STOP_CASES:
        played = play(programs, 'stops', '--inverters', 31, '--dead', dead, '--fault', fault, '--instants', instants)
        if played is None:
            return []
        found.append(dict(summary(played['stops']), dead=dead, fault=fault, histogram=histogram(played['stops'], BIN, BINS)))
    return found


def queue(programs, instants):
    """The same users in front of one queue (first come, first served)."""
    found = []
    for dead in (0, 3, 15):
        played = play(programs, 'fifo', '--inverters', 31, '--dead', dead, '--instants', instants)
        if played is None:
            return []
        found.append(dict(summary(played['stops']), dead=dead, histogram=histogram(played['stops'], BIN, BINS)))
    return found


def velocities(programs, instants):
    """From a velocity at a random instant to the first byte of the frame that writes it."""
    found = []
    for inverters in (5, 31):
        for load in ('idle', 'full'):
            played = play(programs, 'velocities', '--inverters', inverters, '--load', load, '--instants', instants)
            if played is None:
                return []
            found.append({'inverters': inverters, 'load': load, 'commands': summary(played['velocities'])})
    return found
