#!/usr/bin/env python3
"""LinuxCNC's wj200_vfd, a driver for the MX2's sister model, runs a motor on the simulated bus.

It sends without the silence that Modbus asks for between two frames, which real drives seem to forgive: --gap ignore.
"""
import os
import re
import shutil
import subprocess
import unittest

from simulated_line import SimulatedLine

SCAN_LIST = '''
baud_rate: 9600
scan_list: [{name: spindle, node: 1, drive: omron_mx2}]
simulation: {spindle: {self_clearing_coils: true, parameters: {F002: 1.0, F003: 1.0}}}
'''
PINS = 'wj200-vfd.0.'


@unittest.skipUnless(shutil.which('halrun'), 'LinuxCNC (linuxcnc-uspace) is not installed')
class Wj200Vfd(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.line = SimulatedLine(SCAN_LIST, '--gap', 'ignore')
        environment = dict(os.environ, RTAPI_UID=os.environ.get('RTAPI_UID', '65534'))  # LinuxCNC refuses to run as root
        cls.hal = subprocess.Popen(['halrun', '-s'], stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment,
                                   stderr=subprocess.STDOUT, universal_newlines=True, bufsize=1)
        cls.tell('loadusr -W wj200_vfd --device=%s --baud=9600 --parity=none --stopbits=1' % cls.line.link)

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
        self.tell('getp ' + PINS + name)
        while True:
            answer = self.hal.stdout.readline()
            if answer == '':
                raise AssertionError('halrun ended')
            match = re.search(r'(?:^|%\s*)(TRUE|FALSE|-?[\d.]+(?:e[-+]?\d+)?)\s*$', answer)
            if match:
                return match.group(1)

    def setPin(self, name, value):
        self.tell('setp %s%s %s' % (PINS, name, value))

    def testItRunsTheMotorAndSeesItRun(self):
        self.setPin('mbslaveaddr', '1')
        for _ in range(2):
            self.enableRunAndStop()

    def enableRunAndStop(self):
        # Not enabled, it trips the drive (E12); enabled, it resets the trip.
        self.line.wait_for(lambda: self.line.real('spindle')['trip'] == '12', 'wj200_vfd trips the drive')
        self.setPin('enable', 'TRUE')
        self.setPin('commanded-frequency', '25')
        self.setPin('run', 'TRUE')
        self.line.wait_for(lambda: abs(float(self.line.real('spindle')['frequency']) - 25.0) < 0.1, '25 Hz at the motor')
        self.line.wait_for(lambda: self.pin('is-running') == 'TRUE', 'wj200_vfd sees it run')
        self.setPin('run', 'FALSE')
        self.line.wait_for(lambda: self.line.real('spindle')['running'] == '0', 'the motor at rest')
        self.setPin('enable', 'FALSE')


if __name__ == '__main__':
    unittest.main()
