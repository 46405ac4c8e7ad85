#!/usr/bin/env python3
"""Trips: seen with their text, remembered, reset on request only; and the flight recorder's file of it."""
import glob
import os
import unittest

import rostest
import rospy
from harness import Bench, belts, init, stays, wait_for
from std_srvs.srv import Trigger


class Faults(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.bench = Bench(belts(2))
        cls.bench.start_driver()
        cls.belt = cls.bench['belt_1']

    @classmethod
    def tearDownClass(cls):
        cls.bench.close()

    def tearDown(self):
        self.belt.reset()
        self.belt.wait(lambda s: not s.faulted and not s.communication_error, 'no fault')

    def trip(self, code):
        self.bench.simulate('belt_1 trip %d' % code)
        return self.belt.wait(lambda s: s.faulted and s.fault_code == code, 'tripped with %d' % code)

    def testATripShowsItsCodeAndText(self):
        status = self.trip(7)
        self.assertIn('voltage', status.fault_text.lower())
        self.assertTrue(status.locked)
        wait_for(lambda: self.bench.diagnostics.get('belt_1') and self.bench.diagnostics['belt_1'].level == 2,
                 '/diagnostics shows an error')
        self.assertEqual(self.bench.diagnostics['belt_2'].level < 2, True)

    def testATripTakesRunOffSoThatAResetAtThePanelStartsNothing(self):
        with self.bench.run('belt_1', 30.0):
            self.trip(1)
            wait_for(lambda: self.bench.real('belt_1')['run_coil'] == '0', 'RUN off')

    def testResetClearsTheFaultAndStartsNothing(self):
        with self.bench.run('belt_1', 30.0):
            self.trip(5)
            answer = self.belt.reset()
            self.assertTrue(answer.success, answer.message)
            self.belt.wait(lambda s: not s.faulted and s.fault_code == 0 and s.fault_text == '', 'no fault')
            stays(lambda: not self.bench.turns('belt_1'), 'the motor stands under a stream of commands', 1.0)
        self.assertFalse(self.belt.status.reset_active)

    def testTheTripMemoryIsReadNewestFirst(self):
        with self.bench.run('belt_1', 30.0):
            self.trip(7)
        self.assertTrue(self.belt.reset().success)
        self.belt.wait(lambda s: not s.faulted, 'no fault')
        self.trip(1)
        answer = self.belt.read_faults()
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(answer.present.code, 1)
        self.assertTrue(answer.present.text)
        self.assertEqual([fault.code for fault in answer.faults[:2]], [1, 7])
        self.assertAlmostEqual(answer.faults[1].output_frequency, 30.0, delta=0.5)
        self.assertGreater(answer.faults[1].output_current, 0.1)
        self.assertGreater(answer.faults[1].dc_voltage, 100.0)
        self.assertGreaterEqual(answer.faults[1].power_on_hours, answer.faults[1].run_hours)

    def testWithoutATripNothingIsPresent(self):
        answer = self.bench['belt_2'].read_faults()
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(answer.present.code, 0)
        self.assertEqual(answer.faults, [])

    def testATripLeavesAFlightRecorderFileAndDumpTraceWritesOne(self):
        traces = os.path.join(self.bench.parameters['trace_directory'], '*')
        self.trip(3)
        wait_for(lambda: glob.glob(traces), 'a flight recorder file')
        answer = rospy.ServiceProxy(self.bench.driver_name + '/dump_trace', Trigger)()
        self.assertTrue(answer.success, answer.message)
        wait_for(lambda: any(name in answer.message for name in glob.glob(traces)), 'the file that it names')


if __name__ == '__main__':
    init('faults_test')
    rostest.rosrun('inverter_bus', 'faults', Faults)
    rospy.signal_shutdown('done')
