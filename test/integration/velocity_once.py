#!/usr/bin/env python3
"""Sends a velocity to a topic from a node of its own: velocity_once.py TOPIC VALUE [latched] [stay | stream]

Once, and ends; with `stay` it stays connected, with `stream` it sends 20 times a second until it is ended.
"""
import sys
import time

import rospy
from std_msgs.msg import Float64

rospy.init_node('velocity_once', anonymous=True, disable_signals=True)
publisher = rospy.Publisher(sys.argv[1], Float64, queue_size=1, latch='latched' in sys.argv[3:])
deadline = time.monotonic() + 20.0
while publisher.get_num_connections() == 0:
    if time.monotonic() > deadline:
        sys.exit('nobody listens to ' + sys.argv[1])
    time.sleep(0.01)
publisher.publish(Float64(float(sys.argv[2])))
while 'stream' in sys.argv[3:] and not rospy.is_shutdown():
    publisher.publish(Float64(float(sys.argv[2])))
    time.sleep(0.05)
if 'stay' in sys.argv[3:]:
    rospy.spin()
# The message leaves in a thread of rospy's own; ending at once would lose it.
time.sleep(0.5)
rospy.signal_shutdown('sent')
