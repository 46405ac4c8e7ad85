"""The whole node, with ROS: what it costs, and whether several buses in one graph disturb each other."""
import os
import shutil
import socket
import subprocess
import time

import scenes
import traces
from figures import median, ratio, summary
from simulated_wire import SimulatedWire

HERE = os.path.dirname(os.path.abspath(__file__))


def lacks_ros():
    return None if shutil.which('rosmaster') and shutil.which('rosparam') else 'ROS (rosmaster, rosparam) is not installed'


def free_port():
    with socket.socket() as probe:
        probe.bind(('127.0.0.1', 0))
        return probe.getsockname()[1]


class Graph:
    """A ROS master of its own. `with` ends it and its nodes."""

    def __init__(self):
        port = free_port()
        self.environment = dict(os.environ, ROS_MASTER_URI='http://127.0.0.1:%d' % port, ROS_IP='127.0.0.1')
        self.processes = []
        self.start(['rosmaster', '--core', '-p', str(port)])
        deadline = time.monotonic() + 20.0
        while self.run(['rosparam', 'list']) != 0:
            if time.monotonic() > deadline:
                raise RuntimeError('no ROS master')
            time.sleep(0.2)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in reversed(self.processes):
            process.terminate()
            try:
                process.wait(15.0)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()

    def start(self, command):
        self.processes.append(subprocess.Popen(command, env=self.environment, stdout=subprocess.DEVNULL,
                                               stderr=subprocess.DEVNULL))
        return self.processes[-1]

    def run(self, command):
        return subprocess.run(command, env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                              check=False).returncode

    def node(self, programs, name, wire):
        """The driver on this wire."""
        if self.run(['rosparam', 'load', wire.scan_list, '/' + name]) != 0:
            raise RuntimeError('rosparam load failed')
        return self.start([os.path.join(programs, 'inverter_bus_node'), '__name:=' + name])


def cpu(process):
    """CPU time that a process has used [s]."""
    with open('/proc/%d/stat' % process.pid) as stream:
        words = stream.read().rpartition(')')[2].split()
    return (int(words[11]) + int(words[12])) / os.sysconf('SC_CLK_TCK')


def resident(process):
    """Its memory in use [kB]."""
    with open('/proc/%d/statm' % process.pid) as stream:
        return int(stream.read().split()[1]) * os.sysconf('SC_PAGE_SIZE') // 1024


def buses(programs, scene, number, seconds):
    """So many nodes, each with its bus, in one graph: cycle of each, and what a node costs."""
    wires = [SimulatedWire(programs, scene, spin=0.0) for _ in range(number)]
    try:
        with Graph() as graph:
            nodes = [graph.node(programs, 'bus_%d' % index, wire) for index, wire in enumerate(wires, 1)]
            time.sleep(scenes.warm_up(scene))
            start, used = time.monotonic(), [cpu(node) for node in nodes]
            time.sleep(seconds)
            end = time.monotonic()
            shares = [(cpu(node) - before) / (end - start) for node, before in zip(nodes, used)]
            frames = [traces.within(wire.frames(), start, end) for wire in wires]
            requests = sum(frame.sender == 'master' for of_one in frames for frame in of_one)
            return {'buses': number, 'scene': scenes.title(scene), 'cycle': median([traces.cycle(one) for one in frames]),
                    'share': median(shares), 'resident_kb': median([resident(node) for node in nodes]),
                    'per_exchange': ratio(sum(shares) * (end - start), requests)}
    finally:
        for wire in wires:
            wire.__exit__()


def velocities(programs, scene, calls):
    """[s] from a velocity message, published by another process, to the first byte of the frame that writes it."""
    with SimulatedWire(programs, scene) as wire, Graph() as graph:
        graph.node(programs, 'bus', wire)
        time.sleep(scenes.warm_up(scene))
        output = subprocess.run(['/usr/bin/python3', os.path.join(HERE, 'ros_velocities.py'), 'bus', str(scene.inverters),
                                 str(calls)], env=graph.environment, stdout=subprocess.PIPE, check=True,
                                universal_newlines=True).stdout
        time.sleep(1.0)
        frames = wire.frames()
        delays = []
        for line in output.splitlines():
            since, station = float(line.split()[0]), int(line.split()[1])
            head = bytes([station, 0x10, 0, 0])
            delays.append(traces.delay_to(frames, since, lambda data, head=head: data.startswith(head)))
        return {'inverters': scene.inverters, 'load': 'idle, over ROS', 'commands': summary(delays), 'wake_ups': None}
