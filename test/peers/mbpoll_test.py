#!/usr/bin/env python3
"""mbpoll, an independent Modbus client, reads and writes a simulated drive."""
import shutil
import subprocess
import unittest

from simulated_line import SimulatedLine

SCAN_LIST = '''
baud_rate: 19200
scan_list: [{name: belt, node: 3, drive: omron_mx2}]
simulation: {belt: {parameters: {F002: 12.34}}}
'''


@unittest.skipUnless(shutil.which('mbpoll'), 'mbpoll is not installed')
class Mbpoll(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.line = SimulatedLine(SCAN_LIST)

    @classmethod
    def tearDownClass(cls):
        cls.line.close()

    def mbpoll(self, *arguments):
        answer = subprocess.run(['mbpoll', '-m', 'rtu', '-a', '3', '-b', '19200', '-P', 'none', '-1', '-q'] +
                                list(arguments[:-1]) + [self.line.link] + [str(value) for value in arguments[-1]],
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, timeout=30)
        self.assertEqual(answer.returncode, 0, answer.stdout)
        return answer.stdout

    def testItReadsAParameterByTheNumberInTheManual(self):
        answer = self.mbpoll('-t', '4', '-r', str(0x1103), '-c', '2', [])
        self.assertRegex(answer, r'\[%d\]:\s+0\b' % 0x1103)
        self.assertRegex(answer, r'\[%d\]:\s+1234\b' % 0x1104)

    def testItRunsAndStopsTheMotorByCoilAndRegister(self):
        self.mbpoll('-t', '4', '-r', '1', [0, 2000])
        self.assertEqual(float(self.line.real('belt')['reference']), 20.0)
        self.mbpoll('-t', '0', '-r', '1', [1])
        self.line.wait_for(lambda: float(self.line.real('belt')['frequency']) > 1.0, 'the motor turning')
        self.mbpoll('-t', '0', '-r', '1', [0])
        self.line.wait_for(lambda: self.line.real('belt')['running'] == '0', 'the motor at rest')


if __name__ == '__main__':
    unittest.main()
