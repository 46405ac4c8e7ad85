#!/usr/bin/env python3
"""OMRON 3G3JE drives on CompoWay/F: as shipped they are watched, with the codes of their manual they run.

The codes that a user would take from page 2-14 of the manual are invented here, for the simulated drive and for the
driver alike; the profile ships none.
"""
import unittest

import rostest
import rospy
from harness import Bench, init, is_nan, stays, wait_for
from inverter_bus.msg import InverterStatus

# Some look like a number in exponential notation, an octal one and a plain one: they are none of these.
CODES = {'run_forward': '01E2', 'run_reverse': '0017', 'stop': '2100', 'fault_reset': '22A0', 'ram_write_mode': '2301',
         'setup_area_0': '2400', 'setup_area_1': '2401'}
# Of the simulated drive, as its status word C0/0003 is invented: bit 15 tripped, 14 reverse, 13 running.
STATUS = {'faulted': {'variable': 'C0/0003', 'bit': 15},
          'direction': {'variable': 'C0/0003', 'mask': 0x6000, 'values': {'0': 0, '0x2000': 1, '0x6000': -1}}}
CHECKED = ['current_scale', 'controller_status_meaning']
QUICK = {'acceleration': 0.5, 'deceleration': 0.5}
MODEL = '3G3JE202BF'
MANUAL = 'I548-E1 page 2-14'


class Fans(unittest.TestCase):
    bench = None

    @classmethod
    def tearDownClass(cls):
        if cls.bench:
            cls.bench.close()

    def assertRefused(self, answer, error_id, *words):
        self.assertFalse(answer.success, answer.message)
        self.assertEqual(answer.error_id, error_id, answer.message)
        for word in words:
            self.assertIn(word, answer.message)

    def assertVelocityRefused(self, name, velocity, *words):
        """With 0xB006, a text that helps, and nothing sent."""
        fan = self.bench[name]
        fan.send(0.0)
        fan.wait(lambda s: s.error_id == 0, 'a 0 is never refused')
        operations = self.operations(name)
        fan.forget()
        fan.send(velocity)
        status = fan.wait(lambda s: s.error_id == InverterStatus.ERROR_NOT_ARMED, 'refused')
        for word in words:
            self.assertIn(word, status.error_text)
        self.assertFalse(status.run_command)
        self.assertEqual(self.operations(name), operations)
        self.assertFalse(self.bench.turns(name))

    def operations(self, name):
        """What the last frames command a station: service 3005 or a write of the reference."""
        station = '%02d' % int(self.bench.real(name)['station'])
        bodies = [frame.bytes[1:].decode('ascii', 'replace') for frame in self.bench.frames()
                  if frame.sender == 'master' and frame.station == station]
        return [body for body in bodies if body[5:9] in ('3005', '0102')]


