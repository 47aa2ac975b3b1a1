#!/usr/bin/python3
"""A simulator with numpy: sends tissue at 60 Hz and a tool's poses at 500 Hz, and prints the contacts and the force."""

import argparse
import math

from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion, Transform, TransformStamped, Vector3
import numpy as np
from organ_collision import CollisionError, contact_table, Organ
from organ_collision.msg import ContactArray, ProxyState
import rospy
from std_msgs.msg import Header
import tf2_ros

CELLS, SIDE = 20, 0.1  # of the square sheet: in each direction; [m]


def sheet():
    """The vertices, n x 3 [m], and faces, m x 3, of a flat square around the origin."""
    line = np.linspace(-SIDE / 2, SIDE / 2, CELLS + 1)
    x, y = np.meshgrid(line, line)
    corners = np.arange((CELLS + 1) ** 2).reshape(x.shape)
    a, b, c, d = (part.ravel() for part in (corners[:-1, :-1], corners[:-1, 1:], corners[1:, :-1], corners[1:, 1:]))
    return np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1), np.concatenate([np.stack([a, b, c], axis=1),
                                                                                      np.stack([b, d, c], axis=1)])


class Simulator:
    def __init__(self):
        self.vertices, faces = sheet()
        self.force = np.zeros(3)  # [N] on the tool
        self.contacts = rospy.Subscriber('/organ_collision/contacts', ContactArray, self.touch, queue_size=1)
        self.states = rospy.Subscriber('/haptic_proxy/probe/state', ProxyState, self.feel, queue_size=1, tcp_nodelay=True)
        self.trocar = tf2_ros.StaticTransformBroadcaster()
        self.trocar.sendTransform(TransformStamped(Header(frame_id='tissue'), 'probe_trocar', Transform(
            Vector3(0, 0, 0.1), Quaternion(0, 0, 0, 1))))
        self.poses = rospy.Publisher('probe/pose', PoseStamped, queue_size=10, tcp_nodelay=True)
        self.organ = Organ('tissue', self.vertices, faces)  # haptic_proxy subscribes to the same topics.

    def touch(self, answer):
        try:
            contacts = contact_table(answer)
        except CollisionError as error:
            return rospy.logwarn_throttle(1, str(error))
        if len(contacts):
            rospy.loginfo_throttle(1, '%d faces touched, at most %.1f mm deep; the force is %.2f N'
                                   % (len(contacts), 1e3 * contacts.depth.max(), np.linalg.norm(self.force)))

    def feel(self, state):
        force = state.wrench.force
        self.force = np.array([force.x, force.y, force.z])

    def move_tool(self, _):
        now = rospy.Time.now()
        height = 0.006 + 0.004 * math.cos(now.to_sec())  # [m] of the tip above the sheet; the radius is 5 mm
        self.poses.publish(PoseStamped(Header(0, now, 'tissue'), Pose(Point(0.01, 0.002, height),
                                                                      Quaternion(0, 0, 0, 1))))

    def move_tissue(self, _):
        now = rospy.Time.now()
        self.vertices[:, 2] = 0.001 * np.sin(50 * self.vertices[:, 0] + now.to_sec())
        self.organ.move(self.vertices, now)


argparse.ArgumentParser(description=__doc__).parse_args(rospy.myargv()[1:])  # --help
rospy.init_node('numpy_simulator')
simulator = Simulator()
timers = [rospy.Timer(rospy.Duration(1 / 500), simulator.move_tool),
          rospy.Timer(rospy.Duration(1 / 60), simulator.move_tissue)]
rospy.spin()
