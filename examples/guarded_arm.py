#!/usr/bin/python3
"""Moves the tip of a 7-joint arm along a path that leads through the liver of guarded_arm.launch. The rows of haptic_proxy
keep all links off the liver: each is one inequality of the quadratic program that gives the joint velocities.

Parameters: ~guard, false: without rows (default: true); ~lost [s] a state that is older stops the arm (default: 0.05);
robot_description, the URDF of the arm; /haptic_proxy/tools, of which the first is the arm
"""

import argparse
import time
from xml.etree import ElementTree

from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
import numpy as np
from organ_collision.msg import ProxyState
import rospy
from scipy.optimize import nnls
from sensor_msgs.msg import JointState
from std_msgs.msg import Header
import tf2_ros

RATE, GAIN = 125.0, 20.0     # [Hz] of the joints; [1/s] of the rows and joint limits, less than RATE
PULL, MAX_SPEED = 5.0, 0.1   # [1/s], [m/s] of the tip to its place on the path
REST = np.array([np.pi / 2, 1.0, 0.0, 1.4, 0.0, 0.4, 0.0])  # [rad] where the joints begin, and tend to
TEND, WEIGHT = 0.5, 1e-3     # [1/s] how fast they tend to it; [m^2] the weight of that
BASE = 0.0, -0.58, 0.05      # [m] of the arm, in the frame of the liver
TIP, LAP = np.array([0.0, 0.0, 0.08]), 8.0  # [m] in the frame of the last link; [s] for the path


def path(seconds):
    """The place on the path, in the frame of the arm's base [m]. It begins before the liver, and turns behind it."""
    angle = 2.0 * np.pi * seconds / LAP
    return np.array([-0.01 - 0.06 * np.sin(angle), 0.605 - 0.085 * np.cos(angle), -0.05 + 0.05 * np.cos(angle)])


def minimum(H, c, A, b):
    """The x with A x <= b for which x . H x / 2 - c . x is least. None if there is no such x. This is a least distance
    problem, y = L.T (x - free), solved by non-negative least squares (Lawson and Hanson 1974, chapter 23)."""
    inverse = np.linalg.inv(np.linalg.cholesky(H))
    free, rows = inverse.T @ inverse @ c, -A @ inverse.T
    E, f = np.vstack([rows.T, A @ free - b]), np.append(np.zeros(len(c)), 1.0)
    rest = E @ nnls(E, f, 1000)[0] - f
    return free - inverse.T @ rest[:-1] / rest[-1] if np.linalg.norm(rest) > 1e-6 else None


def velocities(J, tip_velocity, tend, A, b, low, high):
    """The joints' velocities, from low to high, with A x <= b; and whether there are any. If not, those that violate the
    rows least."""
    H, c = J.T @ J + WEIGHT * np.eye(7), J.T @ tip_velocity + WEIGHT * tend
    A, b = np.vstack([A, np.eye(7), -np.eye(7)]), np.concatenate([b, high, -low])
    x = minimum(H, c, A, b)
    if x is not None:
        return x, True
    slack = np.where(np.arange(len(b)) < len(b) - 14, -1.0, 0.0)  # One more unknown [m/s] loosens all rows.
    return minimum(np.diag([1e-6] * 7 + [1.0]), np.zeros(8), np.column_stack([A, slack]), b)[:7], False


def xyz(vector):
    return np.array([vector.x, vector.y, vector.z])


def rotation(x, y, z, w):
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + 2.0 * (w * cross + cross @ cross)


class Arm:
    """A chain of revolute joints, each with its link, from a URDF in which no joint is turned at rest."""

    def __init__(self, urdf, links):
        joints = {joint.find('child').get('link'): joint for joint in ElementTree.fromstring(urdf).iter('joint')}
        read = lambda tag, key: np.array([joints[link].find(tag).get(key).split() for link in links], float)
        self.names = [joints[link].get('name') for link in links]
        self.origins, self.axes = read('origin', 'xyz'), read('axis', 'xyz')
        self.low, self.high, self.fastest = (read('limit', key)[:, 0] for key in ('lower', 'upper', 'velocity'))
        self.move(REST)

    def move(self, angles):
        """Also finds places and axes of the joints, in the frame of the base, and the tip."""
        self.angles, self.places, self.turned, place, turn = angles, [], [], np.zeros(3), np.eye(3)
        for origin, axis, angle in zip(self.origins, self.axes, 0.5 * angles):
            place = place + turn @ origin
            self.places.append(place)
            self.turned.append(turn @ axis)
            turn = turn @ rotation(*np.sin(angle) * axis, np.cos(angle))
        self.tip = place + turn @ TIP

    def jacobian(self, point, link):
        J = np.zeros((3, len(self.axes)))  # of a point of a link, given in the frame of the base
        J[:, :link + 1] = np.cross(self.turned[:link + 1], point - np.array(self.places[:link + 1])).T
        return J


