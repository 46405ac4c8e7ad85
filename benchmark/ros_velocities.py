#!/usr/bin/env python3
"""Sends velocities over ROS at random instants, and says when: `CLOCK_MONOTONIC station`, one a line.

    ros_velocities.py NODE INVERTERS CALLS
"""
import random
import sys
import time

import rospy
from std_msgs.msg import Float64

LIMIT = 20.0
"""[s] until all topics are connected."""


def main():
    node, inverters, calls = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    rospy.init_node('velocities', disable_signals=True)
    topics = [rospy.Publisher('/%s/belt_%d/command' % (node, station), Float64, queue_size=1)
              for station in range(1, inverters + 1)]
    end = time.monotonic() + LIMIT
    while any(topic.get_num_connections() == 0 for topic in topics):
        if time.monotonic() > end:
            raise SystemExit('the node does not subscribe')
        time.sleep(0.05)
    for velocity in (0.0, 10.0):
        for topic in topics:
            topic.publish(velocity)
        time.sleep(1.0)
    chance = random.Random(1)
    for call in range(calls):
        time.sleep(chance.uniform(0.1, 0.3))
        station = chance.randint(1, inverters)
        print('%.6f %d' % (time.monotonic(), station))
        topics[station - 1].publish(20.0 + 0.1 * (call % 100))


if __name__ == '__main__':
    main()
