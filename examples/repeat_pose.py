#!/usr/bin/python3
"""Forwards the poses of a sender that is silent while nothing moves. Meanwhile repeats the last one with new stamps."""

import argparse
import threading

from geometry_msgs.msg import PoseStamped
import rospy

options = argparse.ArgumentParser(description=__doc__)
options.add_argument('source', help='the topic with the poses')
options.add_argument('target', help='the topic for the tool, its tip_pose_topic')
options.add_argument('--rate', type=float, default=100.0, help='[Hz] how often a pose is repeated; default: 100')
options = options.parse_args(rospy.myargv()[1:])

last = PoseStamped()
lock = threading.Lock()


def send(pose, stamp):
    if stamp > last.header.stamp:  # A pose that arrives late would go back in time.
        last.header.frame_id, last.header.stamp, last.pose = pose.header.frame_id, stamp, pose.pose
        poses.publish(last)


def forward(pose):
    with lock:
        send(pose, pose.header.stamp or rospy.Time.now())


def repeat(event):
    with lock:
        if last.header.frame_id and rospy.Time.now() - last.header.stamp >= period:
            send(last, rospy.Time.now())


rospy.init_node('repeat_pose', anonymous=True)
period = rospy.Duration(1.0 / options.rate)
poses = rospy.Publisher(options.target, PoseStamped, queue_size=10)
source = rospy.Subscriber(options.source, PoseStamped, forward)
timer = rospy.Timer(period, repeat)
rospy.spin()
