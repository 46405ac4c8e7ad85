#!/usr/bin/env python3
"""The scene of the demo: a conveyor line is started, sped up, stopped, tripped, reset and stopped.

Everything goes through the driver's topics and services, as in any application: velocities at 10 Hz on
<bus>/<belt>/command, stop, reset and read_faults by service. Each step waits until it is seen in the belts' status
messages. A fault is injected through the simulated bus, which plays the drives.

On a terminal it shows a live table and plays until Ctrl-C, which stops every motor and says so. With --once, or without
a terminal, it prints plain lines, plays once, and ends with status 0 only if every step was really seen.

Parameters: ~bus (the driver's node name), ~simulator (the simulated bus's node name), ~once, ~slow and ~fast
(velocities, in the belts' unit).
"""
import argparse
import collections
import math
import os
import shutil
import signal
import sys
import threading
import time

import rosgraph
import rospy
from inverter_bus.msg import BusStatus, InverterStatus
from inverter_bus.srv import InjectFault, ReadFaults, Reset, Stop, StopRequest
from std_msgs.msg import Float64

COMMAND_RATE = 10.0  # [Hz], well above what command_timeout asks for
PATIENCE = 45.0  # [s] for a step to be seen: generous, for busy machines
TRIP_CODE = 7  # overvoltage on an MX2


def write(text):
    """To the terminal. One that is gone, or a pipe that nobody reads any more, ends the scene as Ctrl-C does."""
    try:
        sys.stdout.write(text)
        sys.stdout.flush()
    except OSError:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        for stream in (1, 2):
            os.dup2(nowhere, stream)
        os.kill(os.getpid(), signal.SIGHUP)


class Ended(Exception):
    """Ctrl-C, or the ROS master went away."""


class StepFailed(Exception):
    """A step was not seen in the status messages."""


class Belt:
    """One inverter: what it should do, and what its status says."""

    def __init__(self, bus, name):
        self.name = name
        self.velocity = None  # None: no commands are sent
        self.status = None
        self.received = 0.0
        self.errors_seen = set()
        self.command = rospy.Publisher('%s/%s/command' % (bus, name), Float64, queue_size=1)
        self.stop = rospy.ServiceProxy('%s/%s/stop' % (bus, name), Stop)
        self.reset = rospy.ServiceProxy('%s/%s/reset' % (bus, name), Reset)
        self.read_faults = rospy.ServiceProxy('%s/%s/read_faults' % (bus, name), ReadFaults)
        rospy.Subscriber('%s/%s/status' % (bus, name), InverterStatus, self.on_status, queue_size=10)

    def on_status(self, status):
        if status.error_id:
            self.errors_seen.add(status.error_id)
        self.received = time.monotonic()
        self.status = status

    def online(self):
        return self.status is not None and not self.status.communication_error

    def ready(self):
        """The drive would follow a RUN, as far as it can tell."""
        return self.status.ready or not self.status.known & InverterStatus.KNOWN_READY

    def runs_at(self, velocity):
        status = self.status
        return (self.online() and status.running and not status.faulted and
                abs(status.velocity - velocity) <= 0.02 * abs(velocity))

    def at_rest(self):
        return self.online() and not self.status.running and not self.status.run_command

    def state(self):
        """One word for the table, and its colour."""
        status = self.status
        if status is None:
            return 'waiting', 'grey'
        if status.communication_error:
            return 'OFFLINE', 'red'
        if status.faulted:
            return 'TRIPPED', 'red'
        if status.stop_active:
            return 'stopping', 'yellow'
        if status.running and not status.run_command:
            return 'slowing', 'yellow'
        if status.running and status.at_speed:
            return 'running', 'green'
        if status.running:
            return 'ramping', 'cyan'
        if status.locked:
            return 'locked', 'grey'
        return 'ready', 'blue'


