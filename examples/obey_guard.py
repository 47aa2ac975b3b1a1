#!/usr/bin/python3
"""Passes on the velocity of a tool from the topic `wanted` to `velocity`, at most as fast as tool_guard allows. Without
a recent state of the guard for its watch time, the tool stops. Along `retreat`, it may move in every stage.

Parameters: ~tool, its name; ~max_speed, ~retreat_speed [m/s] and ~watch_time [s], as those of the guard; ~latest [s]
after which a state is too old: latency - watch_time of the guard (default: 0.1); ~reach [m] from the point that has the
linear velocity to the farthest one of the tool (default: 0.4)
"""

import argparse
import math
import time

from geometry_msgs.msg import TwistStamped, Vector3
from numpy import array
from numpy.linalg import norm
from organ_collision.msg import GuardState
import rospy

argparse.ArgumentParser(description=__doc__).parse_args(rospy.myargv()[1:])  # --help
rospy.init_node('obey_guard')
tool, latest, reach = rospy.get_param('~tool'), rospy.get_param('~latest', 0.1), rospy.get_param('~reach', 0.4)
max_speed, retreat_speed = rospy.get_param('~max_speed', 0.1), rospy.get_param('~retreat_speed', 0.005)
watch_time = rospy.get_param('~watch_time', 0.05)
last = {'wanted': TwistStamped(), 'heard': -math.inf, 'state': GuardState()}


def hear(state):
    if state.tool == tool and (rospy.Time.now() - state.header.stamp).to_sec() < latest:
        last.update(heard=time.monotonic(), state=state)


def xyz(vector):
    return array([vector.x, vector.y, vector.z])


rospy.Subscriber('tool_guard/state', GuardState, hear, queue_size=100, tcp_nodelay=True)
rospy.Subscriber('wanted', TwistStamped, lambda twist: last.update(wanted=twist), queue_size=1, tcp_nodelay=True)
velocity = rospy.Publisher('velocity', TwistStamped, queue_size=1, tcp_nodelay=True)
while not rospy.is_shutdown():
    wanted, state, sent = last['wanted'], last['state'], TwistStamped(header=last['wanted'].header)
    linear, angular = xyz(wanted.twist.linear), xyz(wanted.twist.angular)
    is_heard, retreat = time.monotonic() - last['heard'] < watch_time, xyz(state.retreat)
    allowed, speed = state.speed_scale * max_speed if is_heard else 0.0, norm(linear) + reach * norm(angular)
    factor, back = min(1.0, allowed / speed) if speed else 0.0, min(retreat @ linear, retreat_speed)
    if is_heard and back > allowed and state.header.frame_id == wanted.header.frame_id:
        sent.twist.linear = Vector3(*(back * retreat))
    else:
        sent.twist.linear, sent.twist.angular = Vector3(*(factor * linear)), Vector3(*(factor * angular))
    velocity.publish(sent)
    time.sleep(0.005)  # Not rospy's clock, which a simulator may stop.
