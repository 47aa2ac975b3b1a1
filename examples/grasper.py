#!/usr/bin/python3
"""Moves the grasper of grasper.launch: it dips into the liver, and its jaws open and close."""

import argparse
import math

from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
import rospy
from sensor_msgs.msg import JointState
from std_msgs.msg import Header
import tf2_ros

# The z axis of the trocar points at the right lobe of the liver.
TROCAR = Transform(Vector3(-0.042, -0.075, 0.130), Quaternion(math.sin(-1.25), 0, 0, math.cos(-1.25)))

# For each joint: centre and amplitude [rad, or m for the insertion], and period [s]. The right jaw
# is missing: robot_state_publisher knows from the URDF that it mimics the left one.
MOTION = {
    'grasper_yaw': (0.0, 0.12, 11.0),
    'grasper_pitch': (0.0, 0.10, 7.0),
    'grasper_insertion': (0.087, 0.015, 3.0),
    'grasper_roll': (0.0, 0.8, 13.0),
    'grasper_wrist': (0.0, 0.4, 5.0),
    'grasper_jaw': (0.3, 0.3, 2.0),
}

argparse.ArgumentParser(description=__doc__).parse_args(rospy.myargv()[1:])  # --help
# If Ctrl-C arrives during a publish, rospy's own signal handler can deadlock. An exception cannot.
rospy.init_node('grasper', disable_signals=True)
trocar = tf2_ros.StaticTransformBroadcaster()
trocar.sendTransform(TransformStamped(Header(0, rospy.Time.now(), 'liver'), 'grasper_trocar', TROCAR))
joints = rospy.Publisher('joint_states', JointState, queue_size=10)
rate = rospy.Rate(200)
start = rospy.Time.now()
try:
    while not rospy.is_shutdown():
        now = rospy.Time.now()
        turns = 2 * math.pi * (now - start).to_sec()
        positions = [centre + amplitude * math.sin(turns / period)
                     for centre, amplitude, period in MOTION.values()]
        joints.publish(JointState(header=Header(stamp=now), name=list(MOTION), position=positions))
        rate.sleep()
except (KeyboardInterrupt, rospy.ROSException):  # The second one comes if another node took the name.
    rospy.signal_shutdown('interrupted')