class Controller:
    def __init__(self):
        tool = rospy.get_param('/haptic_proxy/tools')[0]
        self.arm, self.state = Arm(rospy.get_param('robot_description'), tool['links']), ProxyState()
        self.guard, self.lost = rospy.get_param('~guard', True), rospy.get_param('~lost', 0.05)
        self.moved, self.seconds = rospy.Time(), 0.0  # the stamp of the joints after the last motion; time on the path
        self.reported, self.costs, self.nearest = rospy.Time.now(), [], np.inf
        place, self.base = Transform(Vector3(*BASE), Quaternion(w=1.0)), tf2_ros.StaticTransformBroadcaster()
        self.base.sendTransform(TransformStamped(Header(0, rospy.Time.now(), 'liver'), 'arm_base', place))
        self.joints = rospy.Publisher('joint_states', JointState, queue_size=1, tcp_nodelay=True)
        rospy.Subscriber('/haptic_proxy/%s/state' % tool['name'], ProxyState, lambda state: setattr(self, 'state', state),
                         queue_size=1, tcp_nodelay=True)

    def rows_of(self, state):
        """A and b of A x <= b. If the hand has passed a wall, the same points of it have negative distances."""
        R, R_proxy = (rotation(*xyz(pose.orientation), pose.orientation.w) for pose in (state.hand, state.proxy))
        A, b = [np.zeros((0, 7))], []
        for row in (state.hand_contacts or state.contacts) if self.guard else []:
            normal, distance = xyz(row.normal), row.distance
            point = xyz(row.point) - distance * normal
            if not state.hand_contacts:
                on_proxy, point = point, R @ R_proxy.T @ (point - xyz(state.proxy.position)) + xyz(state.hand.position)
                distance += normal @ (on_proxy - point)
            A.append([normal @ self.arm.jacobian(point, row.link)])
            b.append(normal @ xyz(row.velocity) + GAIN * (distance - row.clearance))
            self.nearest = min(self.nearest, 1e3 * distance)
        return np.concatenate(A), np.array(b)

    def tick(self, now):
        state, arm = self.state, self.arm
        age = (now - state.header.stamp).to_sec()
        if age > self.lost or state.state == ProxyState.NO_ANSWER or state.message:
            rospy.logwarn_throttle(1, 'the arm stands: the last state is %.2f s old. %s' % (age, state.message))
        elif state.header.stamp >= self.moved:  # Otherwise the state is about the joints before the last motion.
            self.moved, self.seconds = now, self.seconds + 1.0 / RATE  # One period for each state, however late it is.
            way = path(self.seconds) - arm.tip
            wanted = way * min(PULL, MAX_SPEED / max(np.linalg.norm(way), 1e-9))
            low, high = (np.clip(GAIN * (end - arm.angles), -arm.fastest, arm.fastest) for end in (arm.low, arm.high))
            J, rows, start = arm.jacobian(arm.tip, 6), self.rows_of(state), time.perf_counter()
            x, is_kept = velocities(J, wanted, TEND * (REST - arm.angles), *rows, low, high)
            self.costs.append(1e3 * (time.perf_counter() - start))
            if not is_kept:
                rospy.logwarn_throttle(1, 'rows contradict each other: the arm slows down to the least violation')
            arm.move(arm.angles + x / RATE)
        self.joints.publish(JointState(header=Header(stamp=now), name=arm.names, position=list(arm.angles)))
        if self.costs and (now - self.reported).to_sec() >= 5.0:
            rospy.loginfo('%d steps, solved in %.2f ms; nearest: %.2f mm', len(self.costs), np.mean(self.costs), self.nearest)
            self.reported, self.costs, self.nearest = now, [], np.inf


if __name__ == '__main__':
    argparse.ArgumentParser(description=__doc__).parse_args(rospy.myargv()[1:])  # --help
    rospy.init_node('guarded_arm')
    controller = Controller()
    timer = rospy.Timer(rospy.Duration(1.0 / RATE), lambda event: controller.tick(event.current_real), reset=True)
    rospy.spin()
