#!/usr/bin/env python3
"""roscore is killed, and comes back knowing nobody: the driver goes on by itself, and can always be ended."""
import os
import signal
import socket
import subprocess
import time
import unittest

import rosgraph
import rostest
import rospy
from harness import Bench, belts, init, stays, wait_for
from inverter_bus.msg import InverterStatus
from inverter_bus.srv import Stop


class Master:
    """A roscore of this test's own, at a place that it keeps; everything here runs under it instead of rostest's."""

    def __init__(self):
        with socket.socket() as free:
            free.bind(('127.0.0.1', 0))
            self.port = free.getsockname()[1]
        self.process = None
        self.start()

    def uri(self):
        return 'http://127.0.0.1:%d' % self.port

    def start(self):
        self.process = subprocess.Popen(['rosmaster', '--core', '-p', str(self.port)], stdin=subprocess.DEVNULL,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)

    def signal(self, number):
        self.process.send_signal(number)

    def kill(self):
        self.process.kill()
        self.process.wait()


class MasterGone(unittest.TestCase):
    def setUp(self):
        self.bench = Bench(belts(2))
        self.bench.start_driver()
        # Whoever is to talk to them without a master must have done so before: as a supervisor has.
        self.bench.simulate('list')
        self.stop = self.persistent('stop', Stop)
        self.assertTrue(self.stop(mode=0).success)
        self.streams = self.bench.run_all(20.0)

    def tearDown(self):
        for stream in self.streams:
            stream.end()
        MASTER.signal(signal.SIGCONT)
        if MASTER.process.poll() is not None:
            MASTER.start()
            wait_for(rosgraph.is_master_online, 'the ROS master, again')
        self.bench.close()

    def persistent(self, name, kind):
        path = self.bench.driver_name + '/' + name
        rospy.wait_for_service(path, 30.0)
        return rospy.ServiceProxy(path, kind, persistent=True)

    def assertGoesOn(self):
        """Statuses with new stamps and diagnostics, without a complaint about the line."""
        for inverter in self.bench.inverters.values():
            stamp = inverter.status.header.stamp
            inverter.wait(lambda s: s.header.stamp > stamp and not s.communication_error, 'refreshed')
        self.bench.diagnostics.clear()
        wait_for(lambda: 'bus' in self.bench.diagnostics and 'belt_1' in self.bench.diagnostics, '/diagnostics go on')
        self.assertTrue(self.bench.driver.running(), self.bench.driver.log())

    def assertEnds(self, what):
        """Within the bound of a shutdown and roscpp's own end, status 0, and every motor stopped."""
        started = time.monotonic()
        self.bench.driver.signal(signal.SIGINT)
        wait_for(lambda: not any(self.bench.real(name)['run_coil'] == '1' for name in self.bench.inverters),
                 'stopped with ' + what)
        stopped = time.monotonic() - started
        self.assertEqual(self.bench.driver.wait(20.0), 0, self.bench.driver.log())
        ended = time.monotonic() - started
        print('measured: Ctrl-C with %s: motors stopped after %.2f s, end after %.2f s' % (what, stopped, ended))
        self.assertLess(ended, 10.0)
        self.assertIn('is confirmed as stopped', self.bench.driver.log())

    def testTheMasterDiesAndComesBack(self):
        belt = self.bench['belt_1']
        self.assertNotIn('ROS master', self.bench.finding('bus').message)
        MASTER.kill()
        self.assertGoesOn()
        self.bench.finding('bus', 'the ROS master', 'does not answer')
        stays(lambda: self.bench.turns('belt_1') and self.bench.turns('belt_2'), 'run on under their streams', 1.0)
        # The command watchdog needs no master.
        self.streams[1].end()
        self.bench['belt_2'].wait(lambda s: s.locked and not s.run_command and not s.running, 'stopped by the command watchdog')
        self.assertFalse(self.bench.turns('belt_2'))
        self.assertTrue(self.bench.turns('belt_1'))
        MASTER.start()
        wait_for(rosgraph.is_master_online, 'the ROS master, again')
        self.assertGoesOn()
        self.assertTrue(self.bench.turns('belt_1'))
        # roscpp never registers again: it says so, once.
        self.bench.finding('bus', 'does not know this node', 'restart the node')
        self.assertEqual(self.bench.driver.log().count('does not know this node'), 1, self.bench.driver.log())
        # Whoever was connected before still is: service calls and commands.
        answer = self.stop(mode=0)
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(self.bench.real('belt_1')['run_coil'], '0')
        belt.wait(lambda s: s.error_id == InverterStatus.ERROR_LOCKED, 'the stream is refused')
        self.streams[0].velocity = 0.0
        belt.wait(lambda s: not s.locked, 'unlocked by 0')
        self.streams[0].velocity = 25.0
        belt.wait(lambda s: abs(s.velocity - 25.0) < 0.05, 'runs again')
        self.assertEnds('a master that does not know it')

    def testCtrlCWhileTheMasterIsDead(self):
        MASTER.kill()
        self.assertGoesOn()
        self.assertEnds('a dead master')

    def testCtrlCWhileTheMasterHangs(self):
        """It takes connections and never answers: the worst for roscpp, which wants to unregister."""
        MASTER.signal(signal.SIGSTOP)
        self.assertGoesOn()
        self.assertEnds('a master that hangs')


if __name__ == '__main__':
    MASTER = Master()
    os.environ['ROS_MASTER_URI'] = MASTER.uri()
    init('master_gone_test')
    try:
        rostest.rosrun('inverter_bus', 'master_gone', MasterGone)
        rospy.signal_shutdown('done')
    finally:
        MASTER.kill()
