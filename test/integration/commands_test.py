#!/usr/bin/env python3
"""Velocity commands, end to end: scaling, sign, refusals, groups, the command watchdog."""
import unittest

import rostest
import rospy
from harness import Bench, belts, init, stays, wait_for
from inverter_bus.msg import InverterStatus, VelocityCommand


class Commands(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        entries = belts(3, command_timeout=0.0)
        entries[1].update(hz_per_unit=-20.0, max_velocity=2.0, min_velocity=0.1)
        entries[2].update(command_timeout=0.5)
        cls.bench = Bench(entries)
        cls.bench.start_driver()

    @classmethod
    def tearDownClass(cls):
        cls.bench.close()

    def setUp(self):
        self.bench.unlock()
        for name in self.bench.inverters:
            self.bench[name].wait(lambda s: not s.running and not s.run_command, 'at rest')

    def testACommandRunsTheMotorAtTheScaledFrequency(self):
        belt = self.bench['belt_1']
        belt.send(25.0)
        status = belt.wait(lambda s: s.running and s.at_speed and abs(s.velocity - 25.0) < 0.05, 'at 25')
        self.assertTrue(status.run_command)
        self.assertTrue(status.operation)
        self.assertEqual(status.direction, InverterStatus.DIRECTION_FORWARD)
        self.assertAlmostEqual(status.commanded_velocity, 25.0)
        self.assertAlmostEqual(status.output_frequency, 25.0, delta=0.05)
        self.assertGreater(status.output_current, 0.0)
        self.assertEqual(status.error_id, 0)
        self.assertFalse(status.move_velocity_active)
        self.assertAlmostEqual(self.bench.frequency('belt_1'), 25.0, delta=0.05)

    def testAMirroredDriveTurnsTheOtherWayAndReportsTheUsersSense(self):
        belt = self.bench['belt_2']
        belt.send(1.5)
        status = belt.wait(lambda s: abs(s.velocity - 1.5) < 0.002, 'at 1.5')  # 0.04 Hz: the ramp is over
        self.assertEqual(status.direction, InverterStatus.DIRECTION_FORWARD)
        self.assertAlmostEqual(status.output_frequency, 30.0, delta=0.05)
        self.assertAlmostEqual(self.bench.frequency('belt_2'), -30.0, delta=0.05)
        belt.send(0.0)

    def testAChangeOfDirectionGoesThroughTheDrivesRamps(self):
        belt = self.bench['belt_1']
        belt.send(20.0)
        belt.wait(lambda s: abs(s.velocity - 20.0) < 0.05, 'at 20')
        belt.send(-20.0)
        status = belt.wait(lambda s: abs(s.velocity + 20.0) < 0.05, 'at -20')
        self.assertEqual(status.direction, InverterStatus.DIRECTION_REVERSE)
        self.assertAlmostEqual(self.bench.frequency('belt_1'), -20.0, delta=0.05)

    def testZeroDeceleratesAndDoesNotLock(self):
        belt = self.bench['belt_1']
        belt.send(30.0)
        belt.wait(lambda s: abs(s.velocity - 30.0) < 0.05, 'at 30')
        belt.send(0.0)
        status = belt.wait(lambda s: not s.running, 'at rest')
        self.assertFalse(status.run_command)
        self.assertFalse(status.locked)
        self.assertEqual(status.direction, InverterStatus.DIRECTION_NONE)
        self.assertEqual(self.bench.real('belt_1')['run_coil'], '0')
        belt.send(10.0)
        belt.wait(lambda s: abs(s.velocity - 10.0) < 0.05, 'at 10 again, without ado')

    def assertRefused(self, belt, velocity):
        """Nothing is sent, status shows why, and what runs goes on as it was."""
        belt.forget()
        belt.send(velocity)
        status = belt.wait(lambda s: s.error_id == InverterStatus.ERROR_OUT_OF_RANGE, 'refused: %r' % velocity)
        self.assertTrue(status.error_text)
        reference = self.bench.real(belt.name)['reference']
        stays(lambda: self.bench.real(belt.name)['reference'] == reference, 'set frequency as it was', 0.2)

    def testNanInfinityAndOutOfRangeAreRefusedAndTheMotorRunsOn(self):
        belt = self.bench['belt_1']
        belt.send(15.0)
        belt.wait(lambda s: abs(s.velocity - 15.0) < 0.05, 'at 15')
        for velocity in (float('nan'), float('inf'), float('-inf'), 1e6, -1e6):
            self.assertRefused(belt, velocity)
            belt.send(15.0)
            belt.wait(lambda s: s.error_id == 0, 'the next accepted command clears the error')
            self.assertAlmostEqual(self.bench.frequency('belt_1'), 15.0, delta=0.05)

    def testTheUsersOwnLimitsHold(self):
        belt = self.bench['belt_2']
        for velocity in (2.001, -2.001):
            self.assertRefused(belt, velocity)
        self.assertFalse(self.bench.turns('belt_2'))
        belt.send(2.0)
        belt.wait(lambda s: abs(s.velocity - 2.0) < 0.01, 'at the limit itself')
        belt.send(0.09)
        belt.wait(lambda s: not s.run_command and s.error_id == 0, 'stopped by what is below the minimum')

    def testAnEqualCommandSendsNothing(self):
        belt = self.bench['belt_1']
        belt.send(12.0)
        belt.wait(lambda s: abs(s.velocity - 12.0) < 0.05 and not s.move_velocity_active, 'at 12')
        wait_for(lambda: self.writes() == 0, 'no write among the last frames')
        belt.forget()
        for _ in range(20):
            belt.send(12.0)
        wait_for(lambda: len(belt.seen()) >= 10, 'ten more status messages')
        self.assertFalse(belt.seen(lambda s: s.move_velocity_active))
        self.assertEqual(self.writes(), 0)

    def writes(self):
        """Number of writes to station 1 among the last frames."""
        frames = self.bench.simulate('bus frames 30').split('|')
        return len([frame for frame in frames if ' 01 10 ' in frame or ' 01 05 ' in frame])

    def testTheWatchdogStopsTheInverter(self):
        belt = self.bench['belt_3']
        belt.send(20.0)
        belt.wait(lambda s: s.run_command, 'RUN given')
        status = belt.wait(lambda s: not s.running and not s.run_command, 'stopped by the command watchdog')
        self.assertFalse(self.bench.turns('belt_3'))
        self.assertFalse(status.stop_active)

    def testARefusedCommandDoesNotFeedTheWatchdog(self):
        belt = self.bench['belt_3']
        belt.send(20.0)
        belt.wait(lambda s: s.run_command, 'RUN given')

        def stopped():
            belt.send(float('nan'))
            return not belt.status.run_command and not belt.status.running

        wait_for(stopped, 'stopped by the command watchdog in spite of a stream of NaN')

    def testAGroupIsCarriedOutTogether(self):
        self.bench.send_group(belt_1=10.0, belt_2=0.5, belt_3=-10.0)
        self.bench['belt_1'].wait(lambda s: s.run_command, 'RUN')
        self.bench['belt_2'].wait(lambda s: s.run_command, 'RUN')
        self.bench['belt_3'].wait(lambda s: s.run_command, 'RUN')
        self.bench['belt_2'].wait(lambda s: abs(s.velocity - 0.5) < 0.01, 'at 0.5')
        self.bench['belt_1'].wait(lambda s: abs(s.velocity - 10.0) < 0.05, 'at 10')

    def testAGroupWithOneBadValueIsRefusedAsAWhole(self):
        for belt in self.bench.inverters.values():
            belt.forget()
        self.bench.send_group(belt_1=10.0, belt_2=99.0)
        for name in ('belt_1', 'belt_2'):
            self.bench[name].wait(lambda s: s.error_id == InverterStatus.ERROR_OUT_OF_RANGE, 'refused with its group')
        wait_for(lambda: self.bench.bus_status.error_id == InverterStatus.ERROR_OUT_OF_RANGE, 'bus status shows it')
        stays(lambda: not self.bench.turns('belt_1'), 'belt_1 at rest', 0.3)
        self.assertEqual(self.bench['belt_3'].status.error_id, 0)

    def testAZeroInARefusedGroupIsCarriedOut(self):
        belt = self.bench['belt_1']
        belt.send(20.0)
        belt.wait(lambda s: s.running, 'runs')
        self.bench.send_group(belt_1=0.0, belt_2=99.0)
        belt.wait(lambda s: not s.run_command and not s.running, 'stopped')

    def testUnequalArraysAndUnknownNamesAreRefused(self):
        wait_for(lambda: self.bench.group.get_num_connections() > 0, 'the subscription')
        for message in (VelocityCommand(name=['belt_1', 'belt_2'], velocity=[10.0]),
                        VelocityCommand(name=['belt_1', 'nobody'], velocity=[10.0, 10.0]),
                        VelocityCommand(name=['belt_1', 'belt_1'], velocity=[10.0, 10.0])):
            self.bench.send_group(belt_1=0.0)
            wait_for(lambda: self.bench.bus_status.error_id == 0, 'no error on the bus')
            self.bench.group.publish(message)
            wait_for(lambda: self.bench.bus_status.error_id == InverterStatus.ERROR_OUT_OF_RANGE, 'refused: %s' % message)
            stays(lambda: not self.bench.turns('belt_1'), 'belt_1 at rest', 0.2)


if __name__ == '__main__':
    init('commands_test')
    rostest.rosrun('inverter_bus', 'commands', Commands)
    rospy.signal_shutdown('done')
