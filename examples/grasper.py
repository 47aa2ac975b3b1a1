#!/usr/bin/python3
"""Moves the grasper of grasper.launch: again and again, it grasps a fold of tissue, lifts it, and lets it go. What the
node's topic `grasps` says is held: the vertices of these faces stay between the jaws, and the rest of the tissue
follows them."""

import argparse
import collections

from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
import grasper_kinematics as grasper
import numpy as np
from organ_collision import Organ
from organ_collision.msg import Grasp
from PyKDL import Frame, Rotation, Vector
import rospy
from sensor_msgs.msg import JointState
from std_msgs.msg import Header
import tf2_ros

# Lengths in metres, angles in radians. The fold is along y, and the grasper comes from above: its jaws open along x.
TROCAR = Frame(Rotation.RotX(np.pi), Vector(0, 0, 0.13))
ABOVE, DOWN = 0.075, 0.095     # the insertion of the shaft
OPEN, SQUEEZE = 0.6, 0.02      # the angle of each jaw; how much further the jaws close when they hold something
RATE, CLOSING = 100.0, 0.2     # [Hz], [rad/s]
WIDTH, ACROSS, ALONG = 0.06, 50, 20  # of the sheet along the fold; its cells across and along the fold
# The profile across the fold: the lengths of its sections, and the slopes of the sheet where they meet.
SECTIONS = 0.018, 0.006, 0.008, 0.0075, 0.008, 0.006, 0.018
SLOPES = 0.0, 0.0, 0.5 * np.pi, 0.5 * np.pi, -0.5 * np.pi, -0.5 * np.pi, 0.0, 0.0


def fold():
    """The vertices, n x 3, and faces, m x 3, of a sheet with a fold."""
    ends = np.cumsum([0.0, *SECTIONS])
    way = np.linspace(0.0, ends[-1], 40 * ACROSS + 1)
    slope = np.interp(0.5 * (way[1:] + way[:-1]), ends, SLOPES)
    x, z = (np.concatenate([[0.0], np.cumsum(part(slope))])[::40] * way[1] for part in (np.cos, np.sin))
    y = np.linspace(-0.5 * WIDTH, 0.5 * WIDTH, ALONG + 1)
    corners = np.arange((ACROSS + 1) * (ALONG + 1)).reshape(ACROSS + 1, ALONG + 1)
    a, b, c, d = (part.ravel() for part in (corners[:-1, :-1], corners[1:, :-1], corners[1:, 1:], corners[:-1, 1:]))
    vertices = np.stack([np.repeat(x - 0.5 * x[-1], len(y)), np.tile(y, len(x)), np.repeat(z, len(y))], axis=1)
    return vertices, np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


class Tissue:
    """A sheet whose border rests. Each vertex that is not held moves as much as its neighbours on average."""

    def __init__(self):
        self.rest, self.faces = fold()
        self.vertices = self.rest.copy()
        count = len(self.rest)
        joined = np.zeros((count, count))
        for a, b in ((0, 1), (1, 2), (2, 0)):
            joined[self.faces[:, a], self.faces[:, b]] = joined[self.faces[:, b], self.faces[:, a]] = 1.0
        self.stiffness = np.diag(joined.sum(axis=1)) - joined
        row, column = np.divmod(np.arange(count), ALONG + 1)
        self.border = np.flatnonzero((row % ACROSS == 0) | (column % ALONG == 0))
        self.release()

    def hold(self, faces, wrist):
        """The vertices of these faces follow the wrist from now on, whose pose is given."""
        self.held = np.setdiff1d(self.faces[list(faces)], self.border)
        self.grip = apply(wrist.Inverse(), self.vertices[self.held])
        self.free = np.setdiff1d(np.arange(len(self.rest)), np.concatenate([self.border, self.held]))
        self.follow = np.linalg.solve(self.stiffness[np.ix_(self.free, self.free)],
                                      -self.stiffness[np.ix_(self.free, self.held)])

    def release(self):
        self.held = None

    def move(self, wrist):
        if self.held is None:
            self.vertices += 0.1 * (self.rest - self.vertices)
            return
        self.vertices[self.held] = apply(wrist, self.grip)
        self.vertices[self.free] = self.rest[self.free] + self.follow @ (self.vertices - self.rest)[self.held]


