#!/usr/bin/env python3
"""Messages and service requests of any content, end to end: refused in words, and what runs goes on."""
import time
import unittest

import rostest
import rospy
from harness import Bench, belts, init, wait_for
from inverter_bus.msg import InverterStatus, VelocityCommand

LOG_PERIOD = 5.0  # the log gets a line about refused groups that often


class BadInput(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.bench = Bench(belts(2, command_timeout=0.0))
        cls.bench.start_driver()
        cls.belt = cls.bench['belt_1']
        wait_for(lambda: cls.bench.group.get_num_connections() > 0, 'the subscription to ~command')

    @classmethod
    def tearDownClass(cls):
        cls.bench.close()

    def tearDown(self):
        """The node is there and does what it is told."""
        self.assertTrue(self.bench.driver.running())
        answer = self.bench.stop_all()
        self.assertTrue(answer.success, answer.message)
        self.assertFalse(self.bench.turns('belt_1') and self.bench.real('belt_1')['run_coil'] == '1')

    def assertGroupRefused(self):
        wait_for(lambda: self.bench.bus_status.error_id == InverterStatus.ERROR_OUT_OF_RANGE,
                 'the refusal of the group in the bus status')

    def assertRefusedInWords(self, answer, error_id):
        self.assertFalse(answer.success)
        self.assertEqual(answer.error_id, error_id, answer.message)
        self.assertTrue(answer.message)
        self.assertLess(len(answer.message), 500)
        self.assertTrue(answer.message.isprintable(), answer.message)

    def testAGroupOfAHundredThousandNamesIsRefusedAndTheMotorRunsOn(self):
        with self.bench.run('belt_1', 20.0):
            self.bench.group.publish(VelocityCommand(name=['belt_1', 'belt_2'] * 50000, velocity=[30.0] * 100000))
            self.assertGroupRefused()
            status = self.belt.wait(lambda s: abs(s.velocity - 20.0) < 0.5, 'still at 20')
            self.assertAlmostEqual(status.commanded_velocity, 20.0)
            self.assertFalse(self.bench.turns('belt_2'))

    def testUnequalLengthsMoveNothing(self):
        self.bench.unlock()
        self.bench.group.publish(VelocityCommand(name=['belt_1', 'belt_2'], velocity=[20.0]))
        status = self.belt.wait(lambda s: s.error_id == InverterStatus.ERROR_OUT_OF_RANGE, 'the refusal')
        self.assertIn('2 names and 1 velocities', status.error_text)
        self.assertFalse(self.bench.turns('belt_1'))

    def testAFloodOfWrongGroupsLeavesAFewLinesInTheLog(self):
        begin = time.monotonic()
        for number in range(2000):
            name = 'nobody_%d \x1b[2J\x9b' % number
            self.bench.group.publish(VelocityCommand(name=['belt_2', name], velocity=[20.0, 20.0]))
        status = self.bench['belt_2'].wait(lambda s: 'nobody_1999' in s.error_text, 'the last refusal')
        self.assertTrue(status.error_text.isprintable(), status.error_text)
        lines = self.bench.driver.log().count('grouped command refused')
        # The other tests of this class may have written one.
        self.assertLessEqual(lines, 4 + (time.monotonic() - begin) / LOG_PERIOD)
        self.assertNotIn('\x1b[2J', self.bench.driver.log())

    def testNamesOfParametersOfAnyContent(self):
        for name in ('\x9b\u202e', '\x1b[2J', 'x' * 1000000, '', '../../F002', 'F002\n', 'F002\x00'):
            self.assertRefusedInWords(self.belt.read_parameter(name), InverterStatus.ERROR_OUT_OF_RANGE)
            self.assertRefusedInWords(self.belt.write_parameter(name, 1.0), InverterStatus.ERROR_OUT_OF_RANGE)

    def testValuesOfParametersThatAreNoNumbers(self):
        before = self.bench.simulate('belt_1 get F002')
        for value in (float('nan'), float('inf'), float('-inf'), 1e300, -1.0):
            self.assertRefusedInWords(self.belt.write_parameter('F002', value), InverterStatus.ERROR_OUT_OF_RANGE)
        self.assertEqual(self.bench.simulate('belt_1 get F002'), before)


if __name__ == '__main__':
    init('bad_input_test')
    rostest.rosrun('inverter_bus', 'bad_input', BadInput)
    rospy.signal_shutdown('done')
