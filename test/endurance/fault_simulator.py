#!/usr/bin/python3
"""A simulator that runs until it is stopped, and needs no help: a sheet that waves, and a tool that moves through it.

Usage: fault_simulator.py ORGAN TOOL

Publishes the mesh of ORGAN once, latched, and its vertices and TOOL's poses on TF 50 times a second. It never looks
whether anybody listens.
"""

import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'rostest'))

from organ_collision.msg import OrganMesh, OrganVertices  # noqa: E402
import rospy  # noqa: E402
from support import scenes  # noqa: E402
from support.node_client import TfSender, mesh_message, vertices_message  # noqa: E402

FRAME = 'liver_frame'


def main():
    organ, tool = rospy.myargv()[1:]
    rospy.init_node('simulator')
    sheet, tf = scenes.sheet(0.1, 8), TfSender()
    meshes = rospy.Publisher('/organ_collision/organ_mesh', OrganMesh, queue_size=1, latch=True)
    shapes = rospy.Publisher('/organ_collision/organ_vertices', OrganVertices, queue_size=1)
    meshes.publish(mesh_message(organ, sheet, rospy.Time.now()))
    tf.send_resting((FRAME, tool + '_trocar', (0.01, 0.02, 0.3)))
    rate = rospy.Rate(50.0)
    while not rospy.is_shutdown():
        now = rospy.Time.now()
        phase = 2 * math.pi * now.to_sec()
        tf.send((FRAME, tool + '_tip', (0.012, 0.017, 0.01 * math.cos(phase)), now))
        waved = sheet.moved(lambda v: (v[0], v[1], 0.002 * math.sin(phase + 50 * v[0])))
        shapes.publish(vertices_message(organ, waved, now))
        rate.sleep()


if __name__ == '__main__':
    try:
        main()
    except rospy.ROSInterruptException:
        pass
