#!/usr/bin/env python3
"""read_parameter and write_parameter, through the scheduler to the drive's RAM and EEPROM."""
import unittest

import rostest
import rospy
from harness import Bench, belts, init, is_nan
from inverter_bus.msg import InverterStatus


class Parameters(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.bench = Bench(belts(1))
        cls.bench.start_driver()
        cls.belt = cls.bench['belt_1']

    @classmethod
    def tearDownClass(cls):
        cls.bench.close()

    def stored(self):
        return int(self.bench.real('belt_1')['eeprom_writes'])

    def testReadsByTheDrivesCodeWithScaleAndUnit(self):
        self.bench.simulate('belt_1 set F002 12.34')
        answer = self.belt.read_parameter('F002')
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(answer.error_id, 0)
        self.assertAlmostEqual(answer.value, 12.34)
        self.assertEqual(answer.unit, 's')

    def testReadsByTheNumberInTheManual(self):
        answer = self.belt.read_parameter('0x1201')
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(answer.value, 3.0)

    def testAWriteWithoutPersistStaysInRam(self):
        writes = self.stored()
        answer = self.belt.write_parameter('F002', 3.21)
        self.assertTrue(answer.success, answer.message)
        self.assertIn('3.21', self.bench.simulate('belt_1 get F002'))
        self.assertEqual(self.stored(), writes)
        self.assertAlmostEqual(self.belt.read_parameter('F002').value, 3.21)

    def testPersistStoresAndNamesWhatItStored(self):
        writes = self.stored()
        self.assertTrue(self.belt.write_parameter('F003', 4.5).success)
        answer = self.belt.write_parameter('F002', 2.5, persist=True)
        self.assertTrue(answer.success, answer.message)
        self.assertIn('F002', answer.message)
        self.assertIn('F003', answer.message)
        self.assertGreater(self.stored(), writes)
        self.bench.simulate('belt_1 power_cycle')
        self.belt.wait(lambda s: s.communication_error, 'offline')
        self.belt.wait_online()
        self.assertAlmostEqual(self.belt.read_parameter('F002').value, 2.5)
        self.assertAlmostEqual(self.belt.read_parameter('F003').value, 4.5)

    def assertRefused(self, answer, error_id):
        self.assertFalse(answer.success)
        self.assertEqual(answer.error_id, error_id, answer.message)
        self.assertTrue(answer.message)

    def testStationAndSerialSettingsNeedPersist(self):
        for name in ('C071', 'C072', 'C074', 'C075'):
            before = self.bench.simulate('belt_1 get ' + name)
            self.assertFalse(self.belt.write_parameter(name, 1.0).success)
            self.assertEqual(self.bench.simulate('belt_1 get ' + name), before)

    def testUnknownNamesAreRefused(self):
        self.assertFalse(self.belt.read_parameter('Z999').success)
        self.assertTrue(is_nan(self.belt.read_parameter('Z999').value))
        self.assertFalse(self.belt.write_parameter('Z999', 1.0).success)

    def testCommandRegistersAreNeverWritable(self):
        for name in ('0x0001', '0x0002', '0x0900', '0x1F01', 'F001'):
            self.assertFalse(self.belt.write_parameter(name, 10.0).success, name)
        self.assertEqual(float(self.bench.real('belt_1')['reference']), 0.0)

    def testValuesThatDoNotFitAreRefused(self):
        for value in (-1.0, 1e9, float('nan'), float('inf'), 1.2345):
            self.assertRefused(self.belt.write_parameter('F002', value), InverterStatus.ERROR_OUT_OF_RANGE)

    def testWhatMayNotChangeWhileRunningIsRefusedThen(self):
        with self.bench.run('belt_1', 20.0):
            before = self.bench.simulate('belt_1 get A002')
            self.assertFalse(self.belt.write_parameter('A002', 2.0).success)
            self.assertEqual(self.bench.simulate('belt_1 get A002'), before)
            self.assertTrue(self.belt.write_parameter('F002', 0.5).success)
        self.belt.stop()
        self.belt.wait(lambda s: not s.running, 'at rest')

    def testADrivesOwnRefusalComesBackAsItsException(self):
        # 0xFF00 is no register of the drive.
        answer = self.belt.read_parameter('0xFF00')
        self.assertFalse(answer.success)
        self.assertEqual(answer.error_id & 0xFF00, 0x8300, answer.message)

    def testReadOnlyRefusesEveryWrite(self):
        bench = Bench(belts(1), parameter_access='read_only')
        try:
            bench.start_driver()
            belt = bench['belt_1']
            self.assertTrue(belt.read_parameter('F002').success)
            before = bench.simulate('belt_1 get F002')
            answer = belt.write_parameter('F002', 9.0)
            self.assertFalse(answer.success)
            self.assertEqual(answer.error_id, InverterStatus.ERROR_NOT_OFFERED)
            self.assertIn('read_only', answer.message)
            self.assertEqual(bench.simulate('belt_1 get F002'), before)
        finally:
            bench.close()


if __name__ == '__main__':
    init('parameters_test')
    rostest.rosrun('inverter_bus', 'parameters', Parameters)
    rospy.signal_shutdown('done')
