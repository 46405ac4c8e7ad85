#!/usr/bin/env python3
"""However the driver is ended, every motor that it may have started is stopped, and the exit status is 0."""
import signal
import subprocess
import unittest

import rostest
import rospy
from harness import Bench, belts, init, wait_for


class Shutdown(unittest.TestCase):
    def setUp(self):
        self.bench = Bench(belts(3))
        self.bench.start_driver()
        self.streams = [self.bench.run(name, 30.0) for name in ('belt_1', 'belt_2')]

    def tearDown(self):
        for stream in self.streams:
            stream.end()
        self.bench.close()

    def assertAllStopped(self):
        self.assertEqual(self.bench.driver.wait(15.0), 0, self.bench.driver.log())
        for name in ('belt_1', 'belt_2'):
            self.assertEqual(self.bench.real(name)['run_coil'], '0', self.bench.driver.log())
            wait_for(lambda: not self.bench.turns(name), name + ' at rest')

    def testSigint(self):
        self.bench.driver.signal(signal.SIGINT)
        self.assertAllStopped()

    def testSigterm(self):
        self.bench.driver.signal(signal.SIGTERM)
        self.assertAllStopped()

    def testSighup(self):
        self.bench.driver.signal(signal.SIGHUP)
        self.assertAllStopped()

    def testASecondCtrlCChangesNothing(self):
        for _ in range(5):
            self.bench.driver.signal(signal.SIGINT)
        self.assertAllStopped()

    def testRosnodeKill(self):
        subprocess.check_call(['rosnode', 'kill', self.bench.driver_name], stdout=subprocess.DEVNULL)
        self.assertAllStopped()

    def testWhatCouldNotBeConfirmedIsNamedOnTheLastLine(self):
        self.bench.simulate('belt_2 offline')
        self.bench.driver.signal(signal.SIGTERM)
        self.assertEqual(self.bench.driver.wait(20.0), 0, self.bench.driver.log())
        self.assertEqual(self.bench.real('belt_1')['run_coil'], '0')
        last = [line for line in self.bench.driver.log().splitlines() if line.strip()][-1]
        self.assertIn('belt_2', last)
        self.assertNotIn('belt_1', last)


if __name__ == '__main__':
    init('shutdown_test')
    rostest.rosrun('inverter_bus', 'shutdown', Shutdown)
    rospy.signal_shutdown('done')