class FansOnOneLine(Fans):
    """fan_1 as shipped, fan_2 with all of the manual's codes, fan_3 with as few as can be."""

    @classmethod
    def setUpClass(cls):
        entries = [
            {'name': 'fan_1', 'node': 1},
            {'name': 'fan_2', 'node': 2, 'confirm': CHECKED, 'overrides': {'operation_codes': CODES, 'status': STATUS}},
            {'name': 'fan_3', 'node': 3, 'confirm': CHECKED,
             'overrides': {'operation_codes': {'run_forward': CODES['run_forward'], 'stop': CODES['stop']}}},
        ]
        entries = [dict(entry, drive='omron_3g3je') for entry in entries]
        drive = {'operation_codes': CODES, 'parameters': QUICK}
        cls.bench = Bench(entries, ramps=False, protocol='compoway_f', baud_rate=9600, data_bits=8, parity='even',
                          stop_bits=1, defaults={'max_velocity': 60.0, 'command_timeout': 0.0},
                          simulation={entry['name']: drive for entry in entries})
        cls.bench.start_driver()

    def setUp(self):
        for name in ('fan_2', 'fan_3'):
            if self.bench[name].status.faulted:
                self.assertTrue(self.bench[name].reset().success)
        self.bench.unlock()
        for name in ('fan_2', 'fan_3'):
            self.bench[name].wait(lambda s: not s.running and not s.run_command, 'at rest')

    # As shipped.

    def testAsShippedItRefusesToMoveAndNamesThePageOfTheManual(self):
        for velocity in (20.0, -20.0):
            self.assertVelocityRefused('fan_1', velocity, 'stop', MANUAL)
        self.assertVelocityRefused('fan_1', 20.0, 'run_forward')
        self.assertVelocityRefused('fan_1', -20.0, 'run_reverse')

    def testAsShippedItsFrequencyIsRead(self):
        fan = self.bench['fan_1']
        self.bench.simulate('fan_1 panel 25')
        try:
            status = fan.wait(lambda s: abs(s.output_frequency - 25.0) < 0.05, '25 Hz')
            self.assertTrue(status.known & InverterStatus.KNOWN_OUTPUT_FREQUENCY)
            self.assertTrue(is_nan(status.output_current), 'its scale is not confirmed')
            self.assertFalse(status.known & (InverterStatus.KNOWN_OUTPUT_CURRENT | InverterStatus.KNOWN_RUNNING |
                                             InverterStatus.KNOWN_DIRECTION | InverterStatus.KNOWN_FAULTED))
            self.assertTrue(is_nan(status.velocity), 'without a direction no velocity')
        finally:
            self.bench.simulate('fan_1 panel_release')
        fan.wait(lambda s: s.output_frequency == 0.0, 'at rest')

    def testItSaysWhatItIs(self):
        for name in ('fan_1', 'fan_2'):
            self.assertEqual(self.bench[name].status.drive, 'omron_3g3je ' + MODEL)
            wait_for(lambda: self.bench.value(name, 'model reported by the drive') == MODEL, 'model of ' + name)

    def testAsShippedTheServicesSayWhatIsMissing(self):
        fan = self.bench['fan_1']
        self.assertRefused(fan.read_faults(), InverterStatus.ERROR_NOT_OFFERED)
        self.assertRefused(fan.reset(), InverterStatus.ERROR_NOT_ARMED, 'fault_reset', MANUAL)
        before = self.bench.simulate('fan_1 get P06')
        self.assertRefused(fan.write_parameter('P06', 80.0), InverterStatus.ERROR_NOT_ARMED, 'setup_area_1', MANUAL)
        self.assertEqual(self.bench.simulate('fan_1 get P06'), before)
        answer = fan.stop()
        self.assertFalse(answer.success)
        self.assertEqual(answer.error_id, InverterStatus.ERROR_NOT_ARMED, answer.message)

    def testAsShippedParametersAreRead(self):
        self.bench.simulate('fan_1 set P06 75')
        for name in ('P06', 'C3/0005'):
            answer = self.bench['fan_1'].read_parameter(name)
            self.assertTrue(answer.success, answer.message)
            self.assertAlmostEqual(answer.value, 75.0)
        self.assertEqual(answer.unit, 'Hz')
        self.bench.simulate('fan_1 set P06 60')

    def testDiagnosticsNamesWhatIsMissing(self):
        entry = self.bench.finding('fan_1', 'run_forward', 'run_reverse', 'stop', 'fault_reset', 'ram_write_mode',
                                   'current_scale', MANUAL)
        self.assertEqual(entry.level, 1)
        self.assertIn('runs on', self.bench.value('fan_1', 'drive time-out') + entry.message)

    # With the manual's codes.

    def reach(self, name, velocity, direction):
        fan = self.bench[name]
        fan.send(velocity)
        status = fan.wait(lambda s: s.running and abs(s.velocity - velocity) < 0.15, 'at %g' % velocity)
        self.assertEqual(status.direction, direction)
        self.assertEqual(status.error_id, 0, status.error_text)
        self.assertTrue(status.run_command)
        self.assertGreater(status.output_current, 0.0)
        wait_for(lambda: abs(self.bench.frequency(name) - velocity) < 0.05, 'the motor at %g Hz' % velocity)

    def testWithItsCodesItMovesChangesReversesAndStops(self):
        fan = self.bench['fan_2']
        self.reach('fan_2', 15.0, InverterStatus.DIRECTION_FORWARD)
        self.reach('fan_2', 30.0, InverterStatus.DIRECTION_FORWARD)
        self.reach('fan_2', -20.0, InverterStatus.DIRECTION_REVERSE)
        answer = fan.stop()
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(self.bench.real('fan_2')['run_command'], '0')
        status = fan.wait(lambda s: not s.running and s.output_frequency == 0.0, 'at rest')
        self.assertTrue(status.locked)
        self.assertFalse(self.bench.turns('fan_2'))

    def testAStopIsConfirmedBeforeALongRampIsOver(self):
        self.bench.simulate('fan_2 set deceleration 10')
        try:
            self.reach('fan_2', 50.0, InverterStatus.DIRECTION_FORWARD)
            answer = self.bench['fan_2'].stop()
            self.assertTrue(answer.success, answer.message)
            self.assertTrue(self.bench.turns('fan_2'), 'still ramping down')
        finally:
            self.bench.simulate('fan_2 set deceleration 0.5')

    def testItTripsAndIsReset(self):
        fan = self.bench['fan_2']
        with self.bench.run('fan_2', 25.0):
            self.bench.simulate('fan_2 trip 1')
            status = fan.wait(lambda s: s.faulted and not s.run_command, 'tripped, RUN taken off')
            self.assertTrue(status.locked)
            self.assertFalse(status.known & InverterStatus.KNOWN_FAULT_CODE)
            self.bench.finding('fan_2', 'tripped')
            answer = fan.reset()
            self.assertTrue(answer.success, answer.message)
            fan.wait(lambda s: not s.faulted, 'no fault')
            stays(lambda: not self.bench.turns('fan_2'), 'stands under a stream of commands', 1.5)
        self.bench.unlock('fan_2')
        self.reach('fan_2', 10.0, InverterStatus.DIRECTION_FORWARD)

    def testTheRamWriteModeSparesTheEeprom(self):
        wait_for(lambda: self.bench.real('fan_2')['write_mode'] == 'ram', 'RAM write mode')
        before = self.bench.real('fan_2')
        for velocity in range(10, 30, 2):
            self.reach('fan_2', float(velocity), InverterStatus.DIRECTION_FORWARD)
        self.assertTrue(self.bench['fan_2'].stop().success)
        self.assertEqual(self.bench.real('fan_2')['eeprom_writes'], before['eeprom_writes'])
        self.assertNotIn('EEPROM', self.bench.finding('fan_2').message)

    def testTheRamWriteModeIsSetAgainAfterAnOutage(self):
        fan = self.bench['fan_2']
        self.bench.simulate('fan_2 power off')
        fan.wait(lambda s: s.communication_error, 'offline')
        self.bench.simulate('fan_2 power on')
        self.assertEqual(self.bench.real('fan_2')['write_mode'], 'backup')
        fan.wait_online()
        wait_for(lambda: self.bench.real('fan_2')['write_mode'] == 'ram', 'RAM write mode')
        stays(lambda: not self.bench.turns('fan_2'), 'at rest', 0.5)

    def testTheRamWriteModeIsSetAgainAfterAShortPowerCycle(self):
        """Too short for `offline`, but some exchanges got lost."""
        self.bench.simulate('fan_2 power_cycle 1.5')
        self.assertEqual(self.bench.real('fan_2')['write_mode'], 'backup')
        wait_for(lambda: self.bench.real('fan_2')['write_mode'] == 'ram', 'RAM write mode')
        self.bench.unlock('fan_2')
        writes = self.bench.real('fan_2')['eeprom_writes']
        self.reach('fan_2', 12.0, InverterStatus.DIRECTION_FORWARD)
        self.reach('fan_2', 14.0, InverterStatus.DIRECTION_FORWARD)
        self.assertEqual(self.bench.real('fan_2')['eeprom_writes'], writes)

    def testWithoutTheRamWriteModeOnlyChangesAreWrittenAndTheWearIsTold(self):
        before = int(self.bench.real('fan_3')['eeprom_writes'])
        fan = self.bench['fan_3']
        for velocity in (20.0, 25.0):
            for _ in range(5):
                fan.send(velocity)
                fan.fresh()
            wait_for(lambda: abs(self.bench.frequency('fan_3') - velocity) < 0.05, 'at %g' % velocity)
        self.assertTrue(fan.stop().success)
        self.assertEqual(int(self.bench.real('fan_3')['eeprom_writes']), before + 2)
        self.assertEqual(self.bench.finding('fan_3', 'EEPROM', 'ram_write_mode').level, 1)
        self.assertVelocityRefused('fan_3', -20.0, 'run_reverse', MANUAL)

    def testAParameterIsWrittenThroughTheSetupAreaAtStandstillOnly(self):
        fan = self.bench['fan_2']
        answer = fan.write_parameter('P06', 80.0)
        self.assertTrue(answer.success, answer.message)
        self.assertIn('80', self.bench.simulate('fan_2 get P06'))
        self.assertEqual(self.bench.real('fan_2')['setup_area'], '0')
        self.assertAlmostEqual(fan.read_parameter('P06').value, 80.0)
        self.reach('fan_2', 20.0, InverterStatus.DIRECTION_FORWARD)
        self.assertRefused(fan.write_parameter('P06', 70.0), InverterStatus.ERROR_NOT_OFFERED, 'runs')
        self.assertTrue(self.bench.turns('fan_2'))
        self.assertIn('80', self.bench.simulate('fan_2 get P06'))
        self.assertTrue(fan.stop().success)
        fan.wait(lambda s: not s.running, 'at rest')
        self.assertTrue(fan.write_parameter('P06', 60.0).success)

    def testStopOfAllSendsNoBroadcast(self):
        self.reach('fan_2', 20.0, InverterStatus.DIRECTION_FORWARD)
        self.bench['fan_3'].send(20.0)
        wait_for(lambda: self.bench.turns('fan_3'), 'fan_3 runs')
        answer = self.bench.stop_all()
        frames = self.bench.frames()
        wait_for(lambda: not self.bench.turns('fan_2') and not self.bench.turns('fan_3'), 'both at rest')
        self.assertEqual([frame.text for frame in frames if frame.station == 'XX'], [])
        # fan_1 can't be stopped by anyone who lacks the code, and the answer says so.
        self.assertFalse(answer.success)
        self.assertIn('fan_1', answer.message)
        for name in ('fan_2', 'fan_3'):
            self.assertEqual(self.bench.real(name)['run_command'], '0')


