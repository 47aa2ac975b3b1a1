#!/usr/bin/python3
"""A minimal simulator: a probe comes down onto a sheet of tissue, presses, slides and leaves."""

import argparse
import math

from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from organ_collision.msg import ContactArray, OrganMesh, OrganVertices
import rospy
from std_msgs.msg import Header
import tf2_ros

CELLS = 8    # in each direction
SIDE = 0.1   # [m]
PLACES = [(SIDE * (i / CELLS - 0.5), SIDE * (j / CELLS - 0.5))
          for j in range(CELLS + 1) for i in range(CELLS + 1)]
CORNERS = [i + j * (CELLS + 1) for j in range(CELLS) for i in range(CELLS)]
TRIANGLES = [vertex for a in CORNERS
             for vertex in (a, a + 1, a + CELLS + 2, a, a + CELLS + 2, a + CELLS + 1)]


def header(stamp):
    return Header(stamp=stamp, frame_id='tissue')


def shape(stamp):
    """A wave of 1 mm runs through the sheet."""
    return [coordinate for x, y in PLACES
            for coordinate in (x, y, 0.001 * math.sin(50 * x + stamp.to_sec()))]


def frame(name, stamp, x, z):
    return TransformStamped(header(stamp), name,
                            Transform(Vector3(x, 0.01, z), Quaternion(0, 0, 0, 1)))


def react(touched):
    if touched.status != ContactArray.OK:
        rospy.logwarn_throttle(1, touched.message)
    elif touched.contacts:
        deepest = max(touched.contacts, key=lambda contact: contact.depth)
        rospy.loginfo_throttle(0.5, '%s: %.1f mm deep in face %d; faces touched: %d' % (
            touched.tool, 1e3 * deepest.depth, deepest.face, len(touched.contacts)))


argparse.ArgumentParser(description=__doc__).parse_args(rospy.myargv()[1:])  # --help
rospy.init_node('simulator')
rate = rospy.Rate(100)
try:
    frames = tf2_ros.TransformBroadcaster()
    mesh = rospy.Publisher('/organ_collision/organ_mesh', OrganMesh, latch=True, queue_size=1)
    vertices = rospy.Publisher('/organ_collision/organ_vertices', OrganVertices, queue_size=1)
    contacts = rospy.Subscriber('/organ_collision/contacts', ContactArray, react)
    mesh.publish(OrganMesh(header(rospy.Time.now()), 'tissue', 0, shape(rospy.Time()), TRIANGLES))
    while not rospy.is_shutdown():
        now = rospy.Time.now()
        x, z = 0.02 * math.sin(now.to_sec()), 0.008 + 0.005 * math.cos(now.to_sec())
        frames.sendTransform([frame('probe_trocar', now, 0, 0.1), frame('probe_tip', now, x, z)])
        vertices.publish(OrganVertices(header(now), 'tissue', 0, shape(now)))
        rate.sleep()
except rospy.ROSException:  # Another node took the name of this one, which was publishing.
    pass
