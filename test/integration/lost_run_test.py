#!/usr/bin/env python3
"""A drive that lost its RUN without our stop never gets it back by itself: it is locked."""
import unittest

import rostest
import rospy
from harness import Bench, belts, init, stays, wait_for
from inverter_bus.msg import InverterStatus


class LostRun(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.bench = Bench(belts(2))
        cls.bench.start_driver()
        cls.belt = cls.bench['belt_1']

    @classmethod
    def tearDownClass(cls):
        cls.bench.close()

    def setUp(self):
        self.stream = self.bench.run('belt_1', 30.0)

    def tearDown(self):
        self.stream.end()
        self.bench.stop_all()
        self.belt.wait(lambda s: not s.communication_error and not s.running, 'at rest')

    def assertLockedAndStanding(self):
        self.belt.wait(lambda s: s.locked and not s.communication_error and not s.run_command, 'locked')
        self.belt.wait(lambda s: not s.running, 'at rest')
        self.belt.wait(lambda s: s.error_id == InverterStatus.ERROR_LOCKED, 'the stream refused')
        stays(lambda: not self.bench.turns('belt_1') and self.bench.real('belt_1')['run_coil'] == '0',
              'the motor stands under a stream of commands', 1.5)

    def assertRunsAgainAfterZero(self):
        self.stream.velocity = 0.0
        self.belt.wait(lambda s: not s.locked, 'unlocked by 0')
        self.stream.velocity = 20.0
        self.belt.wait(lambda s: abs(s.velocity - 20.0) < 0.05, 'runs again')

    def testAShortBrownOut(self):
        self.bench.simulate('belt_1 power_cycle 0.05')
        self.assertLockedAndStanding()
        self.assertRunsAgainAfterZero()

    def testAPowerCycleWithItsStartUpTime(self):
        self.bench.simulate('belt_1 power_cycle')
        self.belt.wait(lambda s: s.communication_error, 'offline meanwhile')
        self.assertLockedAndStanding()

    def testTheStopKeyOfThePanel(self):
        self.bench.simulate('belt_1 panel_stop')
        self.assertLockedAndStanding()
        self.assertRunsAgainAfterZero()

    def testSafeTorqueOff(self):
        self.bench.simulate('belt_1 sto on')
        self.belt.wait(lambda s: s.faulted and s.locked, 'tripped and locked')
        self.bench.simulate('belt_1 sto off')
        self.assertTrue(self.belt.reset().success)
        self.assertLockedAndStanding()

    def testOneLostReplyDisturbsNothing(self):
        self.belt.forget()
        self.bench.simulate('belt_1 lost_reply')
        wait_for(lambda: self.bench.real('belt_1')['faults_waiting'] == '0', 'the fault to have struck')
        self.belt.fresh()
        stays(lambda: self.bench.turns('belt_1') and not self.belt.status.locked, 'runs on', 1.0)
        self.assertEqual(self.belt.status.error_id, 0)

    def testDamagedAndForeignRepliesDisturbNothing(self):
        for fault in ('damaged', 'truncated 3', 'noise 5', 'foreign station', 'foreign shape', 'late 0.3'):
            self.bench.simulate('belt_1 ' + fault)
            wait_for(lambda: self.bench.real('belt_1')['faults_waiting'] == '0', fault + ' to have struck')
            self.belt.fresh()
            stays(lambda: self.bench.turns('belt_1') and abs(self.belt.status.velocity - 30.0) < 0.1,
                  'runs on at its velocity after: ' + fault, 0.7)


if __name__ == '__main__':
    init('lost_run_test')
    rostest.rosrun('inverter_bus', 'lost_run', LostRun)
    rospy.signal_shutdown('done')