class FansAsDelivered(Fans):
    """The line as the drives leave the factory, 7E2; fan_2 is commanded by its terminals."""

    @classmethod
    def setUpClass(cls):
        entries = [{'name': 'fan_%d' % node, 'node': node, 'drive': 'omron_3g3je', 'confirm': CHECKED,
                    'overrides': {'operation_codes': CODES, 'status': STATUS}} for node in (1, 2)]
        drive = {'operation_codes': CODES, 'parameters': QUICK}
        cls.bench = Bench(entries, ramps=False, protocol='compoway_f', baud_rate=9600, data_bits=7, parity='even',
                          stop_bits=2, defaults={'max_velocity': 60.0, 'command_timeout': 0.0},
                          simulation={'fan_1': drive, 'fan_2': dict(drive, parameters=dict(QUICK, P10=1))})
        cls.bench.start_driver()

    def testSevenBitsEvenParityAndTwoStopBitsWorkToo(self):
        fan = self.bench['fan_1']
        self.bench.unlock('fan_1')
        fan.send(20.0)
        fan.wait(lambda s: s.running and abs(s.velocity - 20.0) < 0.15, 'at 20')
        self.assertTrue(fan.stop().success)
        fan.wait(lambda s: not s.running, 'at rest')

    def testADriveThatItsTerminalsCommandIsTold(self):
        entry = self.bench.finding('fan_2', 'not commanded by the bus', 'C3/0009')
        self.assertEqual(entry.level, 1)
        self.assertNotIn('not commanded', self.bench.finding('fan_1').message)


def suite():
    loader = unittest.TestLoader()
    return unittest.TestSuite(loader.loadTestsFromTestCase(case) for case in (FansOnOneLine, FansAsDelivered))


if __name__ == '__main__':
    init('compoway_fans_test')
    rostest.rosrun('inverter_bus', 'compoway_fans', '__main__.suite')
    rospy.signal_shutdown('done')