class Line:
    """The belts of one bus, a stream of commands to each, and the bus as a whole."""

    def __init__(self, bus, simulator):
        self.bus = bus
        self.ended = threading.Event()
        self.bus_status = None
        self.peak_current = 1.0
        self.belts = [Belt(bus, name) for name in self.belt_names()]
        self.stop_all = rospy.ServiceProxy(bus + '/stop', Stop)
        self.simulate = rospy.ServiceProxy(simulator + '/command', InjectFault)
        rospy.Subscriber(bus + '/bus_status', BusStatus, self.on_bus_status, queue_size=1)
        self.stream = threading.Thread(target=self.send_commands, daemon=True)
        self.stream.start()

    def belt_names(self):
        """Names in the driver's scan list; waits for roslaunch to load it."""
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            entries = rospy.get_param(self.bus + '/scan_list', None)
            if isinstance(entries, list) and entries:
                return [entry['name'] for entry in sorted(entries, key=lambda entry: entry['node'])]
            time.sleep(0.1)
        raise StepFailed('no scan list on %s' % rospy.resolve_name(self.bus + '/scan_list'))

    def on_bus_status(self, status):
        self.bus_status = status

    def send_commands(self):
        while not self.ended.wait(1.0 / COMMAND_RATE):
            for belt in self.belts:
                velocity = belt.velocity
                if velocity is not None and not rospy.is_shutdown():
                    belt.command.publish(velocity)

    def set_velocity(self, velocity, belts=None):
        for belt in belts or self.belts:
            belt.velocity = velocity


