#!/usr/bin/python3
"""A simulator that publishes one organ's mesh, latched, and lives until it is stopped.

Usage: organ_simulator.py CELLS STAMP: a sheet of CELLS x CELLS squares, topology 0, stamped STAMP [s]
"""

import sys

from organ_collision.msg import OrganMesh
import rospy

import scenes

cells, stamp = (int(argument) for argument in rospy.myargv()[1:])
rospy.init_node('organ_simulator')
mesh = scenes.sheet(0.1, cells)
message = OrganMesh(
    organ='tissue', vertices=mesh.flat_vertices(), triangles=mesh.flat_faces(), topology=0
)
message.header.frame_id, message.header.stamp = 'liver_frame', rospy.Time(stamp)
publisher = rospy.Publisher('/organ_collision/organ_mesh', OrganMesh, queue_size=1, latch=True)
publisher.publish(message)
rospy.spin()
