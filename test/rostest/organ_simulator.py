#!/usr/bin/python3
"""A simulator that publishes one organ's mesh, latched, and runs until it is stopped.

Usage: organ_simulator.py CELLS STAMP. The mesh is a sheet of CELLS x CELLS squares with topology 0 and the stamp STAMP
[s].
"""

from organ_collision.msg import OrganMesh
import rospy

from support import scenes

cells, stamp = (int(argument) for argument in rospy.myargv()[1:])
rospy.init_node('organ_simulator')
mesh = scenes.sheet(0.1, cells)
message = OrganMesh(organ='tissue', vertices=mesh.flat_vertices(), triangles=mesh.flat_faces(), topology=0)
message.header.frame_id, message.header.stamp = 'liver_frame', rospy.Time(stamp)
publisher = rospy.Publisher('/organ_collision/organ_mesh', OrganMesh, queue_size=1, latch=True)
publisher.publish(message)
rospy.spin()