class Scene:
    """The steps, in order. Each names itself, acts, and waits until it is seen."""

    def __init__(self, line, slow, fast, show):
        self.line = line
        self.slow = slow
        self.fast = fast
        self.show = show
        self.interrupted = threading.Event()

    def play(self):
        belts = self.line.belts
        lone = belts[min(1, len(belts) - 1)]
        victim = belts[min(2, len(belts) - 1)]
        self.step('Find the drives', self.find_drives)
        self.step('Start the line: %s at %g' % (count(belts), self.slow), lambda: self.run_all(self.slow))
        self.step('Change the speed to %g' % self.fast, lambda: self.run_all(self.fast))
        self.step('Stop %s alone; the others run on' % lone.name, lambda: self.stop_one(lone))
        self.step('Its stream of commands goes on, and is refused', lambda: self.see_refusal(lone))
        self.step('A command of 0 unlocks it; start it again', lambda: self.restart(lone))
        self.step('%s trips (code %d); the others run on' % (victim.name, TRIP_CODE), lambda: self.trip(victim))
        self.step('Read its fault memory', lambda: self.read_memory(victim))
        self.step('Reset it; it does not start by itself', lambda: self.reset(victim))
        self.step('Start it again', lambda: self.restart(victim))
        self.step('Stop the whole bus', self.stop_all)

    def step(self, title, action):
        self.show.begin(title)
        start = time.monotonic()
        try:
            detail = action()
        except (rospy.ServiceException, rospy.ROSException) as error:
            if self.interrupted.is_set() or rospy.is_shutdown():
                raise Ended() from error
            raise StepFailed('%s: %s' % (title, error)) from error
        except StepFailed as error:
            raise StepFailed('%s: %s' % (title, error)) from error
        self.show.done(title, detail, time.monotonic() - start)

    def wait(self, what, condition, patience=PATIENCE):
        deadline = time.monotonic() + patience
        look_at_master = time.monotonic() + 3.0
        while not condition():
            if self.interrupted.is_set() or rospy.is_shutdown():
                raise Ended()
            if time.monotonic() > look_at_master:
                look_at_master += 3.0
                if not rosgraph.is_master_online():
                    raise StepFailed('the ROS master is gone: a node ended')
            if time.monotonic() > deadline:
                raise StepFailed('%s was not seen within %.0f s; %s' % (what, patience, self.describe()))
            time.sleep(0.02)

    def watch(self, seconds, what, condition):
        """The condition holds all that time."""
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            if self.interrupted.is_set() or rospy.is_shutdown():
                raise Ended()
            if not condition():
                raise StepFailed('%s did not hold; %s' % (what, self.describe()))
            time.sleep(0.02)

    def describe(self):
        return '; '.join(describe(belt) for belt in self.line.belts)

    def others(self, belt):
        return [other for other in self.line.belts if other is not belt]

    def find_drives(self):
        belts = self.line.belts
        self.wait('every drive online and ready', lambda: all(belt.online() and belt.ready() for belt in belts))
        self.unlock(belts)
        return ', '.join('%s (station %d)' % (belt.name, belt.status.node) for belt in belts)

    def unlock(self, belts):
        """At start-up and after a stop an inverter takes no velocity until it was sent 0 (or nothing at all)."""
        self.line.set_velocity(0.0, belts)
        self.wait('the lock released by a command of 0', lambda: not any(belt.status.locked for belt in belts))

    def run_all(self, velocity):
        belts = self.line.belts
        self.line.set_velocity(velocity)
        self.wait('all belts at %g' % velocity, lambda: all(belt.runs_at(velocity) for belt in belts))
        self.watch(1.0, 'all belts at %g' % velocity, lambda: all(belt.runs_at(velocity) for belt in belts))
        self.pause()
        return 'all at speed'

    def stop_one(self, belt):
        belt.errors_seen.clear()
        answer = belt.stop(mode=StopRequest.DECELERATE)
        if not answer.success:
            raise StepFailed('the stop was not confirmed: ' + answer.message)
        self.wait('%s at rest' % belt.name, belt.at_rest)
        if not all(other.runs_at(self.fast) for other in self.others(belt)):
            raise StepFailed('another belt was disturbed; ' + self.describe())
        return answer.message

    def see_refusal(self, belt):
        self.wait('%s locked and its command refused' % belt.name,
                  lambda: belt.status.locked and InverterStatus.ERROR_LOCKED in belt.errors_seen)
        self.watch(1.0, '%s at rest under a stream of commands' % belt.name, belt.at_rest)
        return 'error id 0x%04X' % InverterStatus.ERROR_LOCKED

    def restart(self, belt):
        self.unlock([belt])
        belt.velocity = self.fast
        self.wait('%s at %g' % (belt.name, self.fast), lambda: belt.runs_at(self.fast))
        self.pause()

    def trip(self, belt):
        answer = self.line.simulate('%s trip %d' % (belt.name, TRIP_CODE))
        if not answer.success:
            raise StepFailed('the simulated bus refused to trip it: ' + answer.message)
        self.wait('%s faulted, with a text' % belt.name, lambda: belt.status.faulted and belt.status.fault_text)
        if not all(other.runs_at(self.fast) for other in self.others(belt)):
            raise StepFailed('another belt was disturbed; ' + self.describe())
        self.pause()
        return '%d: %s' % (belt.status.fault_code, belt.status.fault_text)

    def read_memory(self, belt):
        answer = belt.read_faults()
        if not answer.success:
            raise StepFailed(answer.message)
        if answer.present.code != TRIP_CODE or not answer.faults or answer.faults[0].code != TRIP_CODE:
            raise StepFailed('the drive reports trip %d' % answer.present.code)
        fault = answer.faults[0]
        return '%s, %s and %s when it tripped; %d in its memory' % (
            value('%.2f Hz', fault.output_frequency), value('%.1f A', fault.output_current),
            value('%.0f V', fault.dc_voltage), len(answer.faults))

    def reset(self, belt):
        answer = belt.reset()
        if not answer.success:
            raise StepFailed('the drive was not reset: ' + answer.message)
        self.wait('%s without a fault' % belt.name, lambda: not belt.status.faulted)
        self.watch(1.0, '%s at rest after its reset' % belt.name, belt.at_rest)

    def stop_all(self):
        answer = self.line.stop_all(mode=StopRequest.DECELERATE)
        if not answer.success:
            raise StepFailed('not every stop was confirmed: ' + answer.message)
        self.line.set_velocity(None)
        self.wait('every belt at rest', lambda: all(belt.at_rest() for belt in self.line.belts))
        return 'every drive confirmed it and stands'

    def pause(self):
        """Time to look at it, on a terminal."""
        if self.show.live and self.interrupted.wait(2.0):
            raise Ended()

    def stop_motors(self):
        """Ctrl-C: stops every motor and waits for standstill. Returns the names that stand and those that may not."""
        self.line.set_velocity(None)
        self.line.ended.set()
        self.line.stream.join()
        stands = []
        try:
            self.line.stop_all(mode=StopRequest.DECELERATE)
            deadline = time.monotonic() + PATIENCE
            while time.monotonic() < deadline and len(stands) < len(self.line.belts) and not rospy.is_shutdown():
                stands = [belt.name for belt in self.line.belts if belt.at_rest()]
                time.sleep(0.02)
        except (rospy.ServiceException, rospy.ROSException):
            pass
        return stands, [belt.name for belt in self.line.belts if belt.name not in stands]


