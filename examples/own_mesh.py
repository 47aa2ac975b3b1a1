#!/usr/bin/python3
"""Sends a mesh file as an organ, dips the probe of start.launch into its highest place, and prints what is touched.
With --rest, it only sends the organ and prints, and another program moves the tool. With --ply, it only converts the file."""

import argparse
import math
import os
import sys
import time

from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from organ_collision import contact_table, MeshFileError, Organ, read_mesh, write_ply
from organ_collision.msg import ContactArray
import numpy as np
import rospkg
import rospy
from std_msgs.msg import Header
import tf2_ros

options = argparse.ArgumentParser(description=__doc__)
options.add_argument('file', nargs='?', help='the mesh: OBJ, STL, PLY, OFF, DAE, VTK, ...; without it, a kidney of 1280 faces')
options.add_argument('--scale', type=float, default=1.0, help='metres for each unit of the file: 0.001 for millimetres')
options.add_argument('--lps', action='store_true', help="the file's axes point left, posterior and superior, as in files that 3D Slicer saves")
options.add_argument('--rest', action='store_true', help='sends only the organ, which rests, and no frames of the probe')
options.add_argument('--frame', default='organ', help='the TF frame of the mesh; default: organ')
options.add_argument('--ply', metavar='NEW.ply', help='writes the mesh into this file, in metres, and ends')
options = options.parse_args(rospy.myargv()[1:])
KIDNEY = os.path.join(rospkg.RosPack().get_path('organ_collision'), 'examples', 'kidney.obj')


def frame(name, stamp, point):
    return TransformStamped(Header(0, stamp, options.frame), name, Transform(Vector3(*point), Quaternion(0, 0, 0, 1)))


def describe(vertices, faces):
    """Prints what is most often wrong with a mesh."""
    size = np.ptp(vertices[faces].reshape(-1, 3), axis=0)
    _, places = np.unique(vertices, axis=0, return_inverse=True)  # Vertices at one place count as one.
    corners = places.reshape(-1)[faces]
    edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    signs = np.where(edges[:, 0] < edges[:, 1], 1, -1)
    _, edge_of = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True)
    open_edges = np.count_nonzero(np.bincount(edge_of.reshape(-1), signs))  # Not as often there as back.
    a, b, c = (vertices[faces[:, i]] - vertices.mean(axis=0) for i in range(3))
    is_inward = np.einsum('ij,ij->', a, np.cross(b, c)) < 0  # Six times the volume.
    print('%d vertices, %d faces, %.3g x %.3g x %.3g m, %d open edges, normals point %s' % (
        len(vertices), len(faces), *size, open_edges, 'inward' if is_inward else 'outward'), flush=True)
    if size.max() > 3:
        print('warning: the mesh is %.3g m large. If the file is in millimetres, add --scale 0.001' % size.max(), flush=True)
    if is_inward:
        print('warning: the normals point inward, so inside and outside are swapped. Turn the faces round', flush=True)


last_line = None
started = None  # Since this stamp, the organ is here, and the probe is where this program has it.


def show(answer):
    global last_line
    if answer.status != ContactArray.OK:
        return rospy.logwarn_throttle(1, answer.message)
    if not started or answer.step_start < started:
        return  # The step begins where another program left the probe, perhaps far away, or on the way from there.
    contacts = contact_table(answer)
    contacts = contacts[contacts.touching]  # The probe has left the others again.
    if len(contacts) > 0:
        deepest = contacts[contacts.depth.argmax()]
        line = '%s touches %d faces, deepest in face %d: %.1f mm' % (
            answer.tool, len(contacts), deepest.face, 1e3 * deepest.depth)
        if line != last_line:
            print(line, flush=True)
        last_line = line


def main():
    global started
    vertices, faces = read_mesh(options.file or KIDNEY, options.scale, options.lps)
    describe(vertices, faces)
    if options.ply:
        return write_ply(options.ply, vertices, faces)
    rospy.init_node('own_mesh')
    rospy.Subscriber('/organ_collision/contacts', ContactArray, show)
    frames = tf2_ros.TransformBroadcaster()
    # Frames that are sent before the node listens are lost, and it would wait for those of the organ's stamp.
    while not options.rest and frames.pub_tf.get_num_connections() == 0 and not rospy.is_shutdown():
        time.sleep(0.05)
    organ = Organ('organ', vertices, faces, options.frame)
    top = vertices[vertices[:, 2].argmax()]

    def dip(_):
        global started
        now = rospy.Time.now()
        started = started or now
        tip = top + [0, 0, 0.005 + 0.004 * math.cos(now.to_sec())]  # The probe has a radius of 0.005 m.
        try:
            frames.sendTransform([frame('probe_trocar', now, top + [0, 0, 0.1]), frame('probe_tip', now, tip)])
            organ.move(vertices, now)
        except rospy.ROSException:  # The node ends, and rospy has closed a topic during a publish.
            pass

    # In a thread of its own: rospy deadlocks if Ctrl-C finds the main thread in a publish.
    if options.rest:
        started = rospy.Time.now()
    else:
        rospy.Timer(rospy.Duration(0.05), dip)
    rospy.spin()

try:
    main()
except MeshFileError as error:
    sys.exit('own_mesh.py: %s' % error)
