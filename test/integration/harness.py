"""What the integration tests share: a simulated bus with a driver on it, and eyes for both ends.

A test says what it wants to see and how long it is willing to wait; nothing here sleeps for a fixed time and hopes.
"""
import glob
import itertools
import math
import os
import shutil
import signal
import subprocess
import tempfile
import threading
import time

import roslib.packages
import rosgraph
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from inverter_bus.msg import BusStatus, InverterStatus, VelocityCommand
from inverter_bus.srv import InjectFault, ReadFaults, ReadParameter, Reset, Stop, WriteParameter
from std_msgs.msg import Float64

PATIENCE = 30.0  # [s] for things that take well under a second on a quiet machine
QUICK_RAMPS = {'F002': 0.5, 'F003': 0.5}  # [s] from 0 to the maximum frequency and back

_numbers = itertools.count(1)


def program(name):
    """Path of a program of the package, in the build's or in the installed tree."""
    found = roslib.packages.find_node('inverter_bus', name)
    if not found:
        raise RuntimeError('no program %s in package inverter_bus' % name)
    return found[0]


def wait_for(condition, what, patience=PATIENCE):
    """Waits until `condition` gives something true, and returns it."""
    deadline = time.monotonic() + patience
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > deadline:
            raise AssertionError('not seen within %.0f s: %s' % (patience, what() if callable(what) else what))
        time.sleep(0.01)


def stays(condition, what, seconds):
    """Holds all that time: for things that must not happen."""
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        if not condition():
            raise AssertionError('did not stay so for %.1f s: %s' % (seconds, what() if callable(what) else what))
        time.sleep(0.01)


def belts(number, drive='omron_mx2', **more):
    """Scan list entries belt_1, belt_2, ... on the stations of the same number."""
    return [dict({'name': 'belt_%d' % n, 'node': n, 'drive': drive}, **more) for n in range(1, number + 1)]


class Process:
    """A program of the package, with what it says in a file."""

    def __init__(self, directory, name, *arguments):
        self.log_path = os.path.join(directory, '%s_%d.log' % (name, next(_numbers)))
        self.stream = open(self.log_path, 'w')
        self.process = subprocess.Popen([program(name)] + list(arguments), stdin=subprocess.DEVNULL, stdout=self.stream,
                                        stderr=subprocess.STDOUT, start_new_session=True)

    def log(self):
        with open(self.log_path, errors='replace') as stream:
            return stream.read()

    def running(self):
        return self.process.poll() is None

    def signal(self, number):
        self.process.send_signal(number)

    def wait(self, patience=PATIENCE):
        """Waits for the end; returns the exit status."""
        try:
            return self.process.wait(patience)
        except subprocess.TimeoutExpired:
            raise AssertionError('%s did not end within %.0f s; it said:\n%s' % (self.log_path, patience, self.log()))

    def end(self):
        if self.running():
            self.process.terminate()
            try:
                self.process.wait(15.0)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()
        self.stream.close()


class Inverter:
    """One inverter as a ROS application sees it."""

    def __init__(self, driver, name):
        self.name = name
        self.path = '%s/%s' % (driver, name)
        self.messages = []
        self.lock = threading.Lock()
        self.publisher = rospy.Publisher(self.path + '/command', Float64, queue_size=10)
        self.subscriber = rospy.Subscriber(self.path + '/status', InverterStatus, self.on_status, queue_size=100)

    def on_status(self, message):
        with self.lock:
            self.messages.append(message)

    @property
    def status(self):
        with self.lock:
            return self.messages[-1] if self.messages else None

    def forget(self):
        """From here on: drops the messages so far, and any that may already be on the way."""
        with self.lock:
            self.messages = []

    def fresh(self):
        """A status that was published after this call."""
        self.forget()
        wait_for(lambda: len(self.seen()) >= 2, '%s: two new status messages' % self.name)
        return self.status

    def seen(self, condition=lambda message: True):
        """All messages since forget() for which it is true."""
        with self.lock:
            return [message for message in self.messages if condition(message)]

    def wait(self, condition, what, patience=PATIENCE):
        return wait_for(lambda: self.status if self.status is not None and condition(self.status) else None,
                        lambda: '%s: %s; last status:\n%s' % (self.name, what, self.status), patience)

    def wait_online(self):
        return self.wait(lambda s: not s.communication_error and s.known, 'online')

    def send(self, velocity):
        self.publisher.publish(Float64(velocity))

    def connected(self):
        return self.publisher.get_num_connections() > 0

    def close(self):
        self.subscriber.unregister()
        self.publisher.unregister()

    def _call(self, service, kind, **arguments):
        path = '%s/%s' % (self.path, service)
        rospy.wait_for_service(path, PATIENCE)
        return rospy.ServiceProxy(path, kind)(**arguments)

    def stop(self, mode=0):
        return self._call('stop', Stop, mode=mode)

    def reset(self):
        return self._call('reset', Reset)

    def read_faults(self):
        return self._call('read_faults', ReadFaults)

    def read_parameter(self, name):
        return self._call('read_parameter', ReadParameter, name=name)

    def write_parameter(self, name, value, persist=False):
        return self._call('write_parameter', WriteParameter, name=name, value=value, persist=persist)


