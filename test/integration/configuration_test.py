#!/usr/bin/env python3
"""A wrong configuration ends the node with status 1 and one line, before the port is opened; bit masks as scan lists."""
import os
import unittest

import roslib.packages
import rostest
import rospy
from harness import Bench, belts, init

LONG = 60.0  # [s]


class Configuration(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.bench = Bench(belts(2))
        cls.broken_profile = os.path.join(cls.bench.directory, 'broken.yaml')
        with open(cls.broken_profile, 'w') as stream:
            stream.write('name: broken\ntitle: [not closed\nprotocol: modbus_rtu\n')
        cls.wrong_profile = os.path.join(cls.bench.directory, 'wrong.yaml')
        with open(os.path.join(roslib.packages.get_pkg_dir('inverter_bus'), 'config/drives/omron_mx2.yaml')) as stream:
            good = stream.read()
        cls.wrong_place = '%s:%d' % (cls.wrong_profile, good.count('\n') + 1)
        with open(cls.wrong_profile, 'w') as stream:
            stream.write(good + 'no_such_section: 1\n')

    @classmethod
    def tearDownClass(cls):
        cls.bench.close()

    def assertEndsNaming(self, words, **changes):
        """Starts the driver with changed parameters; its one line must hold all of the words."""
        process = self.bench.start_driver(online=False, **changes)
        self.assertEqual(process.wait(LONG), 1, process.log())
        lines = [line for line in process.log().splitlines() if line.strip()]
        self.assertEqual(len(lines), 1, process.log())
        for word in words:
            self.assertIn(str(word), lines[0])
        self.assertIn('requests=0', self.bench.simulate('bus show'), 'something was sent')

    def assertEntryEndsNaming(self, words, remove=None, **changes):
        """The same for a change of the second entry of the scan list."""
        entries = belts(2)
        entries[1].update(changes)
        if remove:
            del entries[1][remove]
        self.assertEndsNaming(words, scan_list=entries)

    def logOfADriverThatRuns(self, **changes):
        """On a line of its own: nothing may be sent on the others'."""
        bench = Bench(belts(1))
        try:
            return bench.start_driver(**changes).log()
        finally:
            bench.close()

    def testUnknownKeys(self):
        self.assertEndsNaming(['baudrate', 'baud_rate'], baudrate=9600)
        self.assertEntryEndsNaming(['nod', 'scan_list[1]'], nod=3)
        self.assertEndsNaming(['defaults', 'velocity'], defaults={'velocity': 3.0})

    def testKeysOfAnotherPlaceOrOfALaterVersion(self):
        self.assertEndsNaming(['command_timeout', 'scan_list or defaults'], command_timeout=1.0)
        self.assertEntryEndsNaming(['in_service', 'later version'], in_service=False)

    def testWhatLiesBelowTheNameForOthersIsIgnoredWithAWarning(self):
        log = self.logOfADriverThatRuns(rate=10, diagnostic_period=0.5, teleop={'scale': 2.0})
        for name in ('rate', 'teleop'):
            self.assertEqual(len([line for line in log.splitlines() if "'%s'" % name in line]), 1, log)
        self.assertNotIn('diagnostic_period', log)

    def testNumbersThatAreTextsGetAHint(self):
        self.assertEntryEndsNaming(['node', "'08'", 'write 8'], node='08')
        self.assertEntryEndsNaming(['node', "'2'", 'without quotes'], node='2')
        self.assertIn('write 0.005', self.logOfADriverThatRuns(interval='5e-3'))

    def testAWrongConfirmIsNamedWhereItStands(self):
        entries = belts(2)
        for entry in entries:
            del entry['drive']
        entries[1]['confirm'] = ['no_such_item']
        self.assertEndsNaming(['~scan_list[1] (belt_2)', 'confirm', 'no_such_item'], scan_list=entries,
                              defaults={'drive': 'omron_mx2'})

    def testMissingKeys(self):
        self.assertEntryEndsNaming(['name', 'scan_list[1]'], remove='name')
        self.assertEntryEndsNaming(['node', 'scan_list[1]'], remove='node')
        self.assertEntryEndsNaming(['drive', 'scan_list[1]'], remove='drive')

    def testDuplicates(self):
        self.assertEntryEndsNaming(['name', 'belt_1'], name='belt_1')
        self.assertEntryEndsNaming(['node', '1', 'belt_1'], node=1)

    def testIllegalAndReservedNames(self):
        for name in ('2belts', 'belt-2', 'belt 2', '/belt', ''):
            self.assertEntryEndsNaming(['name', name], name=name)
        for name in ('bus', 'command', 'stop', 'bus_status', 'dump_trace'):
            self.assertEntryEndsNaming(['name', name], name=name)

    def testStationsOutsideTheDrivesRange(self):
        for node in (0, 248, -1, 1000):
            self.assertEntryEndsNaming(['node', node], node=node)
        self.assertEntryEndsNaming(['node', '33', '32'], node=33, drive='omron_rx')

    def testUnknownAndBrokenProfiles(self):
        self.assertEntryEndsNaming(['drive', 'no_such_drive', 'omron_mx2'], drive='no_such_drive')
        self.assertEntryEndsNaming(['/no/such/file.yaml'], drive='/no/such/file.yaml')
        self.assertEntryEndsNaming([self.broken_profile + ':'], drive=self.broken_profile)
        self.assertEntryEndsNaming([self.wrong_place, 'no_such_section'], drive=self.wrong_profile)

    def testLineSettingsThatPortOrDriveCannotUse(self):
        self.assertEndsNaming(['baud_rate', '12345'], baud_rate=12345)
        self.assertEndsNaming(['parity', 'mark'], parity='mark')
        self.assertEndsNaming(['data_bits', '7'], data_bits=7)
        self.assertEndsNaming(['stop_bits', '3'], stop_bits=3)
        self.assertEndsNaming(['rs485', 'maybe'], rs485='maybe')
        self.assertEndsNaming(['baud_rate', '115200', 'omron_rx'], baud_rate=115200, scan_list=belts(1, 'omron_rx'))

    def testNegativeTimesAndThingsThatAreNoNumbers(self):
        self.assertEndsNaming(['interval', '-1'], interval=-1.0)
        self.assertEndsNaming(['response_timeout'], response_timeout=-0.1)
        self.assertEndsNaming(['retries'], retries='many')
        self.assertEndsNaming(['retries', '-1'], retries=-1)
        self.assertEntryEndsNaming(['command_timeout', '-0.5', 'scan_list[1]'], command_timeout=-0.5)
        self.assertEntryEndsNaming(['hz_per_unit', 'fast'], hz_per_unit='fast')
        self.assertEndsNaming(['exclusive'], exclusive='perhaps')

    def testVelocities(self):
        self.assertEntryEndsNaming(['hz_per_unit', 'scan_list[1]'], hz_per_unit=0)
        self.assertEntryEndsNaming(['max_velocity', '5000'], max_velocity=5000.0)
        self.assertEntryEndsNaming(['min_velocity'], max_velocity=10.0, min_velocity=11.0)

    def testScanListsWithoutAnInverter(self):
        for scan_list in ([], 0, 1, '0x00000001', '#0', 'none', True):
            self.assertEndsNaming(['scan_list'], scan_list=scan_list, defaults={'drive': 'omron_mx2'})
        self.assertEndsNaming(['drive'], scan_list=6)

    def testAMissingScanList(self):
        entries = self.bench.parameters.pop('scan_list')
        try:
            process = self.bench.start_driver(online=False)
            self.assertEqual(process.wait(LONG), 1, process.log())
            self.assertIn('scan_list', process.log())
        finally:
            self.bench.parameters['scan_list'] = entries

    def assertMaskRuns(self, scan_list):
        """Stations 1 and 31 of a mask; bit 0 does not count."""
        simulate = [{'name': 'inverter_1', 'node': 1, 'drive': 'omron_mx2'},
                    {'name': 'inverter_31', 'node': 31, 'drive': 'omron_mx2'}]
        bench = Bench(scan_list, simulate=simulate, defaults={'drive': 'omron_mx2', 'hz_per_unit': 2.0})
        try:
            bench.listen(simulate)
            bench.start_driver()
            with bench.run('inverter_31', 10.0):
                self.assertAlmostEqual(bench.frequency('inverter_31'), 20.0, delta=0.5)
                self.assertEqual(bench['inverter_31'].status.node, 31)
                self.assertFalse(bench.turns('inverter_1'))
            statuses = [topic for topic, kind in rospy.get_published_topics(bench.driver_name)
                        if kind == 'inverter_bus/InverterStatus']
            self.assertEqual(len(statuses), 2, statuses)
        finally:
            bench.close()

    def testAScanListThatIsABitMaskAsInteger(self):
        self.assertMaskRuns(-2147483646)

    def testAScanListThatIsABitMaskAsText(self):
        self.assertMaskRuns('0x80000002')

    def testAScanListThatIsABitMaskInTheNotationOfAPlc(self):
        self.assertMaskRuns('#80000003')


if __name__ == '__main__':
    init('configuration_test')
    rostest.rosrun('inverter_bus', 'configuration', Configuration)
    rospy.signal_shutdown('done')
