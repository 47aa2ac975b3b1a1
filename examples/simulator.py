#!/usr/bin/python3
"""A minimal simulator: a sheet of tissue moves up and down, and a probe moves through it."""

import argparse
import math

from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from organ_collision.msg import ContactArray, OrganMesh, OrganVertices
import rospy
from std_msgs.msg import Header
import tf2_ros

TRIANGLES = [0, 1, 2, 0, 2, 3]


def header(stamp):
    return Header(stamp=stamp, frame_id='tissue')


def shape(stamp):
    z = 0.01 * math.sin(stamp.to_sec())
    return [-0.05, -0.05, z, 0.05, -0.05, z, 0.05, 0.05, z, -0.05, 0.05, z]


def frame(name, stamp, x, z):
    return TransformStamped(header(stamp), name,
                            Transform(Vector3(x, 0.01, z), Quaternion(0, 0, 0, 1)))


def react(touched):
    if touched.status != ContactArray.OK:
        rospy.logwarn('%s', touched.message)
    for contact in touched.contacts:
        rospy.loginfo('%s: face %d, %.1f mm deep', touched.tool, contact.face, 1e3 * contact.depth)


argparse.ArgumentParser(description=__doc__).parse_args(rospy.myargv()[1:])  # --help
rospy.init_node('simulator')
rate = rospy.Rate(100)
frames = tf2_ros.TransformBroadcaster()
mesh = rospy.Publisher('/organ_collision/organ_mesh', OrganMesh, latch=True, queue_size=1)
vertices = rospy.Publisher('/organ_collision/organ_vertices', OrganVertices, queue_size=1)
contacts = rospy.Subscriber('/organ_collision/contacts', ContactArray, react)
mesh.publish(OrganMesh(header(rospy.Time.now()), 'tissue', 0, shape(rospy.Time()), TRIANGLES))
while not rospy.is_shutdown():
    now = rospy.Time.now()
    frames.sendTransform([frame('probe_trocar', now, 0, 0.1),
                          frame('probe_tip', now, 0.1 * math.sin(5 * now.to_sec()), -0.05)])
    vertices.publish(OrganVertices(header(now), 'tissue', 0, shape(now)))
    rate.sleep()
