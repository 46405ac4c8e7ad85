#!/usr/bin/env python3
"""The launch files and the example of a conveyor line, as a user starts them."""
import os
import shutil
import subprocess
import tempfile
import unittest

import rospy
import rostest
from harness import Inverter, Process, Stream, init, wait_for
from inverter_bus.msg import InverterStatus

# What roslaunch and the simulator must read alike; a '$' is no substitution.
ONE_MEANING = '''
port: %(link)s            # costs $5 (net), a$b
trace_directory: %(directory)s
interval: 5e-3
defaults: &all {drive: $(find inverter_bus)/config/drives/omron_mx2.yaml, command_timeout: 5.0e-1}
scan_list:
  - &belt {name: a, node: 0x01, max_velocity: rad(2*pi), hz_per_unit: 1_0}
  - {<<: *belt, name: b, node: 2}
simulation: {a: {model: omron_mx2}, b: {model: omron_mx2}}
'''
BELTS = ['belt_infeed', 'belt_1', 'belt_2', 'belt_3', 'belt_outfeed']


class LaunchFiles(unittest.TestCase):
    def testTheConveyorLineRuns(self):
        belts = [Inverter('/conveyor', name) for name in BELTS]
        for belt in belts:
            belt.wait_online()
            belt.wait(lambda s: not s.locked, 'unlocked by silence')
        streams = [Stream(belt, 0.3) for belt in belts]
        for belt in belts:
            status = belt.wait(lambda s: s.running and abs(s.velocity - 0.3) < 0.005, 'at 0.3 m/s')
            self.assertEqual(status.direction, InverterStatus.DIRECTION_FORWARD)
        for stream in streams:
            stream.end()
        for belt in belts:
            belt.wait(lambda s: not s.running, 'stopped by the command watchdog')

    def testParametersOfTheFileReachTheDriver(self):
        self.assertEqual(rospy.get_param('/conveyor/baud_rate'), 19200)
        self.assertTrue(rospy.get_param('/conveyor/port').startswith('/tmp/inverter_bus_test'))

    def roslaunch(self, *arguments):
        return subprocess.run(['roslaunch', '--nodes', 'inverter_bus'] + list(arguments), stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, universal_newlines=True, timeout=120)

    def testAMisspeltConfigStartsNoOtherLine(self):
        for launch in ('bus.launch', 'multi_bus.launch'):
            answer = self.roslaunch(launch, 'confg:=/tmp/mine.yaml')
            self.assertNotEqual(answer.returncode, 0, answer.stdout)
            self.assertIn('config', answer.stdout)

    def testOneFileMeansTheSameToRoslaunchAndToTheSimulator(self):
        directory = tempfile.mkdtemp(prefix='inverter_bus_test_')
        self.addCleanup(shutil.rmtree, directory, ignore_errors=True)
        link, path = os.path.join(directory, 'line'), os.path.join(directory, 'line.yaml')
        with open(path, 'w') as stream:
            stream.write(ONE_MEANING % {'link': link, 'directory': directory})
        line = Process(directory, 'simulated_bus', '--scan-list', path, '--link', link)
        self.addCleanup(line.end)
        wait_for(lambda: os.path.exists(link) or not line.running(), 'the simulated line')
        self.assertTrue(line.running(), line.log())
        inverters = [Inverter('/one_meaning', name) for name in ('a', 'b')]
        launch = subprocess.Popen(['roslaunch', 'inverter_bus', 'bus.launch', 'config:=' + path, 'name:=one_meaning'],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(launch.wait)
        self.addCleanup(launch.terminate)
        for inverter in inverters:
            inverter.wait_online()
            self.assertIn('omron_mx2', inverter.status.drive)
        self.assertEqual([inverter.status.node for inverter in inverters], [1, 2])
        self.assertAlmostEqual(rospy.get_param('/one_meaning/scan_list')[1]['max_velocity'], 6.2831853, places=6)


if __name__ == '__main__':
    init('launch_files_test')
    rostest.rosrun('inverter_bus', 'launch_files', LaunchFiles)
    rospy.signal_shutdown('done')
