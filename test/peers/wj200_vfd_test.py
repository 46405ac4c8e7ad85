#!/usr/bin/env python3
"""LinuxCNC's wj200_vfd, a driver for the MX2's sister model, runs a motor on the simulated bus.

It sends without the silence that Modbus asks for between two frames, which real drives seem to forgive: --gap ignore.
"""
import re
import shutil
import subprocess
import unittest

from simulated_line import SimulatedLine

SCAN_LIST = '''
baud_rate: 9600
scan_list: [{name: spindle, node: 1, drive: omron_mx2}]
simulation: {spindle: {parameters: {F002: 1.0, F003: 1.0}}}
'''


@unittest.skipUnless(shutil.which('halrun'), 'LinuxCNC (linuxcnc-uspace) is not installed')
class Wj200Vfd(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.line = SimulatedLine(SCAN_LIST, '--gap', 'ignore')
        cls.hal = subprocess.Popen(['halrun', '-s'], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, universal_newlines=True, bufsize=1)
        cls.tell('loadusr -W wj200_vfd -n wj200 --device=%s --baud=9600 --parity=none --stopbits=1' % cls.line.link)

    @classmethod
    def tearDownClass(cls):
        cls.tell('exit')
        cls.hal.stdin.close()
        try:
            cls.hal.wait(10.0)
        except subprocess.TimeoutExpired:
            cls.hal.kill()
            cls.hal.wait()
        cls.hal.stdout.close()
        cls.line.close()

    @classmethod
    def tell(cls, line):
        cls.hal.stdin.write(line + '\n')
        cls.hal.stdin.flush()

    def pin(self, name):
        self.tell('getp wj200.0.' + name)
        while True:
            answer = self.hal.stdout.readline()
            if answer == '':
                raise AssertionError('halrun ended')
            match = re.search(r'(?:^|%\s*)(TRUE|FALSE|-?[\d.]+(?:e[-+]?\d+)?)\s*$', answer)
            if match:
                return match.group(1)

    def testItRunsTheMotorAndSeesItRun(self):
        self.tell('setp wj200.0.mbslaveaddr 1')
        self.tell('setp wj200.0.enable TRUE')
        self.tell('setp wj200.0.commanded-frequency 25')
        self.tell('setp wj200.0.run TRUE')
        self.line.wait_for(lambda: abs(float(self.line.real('spindle')['frequency']) - 25.0) < 0.1, '25 Hz at the motor')
        self.line.wait_for(lambda: self.pin('is-running') == 'TRUE', 'wj200_vfd sees it run')
        self.tell('setp wj200.0.run FALSE')
        self.line.wait_for(lambda: self.line.real('spindle')['running'] == '0', 'the motor at rest')


if __name__ == '__main__':
    unittest.main()
