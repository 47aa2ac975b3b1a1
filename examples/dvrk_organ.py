#!/usr/bin/python3
"""In place of a tissue simulator: a breathing organ of the size of a liver, and its place before the camera."""

import argparse
import math

from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
import numpy as np
from organ_collision import Organ
import rospy
from std_msgs.msg import Header
import tf2_ros

RADII = (0.09, 0.06, 0.035)  # [m]
BREATH, PERIOD = 0.03, 4.0  # [1] change of size, [s]
# The organ's frame in the camera's: its z axis points up and towards the camera.
PLACE = Transform(Vector3(0, -0.03, 0.14), Quaternion(0, math.sqrt(0.9), math.sqrt(0.1), 0))


def ellipsoid(radii, rings=40, segments=80):
    """A closed surface with outward faces: (rings + 1) * segments vertices, those of the poles at the same place."""
    polar, around = np.mgrid[0:rings + 1, 0:segments].reshape(2, -1)
    polar, around = np.pi * polar / rings, 2 * np.pi * around / segments
    ring = np.where((polar > 0) & (polar < np.pi), np.sin(polar), 0)
    vertices = radii * np.column_stack([ring * np.cos(around), ring * np.sin(around), np.cos(polar)])
    a = np.arange(rings * segments)
    b = a - a % segments + (a + 1) % segments
    lower, upper = np.column_stack([a, a + segments, b + segments]), np.column_stack([a, b + segments, b])
    return vertices, np.concatenate([lower[:-segments], upper[segments:]])  # Without the empty ones at the poles.


if __name__ == '__main__':
    argparse.ArgumentParser(description=__doc__).parse_args(rospy.myargv()[1:])  # --help
    rospy.init_node('dvrk_organ')
    place = tf2_ros.StaticTransformBroadcaster()
    place.sendTransform(TransformStamped(Header(0, rospy.Time.now(), 'ECM'), 'liver', PLACE))
    try:
        vertices, faces = ellipsoid(RADII)
        liver = Organ('liver', vertices, faces)
        rate = rospy.Rate(30)
        while not rospy.is_shutdown():
            now = rospy.Time.now()
            liver.move(vertices * (1 + BREATH * math.sin(2 * math.pi * now.to_sec() / PERIOD)), now)
            rate.sleep()
    except rospy.ROSException:  # Another node took the name of this one, which was publishing.
        pass