def count(belts):
    return 'one belt' if len(belts) == 1 else '%d belts' % len(belts)


def describe(belt):
    status = belt.status
    if status is None:
        return '%s: no status' % belt.name
    return '%s: %s, %.2f of %.2f%s' % (belt.name, belt.state()[0], status.velocity, status.commanded_velocity,
                                      ', ' + status.error_text if status.error_text else '')


class PlainLines:
    """A line per step, for logs."""

    live = False

    def begin(self, title):
        self.say('... ' + title)

    def done(self, title, detail, seconds):
        self.say('ok  %s (%.1f s)%s' % (title, seconds, ': ' + detail if detail else ''))

    def say(self, text):
        write(text + '\n')

    def close(self):
        pass


class LiveTable:
    """The table in the terminal, redrawn in place ten times a second from a thread of its own."""

    live = True
    COLOURS = {'red': '1;31', 'green': '32', 'yellow': '33', 'blue': '34', 'cyan': '36', 'grey': '90', 'bold': '1'}
    ENTER = '\x1b[?1049h\x1b[?25l'  # second screen, no cursor
    LEAVE = '\x1b[?25h\x1b[?1049l'
    BEGIN_FRAME, END_FRAME = '\x1b[?2026h\x1b[H', '\x1b[J\x1b[?2026l'  # whole frames only, where the terminal can

    def __init__(self, line, top):
        self.line = line
        self.top = top
        self.start = time.monotonic()
        self.title = ''
        self.events = collections.deque(maxlen=20)
        self.lock = threading.Lock()
        self.unicode = 'utf' in (sys.stdout.encoding or '').lower()
        self.closed = threading.Event()
        write(self.ENTER)
        self.thread = threading.Thread(target=self.redraw, daemon=True)
        self.thread.start()

    def begin(self, title):
        with self.lock:
            self.title = title

    def done(self, title, detail, _seconds):
        self.say('%s %s%s' % (self.sign('✓', '+'), title, ': ' + detail if detail else ''))

    def say(self, text):
        with self.lock:
            self.events.append('%s  %s' % (self.clock(), text))

    def close(self):
        if not self.closed.is_set():
            self.closed.set()
            self.thread.join()
            write(self.LEAVE)

    def sign(self, unicode, plain):
        return unicode if self.unicode else plain

    def clock(self):
        return '%02d:%02d' % divmod(int(time.monotonic() - self.start), 60)

    def redraw(self):
        while not self.closed.wait(0.1):
            try:
                lines = self.lines()
            except (AttributeError, TypeError):  # a status message arrived half-way
                continue
            write(self.BEGIN_FRAME + ''.join(line + '\x1b[K\r\n' for line in lines) + self.END_FRAME)

    def lines(self):
        columns, rows = shutil.get_terminal_size()
        with self.lock:
            title, events = self.title, list(self.events)
        bar = max(8, min(30, columns - 74))
        body = [self.paint('bold', fit(' inverter_bus  %s  %s' % (self.clock(), self.line.bus), columns)), '']
        body += [' %s %s' % (self.paint('cyan', self.sign('▶', '>')), self.paint('bold', fit(title, columns - 4))), '']
        head = ' %-16s %-9s %-*s %9s %9s %8s  %s' % ('belt', 'state', bar, 'velocity', 'commanded', 'actual',
                                                    'current', 'fault')
        body.append(self.paint('grey', fit(head, columns)))
        body += [self.belt_line(belt, bar, columns) for belt in self.line.belts]
        body += [''] + self.bus_lines(bar, columns) + ['']
        room = max(0, rows - len(body) - 3)
        body += [self.paint('grey', ' ' + fit(text, columns - 2)) for text in (events[-room:] if room else [])]
        body += ['', self.paint('grey', ' Ctrl-C stops every motor and ends the demo.')]
        return body[:rows - 1]

    def belt_line(self, belt, bar, columns):
        word, colour = belt.state()
        status = belt.status
        if status is None:
            return ' %-16s %s' % (belt.name[:16], self.paint(colour, word))
        number = self.paint(colour, '%-9s' % word)
        speed = 0.0 if math.isnan(status.velocity) else status.velocity
        meter = self.paint(colour, self.meter(abs(speed) / self.top, bar))
        fault = status.fault_text if status.faulted else status.error_text
        width = columns - bar - 60
        text = self.paint('red' if status.faulted else 'yellow', fit(fault, width)) if fault and width > 4 else ''
        return ' %-16s %s %s %9.2f %9s %8s  %s' % (belt.name[:16], number, meter, status.commanded_velocity,
                                                 value('%.2f', status.velocity), value('%.2f A', status.output_current),
                                                 text)

    def bus_lines(self, bar, columns):
        status = self.line.bus_status
        if status is None:
            return [self.paint('grey', ' waiting for the bus')]
        colour = 'green' if status.connected and not status.offline_nodes else 'red'
        first = ' %-16s %s %s %3.0f %%' % ('bus load', self.paint(colour, '%-9s' % (
            'connected' if status.connected else 'GONE')), self.paint('blue', self.meter(status.utilization, bar)),
                                         100.0 * status.utilization)
        second = '   cycle %.0f ms (%.0f %% of the line\'s best)   worst stop %.1f ms   %d requests, %d lost' % (
            1e3 * status.cycle_time, 100.0 * status.efficiency, 1e3 * status.stop_latency_max, status.requests,
            status.timeouts + status.corrupt_replies)
        return [first, self.paint('grey', fit(second, columns))]

    def meter(self, share, width):
        """A bar; eighths of a character where the terminal has them."""
        share = min(1.0, max(0.0, share))
        if not self.unicode:
            return ('#' * int(share * width)).ljust(width, '.')
        eighths = int(round(share * width * 8))
        text = '█' * (eighths // 8) + ('', '▏', '▎', '▍', '▌', '▋', '▊', '▉')[eighths % 8]
        return text.ljust(width, '·')

    def paint(self, colour, text):
        return '\x1b[%sm%s\x1b[0m' % (self.COLOURS[colour], text)


def value(form, number):
    """What a drive can't tell is NaN."""
    return '-' if math.isnan(number) else form % number


def fit(text, width):
    return text if len(text) <= width else text[:max(0, width - 1)] + '.'


def play(scene, show, once):
    """Plays until it ends. Returns the exit status and what to say at last."""
    try:
        while True:
            scene.play()
            if once:
                return 0, 'The scene was played: every step was seen in the status messages.'
            show.begin('Played. It starts again in a moment.')
            if scene.interrupted.wait(4.0):
                raise Ended()
    except Ended:
        show.begin('Ctrl-C: stopping every motor')
        stands, rest = scene.stop_motors()
        words = []
        if stands:
            words.append('Ctrl-C: stopped, and standing still: %s.' % ', '.join(stands))
        if rest:
            words.append('NOT confirmed at rest: %s.' % ', '.join(rest))
        return 1 if rest or once else 0, ' '.join(words)
    except StepFailed as error:
        scene.stop_motors()
        return 1, 'FAILED %s' % error


def main():
    parser = argparse.ArgumentParser(description='The scene of the inverter_bus demo.')
    parser.add_argument('--once', action='store_true', help='play once with plain lines')
    arguments = parser.parse_args(rospy.myargv()[1:])
    if not rosgraph.is_master_online():
        print('No ROS master at %s; scripts/demo starts everything.' % os.environ.get('ROS_MASTER_URI', '?'))
        return 1
    rospy.init_node('conveyor_scene', disable_signals=True)
    once = arguments.once or rospy.get_param('~once', False) or not sys.stdout.isatty()
    slow, fast = float(rospy.get_param('~slow', 0.2)), float(rospy.get_param('~fast', 0.35))
    line = Line(rospy.get_param('~bus', 'conveyor'), rospy.get_param('~simulator', 'simulated_bus'))
    show = PlainLines() if once else LiveTable(line, 1.15 * max(abs(slow), abs(fast)))
    scene = Scene(line, slow, fast, show)
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, lambda *_: scene.interrupted.set())
    try:
        status, words = play(scene, show, once)
    finally:
        show.close()
    line.ended.set()
    if show.live:
        for event in show.events:
            write(event + '\n')
    write(words + '\n')
    rospy.signal_shutdown('played')
    return status


if __name__ == '__main__':
    sys.exit(main())