class Stream:
    """Sends a velocity to one inverter again and again, as an application does."""

    def __init__(self, inverter, velocity, rate=20.0):
        self.inverter = inverter
        self.velocity = velocity
        self.period = 1.0 / rate
        self.ended = threading.Event()
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        while not self.ended.is_set():
            self.inverter.send(self.velocity)
            self.ended.wait(self.period)

    def end(self):
        self.ended.set()
        self.thread.join()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.end()


class Frame:
    """One frame of the simulated bus's trace."""

    def __init__(self, time, sender, station, text):
        self.time = float(time)  # [s] its end, since the simulated bus was started
        self.sender = sender     # master, drive, foreign or noise
        self.station = station
        self.text = text.strip()
        self.bytes = bytes.fromhex(self.text)


class Bench:
    """A simulated bus and, when start_driver() was called, a driver on it."""

    def __init__(self, entries, simulation=None, ramps=True, simulate=None, **bus):
        number = next(_numbers)
        self.directory = tempfile.mkdtemp(prefix='inverter_bus_test_')
        self.link = os.path.join(self.directory, 'line')
        self.driver_name = '/driver_%d' % number
        self.simulator_name = '/simulator_%d' % number
        self.parameters = dict({'port': self.link, 'baud_rate': 19200, 'scan_list': entries,
                                'trace_directory': os.path.join(self.directory, 'traces')}, **bus)
        self.processes = []
        self.driver = None
        self.inverters = {}
        self.bus_messages = []
        self.diagnostics = {}
        self.start_simulator(simulate or entries, simulation or {}, ramps)

    def start_simulator(self, entries, simulation, ramps):
        """The drives as commissioned; a scan list that is a mask can't name them, so the simulator has its own."""
        drives = {}
        for entry in entries:
            details = dict(simulation.get(entry['name'], {}))
            if ramps:
                details['parameters'] = dict(QUICK_RAMPS, **details.get('parameters', {}))
            drives[entry['name']] = details
        line = {key: self.parameters[key] for key in ('protocol', 'baud_rate', 'parity', 'data_bits', 'stop_bits')
                if key in self.parameters}
        rospy.set_param(self.simulator_name, dict(line, port=self.link, scan_list=[
            {key: entry[key] for key in ('name', 'node', 'drive')} for entry in entries], simulation=drives))
        self.simulator = self.start('simulated_bus_node', '__name:=' + self.simulator_name[1:])
        wait_for(lambda: os.path.exists(self.link) or not self.simulator.running(), 'the simulated line')
        if not self.simulator.running():
            raise AssertionError('the simulated bus ended:\n' + self.simulator.log())
        rospy.wait_for_service(self.simulator_name + '/command', PATIENCE)
        self.inject = rospy.ServiceProxy(self.simulator_name + '/command', InjectFault, persistent=True)

    def start(self, name, *arguments):
        process = Process(self.directory, name, *arguments)
        self.processes.append(process)
        return process

    def start_driver(self, online=True, **changes):
        """Starts the driver with the bench's parameters, loaded as roslaunch does with clear_params."""
        parameters = dict(self.parameters, **changes)
        if rospy.has_param(self.driver_name):
            rospy.delete_param(self.driver_name)
        rospy.set_param(self.driver_name, parameters)
        if not self.inverters:
            self.listen(parameters.get('scan_list'))
        self.driver = self.start('inverter_bus_node', '__name:=' + self.driver_name[1:])
        if online:
            for inverter in self.inverters.values():
                wait_for(lambda: inverter.status is not None or not self.driver.running(), lambda: self.driver.log())
                if not self.driver.running():
                    raise AssertionError('the driver ended:\n' + self.driver.log())
                inverter.wait_online()
                wait_for(inverter.connected, 'the subscription to ' + inverter.path + '/command')
        return self.driver

    def listen(self, scan_list):
        names = [entry['name'] for entry in scan_list] if isinstance(scan_list, list) else []
        self.inverters = {name: Inverter(self.driver_name, name) for name in names}
        self.group = rospy.Publisher(self.driver_name + '/command', VelocityCommand, queue_size=10)
        self.bus_subscriber = rospy.Subscriber(self.driver_name + '/bus_status', BusStatus, self.bus_messages.append)
        self.diagnostics_subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, self.on_diagnostics)

    def on_diagnostics(self, message):
        for status in message.status:
            if status.name.startswith(self.driver_name[1:] + ':'):
                self.diagnostics[status.name.split(': ', 1)[1]] = status

    def __getitem__(self, name):
        return self.inverters[name]

    @property
    def bus_status(self):
        return self.bus_messages[-1] if self.bus_messages else None

    def send_group(self, **velocities):
        wait_for(lambda: self.group.get_num_connections() > 0, 'the subscription to ~command')
        self.group.publish(VelocityCommand(name=list(velocities), velocity=list(velocities.values())))

    def frames(self, number=200):
        """The last frames on the line, oldest first."""
        texts = self.simulate('bus frames %d' % number).partition('ok')[2].split(' | ')
        return [Frame(*text.split('#')[0].split(None, 3)) for text in texts if text.strip()]

    def finding(self, name, *words):
        """Waits until /diagnostics says all of these words of an inverter (or the bus); returns its entry."""
        def said():
            entry = self.diagnostics.get(name)
            return entry if entry and all(word in entry.message for word in words) else None

        return wait_for(said, lambda: '/diagnostics of %s with %s: %s' % (name, words, self.diagnostics.get(name)))

    def value(self, name, key):
        """What /diagnostics last said under a key; '' before that."""
        entry = self.diagnostics.get(name)
        return next((value.value for value in entry.values if value.key == key), '') if entry else ''

    def traces(self):
        """What the files of the flight recorder say."""
        texts = []
        for path in glob.glob(os.path.join(self.parameters['trace_directory'], '*')):
            with open(path, errors='replace') as stream:
                texts.append(stream.read())
        return texts

    def stop_all(self, mode=0):
        path = self.driver_name + '/stop'
        rospy.wait_for_service(path, PATIENCE)
        return rospy.ServiceProxy(path, Stop)(mode=mode)

    def simulate(self, line):
        """A command of the simulated bus's grammar; returns what follows "ok"."""
        answer = self.inject(line)
        if not answer.success:
            raise AssertionError('simulated bus: %s: %s' % (line, answer.message))
        return answer.message

    def real(self, name):
        """What the drive and its motor really do."""
        words = self.simulate(name + ' show').split()
        return dict(word.split('=', 1) for word in words if '=' in word)

    def turns(self, name):
        return self.real(name)['running'] == '1'

    def frequency(self, name):
        """[Hz], signed: what the motor really does."""
        real = self.real(name)
        return float(real['frequency']) * (-1.0 if real['direction'] == '-1' else 1.0)

    def unlock(self, *names):
        """A command of 0, which ends the lock of start-up or of a stop."""
        for name in names or self.inverters:
            inverter = self.inverters[name]

            def unlocked():
                inverter.send(0.0)
                return inverter.status is not None and not inverter.status.locked

            wait_for(unlocked, name + ' unlocked by a command of 0')
            inverter.fresh()

    def run(self, name, velocity):
        """Runs an inverter up to a velocity and leaves its stream of commands going."""
        self.unlock(name)
        stream = Stream(self.inverters[name], velocity)
        self.inverters[name].wait(lambda s: s.running and abs(s.velocity - velocity) < 0.02 * abs(velocity),
                                  'at %g' % velocity)
        return stream

    def run_all(self, velocity, *names):
        """The same for several at once (all of them if none is named); returns their streams."""
        names = names or tuple(self.inverters)
        self.unlock(*names)
        streams = [Stream(self.inverters[name], velocity) for name in names]
        for name in names:
            self.inverters[name].wait(lambda s: s.running and abs(s.velocity - velocity) < 0.02 * abs(velocity),
                                      'at %g' % velocity)
        return streams

    def close(self):
        for inverter in self.inverters.values():
            inverter.close()
        if self.inverters:
            self.group.unregister()
            self.bus_subscriber.unregister()
            self.diagnostics_subscriber.unregister()
        for process in reversed(self.processes):
            process.end()
        for name in (self.driver_name, self.simulator_name):
            if rospy.has_param(name):
                rospy.delete_param(name)
        shutil.rmtree(self.directory, ignore_errors=True)


def is_nan(value):
    return math.isnan(value)


def init(name):
    """Call once per test program, before its tests."""
    rospy.init_node(name, anonymous=True, disable_signals=True)
    wait_for(rosgraph.is_master_online, 'the ROS master')


__all__ = ['Bench', 'Inverter', 'Process', 'Stream', 'belts', 'init', 'is_nan', 'program', 'signal', 'stays', 'wait_for',
           'PATIENCE']
