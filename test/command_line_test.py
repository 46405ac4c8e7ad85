#!/usr/bin/env python3
"""The programs of the package explain themselves, and refuse what they don't know, before they do anything."""
import os
import subprocess
import unittest

PROGRAMS = ('inverter_bus_node', 'simulated_bus_node', 'simulated_bus', 'check_profile')
DIRECTORY = os.path.join(os.environ['INVERTER_BUS_BUILD'], 'devel', 'lib', 'inverter_bus')
# Nobody listens there: a program that asks the ROS master first would not come to its answer.
ENVIRONMENT = dict(os.environ, ROS_MASTER_URI='http://127.0.0.1:1')


def run(program, *arguments):
    return subprocess.run([os.path.join(DIRECTORY, program)] + list(arguments), stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, env=ENVIRONMENT,
                          timeout=60.0, check=False)


class CommandLine(unittest.TestCase):
    def testHelpIsAnsweredAndNothingIsStarted(self):
        for program in PROGRAMS:
            for option in ('--help', '-h'):
                answer = run(program, option)
                self.assertEqual(answer.returncode, 0, '%s %s: %s' % (program, option, answer.stderr))
                self.assertIn(program, answer.stdout)
                self.assertEqual(answer.stderr, '')

    def testNodesNameTheirParameters(self):
        self.assertIn('scan_list', run('inverter_bus_node', '--help').stdout)
        self.assertIn('link', run('simulated_bus_node', '--help').stdout)

    def testUnknownOptionsAreRefused(self):
        for program in PROGRAMS:
            answer = run(program, '--no-such-option')
            self.assertNotEqual(answer.returncode, 0, program)
            self.assertIn('no-such-option', answer.stderr, program)
            self.assertIn('--help', answer.stderr, program)

    def testCheckProfileWantsOneFile(self):
        for arguments in ((), ('one.yaml', 'two.yaml')):
            answer = run('check_profile', *arguments)
            self.assertEqual(answer.returncode, 2)
            self.assertIn('usage', answer.stderr)

    def testAFileWhoseNameBeginsWithADashCanBeChecked(self):
        answer = run('check_profile', '--', '-no-such-file.yaml')
        self.assertEqual(answer.returncode, 1)
        self.assertIn('-no-such-file.yaml', answer.stdout)


if __name__ == '__main__':
    unittest.main()
