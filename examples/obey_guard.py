#!/usr/bin/python3
"""Passes on the velocity of a tool from the topic `wanted` to `velocity`, at most as fast as tool_guard allows. Without
a state of the guard for its watch time, the tool stops.

Parameters: ~tool, its name; ~max_speed [m/s] and ~watch_time [s], as those of the guard (default: 0.1 and 0.05)
"""

import argparse
import math
import time

from geometry_msgs.msg import TwistStamped, Vector3
from organ_collision.msg import GuardState
import rospy

argparse.ArgumentParser(description=__doc__).parse_args(rospy.myargv()[1:])  # --help
rospy.init_node('obey_guard')
tool, max_speed = rospy.get_param('~tool'), rospy.get_param('~max_speed', 0.1)
watch_time, last = rospy.get_param('~watch_time', 0.05), {'wanted': TwistStamped(), 'heard': -math.inf, 'scale': 0.0}


def hear(state):
    if state.tool == tool:
        last.update(heard=time.monotonic(), scale=state.speed_scale)


rospy.Subscriber('tool_guard/state', GuardState, hear, queue_size=100, tcp_nodelay=True)
rospy.Subscriber('wanted', TwistStamped, lambda twist: last.update(wanted=twist), queue_size=1, tcp_nodelay=True)
velocity = rospy.Publisher('velocity', TwistStamped, queue_size=1, tcp_nodelay=True)
while not rospy.is_shutdown():
    wanted, is_heard = last['wanted'].twist, time.monotonic() - last['heard'] < watch_time
    allowed = last['scale'] * max_speed if is_heard else 0.0
    speed = math.hypot(wanted.linear.x, wanted.linear.y, wanted.linear.z)
    factor, sent = min(1.0, allowed / speed) if speed else 0.0, TwistStamped(header=last['wanted'].header)
    for part in ('linear', 'angular'):
        x, y, z = (factor * getattr(getattr(wanted, part), axis) for axis in 'xyz')
        setattr(sent.twist, part, Vector3(x, y, z))
    velocity.publish(sent)
    time.sleep(0.005)  # Not rospy's clock, which a simulator may stop.
