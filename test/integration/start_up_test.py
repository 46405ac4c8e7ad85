#!/usr/bin/env python3
"""Nothing runs by itself when the driver starts, whatever is being sent, latched or left over."""
import signal
import unittest

import rostest
import rospy
from harness import Bench, Stream, belts, init, stays, wait_for
from inverter_bus.msg import InverterStatus
from std_msgs.msg import Float64


class StartUp(unittest.TestCase):
    def setUp(self):
        self.bench = Bench(belts(2))
        self.bench.listen(self.bench.parameters['scan_list'])

    def tearDown(self):
        self.bench.close()

    def testALiveStreamIsRefusedUntilItSentZero(self):
        belt = self.bench['belt_1']
        with Stream(belt, 30.0) as stream:
            self.bench.start_driver()
            status = belt.wait(lambda s: s.error_id == InverterStatus.ERROR_LOCKED, 'the stream refused')
            self.assertTrue(status.locked)
            stays(lambda: not self.bench.turns('belt_1') and belt.status.locked, 'the motor stands, locked', 2.0)
            stream.velocity = 0.0
            belt.wait(lambda s: not s.locked, 'unlocked by 0')
            stream.velocity = 20.0
            belt.wait(lambda s: abs(s.velocity - 20.0) < 0.05, 'runs')
        self.assertEqual(self.bench.real('belt_2')['run_coil'], '0')

    def testSilenceFromTheFirstStatusUnlocks(self):
        self.bench.start_driver()
        belt = self.bench['belt_1']
        belt.wait(lambda s: not s.locked, 'unlocked by silence')
        belt.send(20.0)
        belt.wait(lambda s: s.run_command, 'runs')

    def testAMessageThatWasLatchedBeforeIsNoCommand(self):
        belt = self.bench['belt_1']
        latched = rospy.Publisher(belt.path + '/command', Float64, queue_size=1, latch=True)
        latched.publish(Float64(30.0))
        try:
            self.bench.start_driver()
            belt.wait(lambda s: not s.locked, 'unlocked by silence')
            stays(lambda: not self.bench.turns('belt_1') and not belt.status.run_command, 'the motor stands', 1.0)
        finally:
            latched.unregister()

    def testALeftoverRunOfTheBusIsCleared(self):
        self.bench.start_driver()
        with self.bench.run('belt_1', 30.0):
            self.bench.driver.signal(signal.SIGKILL)
            self.bench.driver.wait()
        self.assertTrue(self.bench.turns('belt_1'))
        belt = self.bench['belt_1']
        belt.forget()
        self.bench.start_driver()
        belt.wait(lambda s: not s.running and not s.operation and s.known, 'stopped by the new driver')
        self.assertEqual(self.bench.real('belt_1')['run_coil'], '0')

    def testADriveCommandedFromItsPanelIsLeftAlone(self):
        self.bench.simulate('belt_1 panel 20')
        wait_for(lambda: self.bench.turns('belt_1'), 'runs from its panel')
        self.bench.start_driver()
        belt = self.bench['belt_1']
        belt.wait(lambda s: s.running and abs(s.output_frequency - 20.0) < 0.1, 'seen running')
        stays(lambda: self.bench.turns('belt_1'), 'left alone', 1.0)
        self.assertFalse(belt.status.run_command)


if __name__ == '__main__':
    init('start_up_test')
    rostest.rosrun('inverter_bus', 'start_up', StartUp)
    rospy.signal_shutdown('done')