def apply(pose, points):
    rotation = np.array([[pose.M[i, k] for k in range(3)] for i in range(3)])
    return points @ rotation.T + np.array([*pose.p])


def moved(joints, seconds, **target):
    """The joints on a smooth way to their targets."""
    count = int(seconds * RATE)
    for i in range(1, count + 1):
        part = 0.5 - 0.5 * np.cos(np.pi * i / count)
        yield {name: value + part * (target.get(name, value) - value) for name, value in joints.items()}


def motion(is_grasped):
    """The joints, one tick after another."""
    joints = dict.fromkeys(grasper.JOINTS, 0.0)
    joints.update(grasper_insertion=ABOVE, grasper_jaw=OPEN)
    while True:
        for joints in moved(joints, 1.0, grasper_insertion=DOWN):
            yield joints
        while not is_grasped() and joints['grasper_jaw'] > 0.0:
            joints = dict(joints, grasper_jaw=max(0.0, joints['grasper_jaw'] - CLOSING / RATE))
            yield joints
        closed = joints['grasper_jaw'] - SQUEEZE
        for target in (dict(grasper_jaw=closed), dict(grasper_insertion=DOWN - 0.012), dict(grasper_yaw=0.06),
                       dict(grasper_yaw=0.0, grasper_insertion=DOWN), dict(grasper_jaw=OPEN), dict(grasper_insertion=ABOVE)):
            for joints in moved(joints, 1.0, **target):
                yield joints


class Demo:
    def __init__(self):
        self.tissue, self.events, self.is_held = Tissue(), collections.deque(), False
        trocar = Transform(Vector3(*TROCAR.p), Quaternion(*TROCAR.M.GetQuaternion()))
        self.broadcaster = tf2_ros.StaticTransformBroadcaster()
        self.broadcaster.sendTransform(TransformStamped(Header(0, rospy.Time.now(), 'fold'), 'grasper_trocar', trocar))
        self.joints = rospy.Publisher('joint_states', JointState, queue_size=10)
        self.organ = Organ('fold', self.tissue.rest, self.tissue.faces)
        self.subscriber = rospy.Subscriber('/organ_collision/grasps', Grasp, self.events.append)

    def run(self):
        rate = rospy.Rate(RATE)
        for joints in motion(lambda: self.is_held):
            wrist = grasper.link_poses(TROCAR, joints.values())[1]
            while self.events:
                self.obey(self.events.popleft(), wrist)
            self.tissue.move(wrist)
            now = rospy.Time.now()
            # robot_state_publisher knows from the URDF that the right jaw mimics the left one.
            self.joints.publish(JointState(header=Header(stamp=now), name=list(joints), position=list(joints.values())))
            self.organ.move(self.tissue.vertices, now)
            rate.sleep()

    def obey(self, event, wrist):
        self.is_held = event.event == Grasp.GRASPED
        if self.is_held:
            self.tissue.hold(event.faces_first + event.faces_second, wrist)
            rospy.loginfo('the jaws hold %.1f mm of tissue', 1e3 * event.thickness)
        else:
            self.tissue.release()
            rospy.loginfo('let go after %.1f s %s', event.duration_sec, event.reason)


argparse.ArgumentParser(description=__doc__).parse_args(rospy.myargv()[1:])  # --help
# If Ctrl-C arrives during a publish, rospy's own signal handler can deadlock. An exception cannot.
rospy.init_node('grasper', disable_signals=True)
try:
    Demo().run()
except (KeyboardInterrupt, rospy.ROSException):  # The second one comes if another node took the name.
    rospy.signal_shutdown('interrupted')
