#!/usr/bin/env python3
"""The launch files and the example of a conveyor line, as a user starts them."""
import unittest

import rospy
import rostest
from harness import Inverter, Stream, init
from inverter_bus.msg import InverterStatus

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
            belt.wait(lambda s: not s.running, 'stopped by the dead man')

    def testParametersOfTheFileReachTheDriver(self):
        self.assertEqual(rospy.get_param('/conveyor/baud_rate'), 19200)
        self.assertTrue(rospy.get_param('/conveyor/port').startswith('/tmp/inverter_bus_test'))


if __name__ == '__main__':
    init('launch_files_test')
    rostest.rosrun('inverter_bus', 'launch_files', LaunchFiles)
    rospy.signal_shutdown('done')
