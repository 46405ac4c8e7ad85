#!/usr/bin/env python3
"""The commands of the README's first scan list do what it says when they are typed."""
import os
import re
import signal
import subprocess
import unittest

import rostest
import rospy
from harness import Bench, PATIENCE, init, wait_for

README = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'README.md')


def typed(program):
    """Lines of the README's blocks that begin with it."""
    with open(README, encoding='utf-8') as stream:
        return re.findall(r'^(%s .*)$' % program, stream.read(), re.MULTILINE)


class ReadmeCommands(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.bench = Bench([{'name': 'belt_main', 'node': 2, 'drive': 'omron_mx2', 'hz_per_unit': 100.0,
                            'max_velocity': 0.5}])
        cls.bench.start_driver()

    @classmethod
    def tearDownClass(cls):
        cls.bench.close()

    def here(self, line):
        return line.replace('/conveyor', self.bench.driver_name)

    def testServiceCallsSucceed(self):
        lines = typed('rosservice call')
        self.assertGreater(len(lines), 3)
        for line in lines:
            answer = subprocess.run(['bash', '-c', self.here(line)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                    universal_newlines=True, timeout=4 * PATIENCE, check=False)
            self.assertEqual(answer.returncode, 0, '%s: %s' % (line, answer.stdout))
            self.assertIn('success: True', answer.stdout, line)

    def testVelocitiesRunTheMotorInTheSenseThatStandsThere(self):
        lines = typed('rostopic pub')
        self.assertEqual(len(lines), 2)
        belt = self.bench['belt_main']
        for line, velocity in zip(lines, (0.2, -0.2)):
            belt.fresh()  # one from before the stop may still say that it is free
            belt.wait(lambda status: not status.locked, 'unlocked by silence')
            publisher = subprocess.Popen(['bash', '-c', 'exec ' + self.here(line)], stdout=subprocess.DEVNULL,
                                         stderr=subprocess.PIPE, universal_newlines=True, start_new_session=True)
            try:
                wait_for(lambda: abs(belt.status.velocity - velocity) < 0.005 or publisher.poll() is not None,
                         lambda: '%s: %s' % (line, belt.status))
                self.assertIsNone(publisher.poll(), line)
            finally:
                publisher.send_signal(signal.SIGINT)
                publisher.communicate(timeout=PATIENCE)
            answer = belt.stop()
            self.assertTrue(answer.success, answer.message)


if __name__ == '__main__':
    init('readme_commands_test')
    rostest.rosrun('inverter_bus', 'readme_commands', ReadmeCommands)
    rospy.signal_shutdown('done')
