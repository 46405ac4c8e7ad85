#!/usr/bin/env python3
"""LinuxCNC's vfs11_vfd, a driver for the VF-S15's predecessor, runs a motor of either on the simulated bus.

It sends without the silence that Modbus asks for between two frames, which real drives seem to forgive: --gap ignore.
"""
import os
import re
import shutil
import subprocess
import unittest

from simulated_line import SimulatedLine

# vfs11_vfd of LinuxCNC 2.9 always asks for the second ramps, F500 and F501, whatever its pin says.
SCAN_LIST = '''
baud_rate: 19200
parity: even
scan_list: [{name: spindle, node: 5, drive: %s}]
simulation: {spindle: {parameters: {F500: 1.0, F501: 1.0, UL: 55.0, FE70: 9.5}}}
'''
SETTINGS = '''
[VFS11]
TYPE = rtu
DEVICE = %s
TARGET = 5
BAUD = 19200
BITS = 8
PARITY = even
STOPBITS = 1
'''
PINS = 'vfs11_vfd.'


@unittest.skipUnless(shutil.which('halrun'), 'LinuxCNC (linuxcnc-uspace) is not installed')
class Vfs11Vfd(unittest.TestCase):
    model = 'toshiba_vfs11'

    @classmethod
    def setUpClass(cls):
        cls.line = SimulatedLine(SCAN_LIST % cls.model, '--gap', 'ignore')
        settings = os.path.join(cls.line.directory, 'vfs11.ini')
        with open(settings, 'w') as stream:
            stream.write(SETTINGS % cls.line.link)
        environment = dict(os.environ, RTAPI_UID=os.environ.get('RTAPI_UID', '65534'))  # LinuxCNC refuses to run as root
        cls.hal = subprocess.Popen(['halrun', '-s'], stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment,
                                   stderr=subprocess.STDOUT, universal_newlines=True, bufsize=1)
        cls.tell('loadusr -Wn vfs11_vfd vfs11_vfd --ini=%s' % settings)

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

    def real(self, key):
        return self.line.real('spindle')[key]

    def waitForFrequency(self, hertz, direction):
        self.line.wait_for(lambda: abs(float(self.real('frequency')) - hertz) < 0.1 and
                           self.real('direction') == direction, '%g Hz at the motor' % hertz)
        self.line.wait_for(lambda: abs(float(self.pin('frequency-out')) - hertz) < 0.1, 'vfs11_vfd sees it turn')

    def testItRunsReversesTripsAndResets(self):
        self.line.wait_for(lambda: self.pin('modbus-ok') == 'TRUE', 'vfs11_vfd is content with the communication')
        self.assertEqual(float(self.pin('frequency-limit')), 55.0)
        self.assertEqual(self.pin('is-stopped'), 'TRUE')
        self.assertEqual(self.pin('error-count'), '0')

        self.setPin('enable', 'TRUE')
        self.setPin('speed-command', '705')  # of 1410 at 50 Hz
        self.setPin('spindle-on', 'TRUE')
        self.waitForFrequency(25.0, '1')
        self.line.wait_for(lambda: self.pin('at-speed') == 'TRUE', 'vfs11_vfd sees it at speed')
        self.assertEqual(self.real('command'), 'C440')
        self.setPin('spindle-fwd', 'FALSE')
        self.waitForFrequency(25.0, '-1')

        self.setPin('estop', 'TRUE')
        self.line.wait_for(lambda: self.pin('is-e-stopped') == 'TRUE', 'vfs11_vfd sees the emergency stop')
        self.line.wait_for(lambda: self.pin('trip-code') == '17', 'vfs11_vfd reads the trip code')
        self.assertEqual(self.real('running'), '0')
        self.assertEqual(self.pin('error-count'), '0')
        self.setPin('err-reset', 'TRUE')  # not answered, and 1 s of silence after it
        self.line.wait_for(lambda: self.real('trip') == '0', 'the trip is reset')
        self.line.wait_for(lambda: self.pin('is-e-stopped') == 'FALSE', 'vfs11_vfd sees the drive ready again')
        self.line.wait_for(lambda: self.pin('modbus-ok') == 'TRUE', 'vfs11_vfd is content again')

        self.setPin('spindle-on', 'TRUE')
        self.waitForFrequency(25.0, '-1')
        self.setPin('spindle-on', 'FALSE')
        self.waitForFrequency(0.0, '0')
        self.setPin('enable', 'FALSE')
        self.line.wait_for(lambda: self.real('command') == '0000', 'the drive is handed back')


class Vfs11VfdOnVfs15(Vfs11Vfd):
    model = 'toshiba_vfs15'


if __name__ == '__main__':
    unittest.main()
