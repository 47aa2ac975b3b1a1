#!/usr/bin/python3
"""crtk_hand.py before a device that moves an arm as CRTK says: it takes wrenches on body/servo_cf about the tip in its
axes, and on spatial/servo_cf about the base in the base's axes. Both must do the same work on every motion."""

import signal
import sys
import time

from geometry_msgs.msg import PoseStamped, Quaternion, Transform, TransformStamped, Vector3, WrenchStamped
import numpy as np
import rospy
import rostest
from std_msgs.msg import Header
from tf2_ros import StaticTransformBroadcaster

from support.node_client import Log, is_heard, wait_until
from support.processes import NodeStarter

PLACE, TURN = np.array([0.3, -0.2, 0.1]), np.array([0.36, 0.48, 0.64, 0.48])  # the tip in the base [m], quaternion
CAMERA, CAMERA_TURN = (0.5, 0.1, -0.4), (0.0, 0.6, 0.0, 0.8)  # the base in the camera
TISSUE_TURN = (0.48, 0.0, 0.6, 0.64)  # the tissue's axes in the camera


def matrix(quaternion):
    x, y, z, w = np.asarray(quaternion) / np.linalg.norm(quaternion)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + 2 * w * cross + 2 * cross @ cross


def values(vector):
    return np.array([vector.x, vector.y, vector.z])


def wrench(force, torque, frame='tool_tip'):
    message = WrenchStamped()
    message.header.frame_id, message.header.stamp = frame, rospy.Time.now()
    for part, numbers in ((message.wrench.force, force), (message.wrench.torque, torque)):
        part.x, part.y, part.z = numbers
    return message


class CrtkTest(NodeStarter):
    def setUp(self):
        self.logs = {name: Log('/arm/%s/servo_cf' % name, WrenchStamped) for name in ('body', 'spatial', 'camera')}
        self.arm = rospy.Publisher('/arm/measured_cp', PoseStamped, queue_size=10)
        self.tool = rospy.Publisher('/tool/wrench', WrenchStamped, queue_size=1)
        for node in ('/body', '/spatial', '/camera'):
            wait_until(lambda: is_heard(self.arm, node) and is_heard(self.tool, node), node)
        self.camera = StaticTransformBroadcaster()
        base = TransformStamped(Header(0, rospy.Time.now(), 'camera'), 'arm_base',
                                Transform(Vector3(*CAMERA), Quaternion(*CAMERA_TURN)))
        tissue = TransformStamped(base.header, 'tissue', Transform(Vector3(7, 8, 9), Quaternion(*TISSUE_TURN)))
        self.camera.sendTransform([base, tissue])

    def move(self, place, stamp=None, rotation=3 * TURN):
        message = PoseStamped()
        message.header.frame_id, message.header.stamp = 'arm_base', rospy.Time.now() if stamp is None else stamp
        message.pose.position.x, message.pose.position.y, message.pose.position.z = place
        message.pose.orientation = Quaternion(*rotation)
        self.arm.publish(message)

    def feel(self, force, torque):
        """The wrench that each hand gets: frame, force and torque."""
        felt = {}
        for name, log in self.logs.items():
            half = 0.5 * np.asarray(force)
            size = min(np.linalg.norm(half), 2.0)
            is_it = lambda m: abs(np.linalg.norm(values(m.wrench.force)) - size) < 1e-9
            message = wait_until(lambda: self.tool.publish(wrench(force, torque)) or rospy.sleep(0.02) or log.last(is_it),
                                 lambda: '%s: %s' % (name, log.messages[-3:]))
            felt[name] = message.header.frame_id, values(message.wrench.force), values(message.wrench.torque)
        return felt

    def test_valid_poses_reach_the_tool(self):
        poses = Log('/tool/pose', PoseStamped).wait_for_publisher()
        last = wait_until(lambda: self.move((9, 9, 9), rospy.Time()) or self.move(PLACE) or
                          poses.last(lambda m: m.pose.position.x == PLACE[0]), 'the pose')
        self.move((9, 9, 9), rospy.Time())
        self.move((5, 5, 5))
        wait_until(lambda: poses.last(lambda m: m.pose.position.x == 5), 'the next pose')
        self.assertEqual(last.header.frame_id, 'arm_base')
        sent = last.pose.orientation
        np.testing.assert_allclose((sent.x, sent.y, sent.z, sent.w), TURN / np.linalg.norm(TURN), atol=1e-9)
        self.assertFalse(poses.select(lambda m: m.pose.position.x == 9))

    def test_wrenches_in_each_convention(self):
        R, R_camera = matrix(TURN), matrix(CAMERA_TURN)
        self.move(PLACE)
        for force, torque in (((0.3, -0.5, 1.2), (0.02, 0.01, -0.03)), ((3.0, 0.0, 4.0), (0.3, 0.4, 0.0))):
            f, t = 0.5 * np.array(force), 0.5 * np.array(torque)
            f = f * min(1.0, 2.0 / np.linalg.norm(f))
            felt = self.feel(force, torque)
            expected = {'body': ('tool_tip', f, t),
                        'spatial': ('arm_base', R @ f, R @ t + np.cross(PLACE, R @ f)),
                        'camera': ('camera', R_camera @ R @ f, R_camera @ R @ t)}
            for name, (frame, right_force, right_torque) in expected.items():
                self.assertEqual(felt[name][0], frame)
                np.testing.assert_allclose(felt[name][1], right_force, atol=1e-9, err_msg=name)
                np.testing.assert_allclose(felt[name][2], right_torque, atol=1e-9, err_msg=name)
            # The same work on any motion of the arm: a twist about the base, and the same one about the tip.
            for turning, moving in np.random.default_rng(3).normal(size=(20, 2, 3)):
                at_tip = R.T @ (moving + np.cross(turning, PLACE)), R.T @ turning
                self.assertAlmostEqual(felt['spatial'][1] @ moving + felt['spatial'][2] @ turning,
                                       felt['body'][1] @ at_tip[0] + felt['body'][2] @ at_tip[1])

    def test_what_is_sent_is_finite_and_within_the_limits(self):
        """Whatever poses and wrenches come: turned in any way, far away, with any quaternion, or not finite."""
        random, odd = np.random.default_rng(4), (np.nan, np.inf, -np.inf, 0.0, 1e200)
        for _ in range(300):
            numbers = [random.normal(size=size) * 10.0 ** random.uniform(-4, 4) for size in (3, 4, 3, 3)]
            if random.random() < 0.3:
                wrong = numbers[random.integers(4)]
                wrong[random.integers(len(wrong))] = random.choice(odd)
            place, rotation, force, torque = numbers
            self.move(place, rotation=rotation)
            self.tool.publish(wrench(force, torque))
            time.sleep(0.003)
        self.move(PLACE)
        self.feel((0.0, 1.0, 0.0), (0.0, 0.0, 0.0))
        for name, log in self.logs.items():
            sent = np.array([(*values(m.wrench.force), *values(m.wrench.torque)) for m in log.messages])
            self.assertGreater(len(sent), 50, name)
            self.assertTrue(np.isfinite(sent).all(), name)
            self.assertLessEqual(np.linalg.norm(sent[:, :3], axis=1).max(), 2.0 + 1e-9, name)
            self.assertLessEqual(np.linalg.norm(sent[:, 3:], axis=1).max(), 1.0 + 1e-9, name)

    def test_nothing_follows_the_zero_at_the_end(self):
        """However it is ended, between which wrenches ever."""
        rates, signals = (100, 250, 500, 1000), (signal.SIGINT, signal.SIGTERM)
        ends = [(name, end, Log('/ends/%d' % name, WrenchStamped)) for name, end in enumerate(signals * 8)]
        for rate in rates:
            group = [ends.pop() for _ in range(len(signals) * 8 // len(rates))]
            nodes = [self.start('/ending_%d' % name, {'rate': rate}, 'crtk_hand.py',
                                arguments=('wrench:=/tool/wrench', 'servo_cf:=/ends/%d' % name)) for name, *_ in group]
            feel = lambda: self.tool.publish(wrench((0.0, 0.0, 2.0), (0.0, 0.0, 0.0))) or time.sleep(1.0 / rate)
            wait_until(lambda: feel() or all(log.messages for *_, log in group), 'forces')
            for node, (_, end, _) in zip(nodes, group):
                for _ in range(20):
                    feel()
                node.send_signal(end)
            wait_until(lambda: feel() or all(node.poll() is not None for node in nodes), 'the ends')
            for node, (_, end, log) in zip(nodes, group):
                self.assertEqual(node.returncode, 0)
                wait_until(lambda: log.subscriber.get_num_connections() == 0, 'the last message')
                last = [m.wrench.force.z for m in log.messages[-5:]]
                np.testing.assert_allclose(last, [1.6, 1.2, 0.8, 0.4, 0.0], atol=1e-9, err_msg='%s, %d Hz' % (end, rate))

    def test_without_wrenches_it_lets_go(self):
        """In steps, within 10 ms in its own time; and never with a wrench that is not finite."""
        self.move(PLACE)
        self.feel((0.0, 0.0, 2.0), (0.0, 0.0, 0.0))
        start = time.monotonic()
        while time.monotonic() - start < 0.3:
            self.tool.publish(wrench((np.nan, 0, 0), (0, 0, 0)))
            time.sleep(0.01)
        for log in self.logs.values():
            wait_until(lambda: not values(log.last().wrench.force).any(), lambda: log.last())
            end = log.messages[-5:]
            sizes = [np.linalg.norm(values(m.wrench.force)) for m in end]
            np.testing.assert_allclose(sizes, [0.8, 0.6, 0.4, 0.2, 0.0], atol=1e-9)
            self.assertTrue(np.isfinite([values(m.wrench.force) for m in log.messages]).all())

    def test_parameters_that_are_refused(self):
        for parameters, words in (({'max_force': -1}, ('max_force', '-1')), ({'torque_about': 'base'}, ('tip or axes',)),
                                  ({'axes': ''}, ('axes',)), ({'timeout': 0}, ('timeout', '0'))):
            rospy.delete_param('/wrong') if rospy.has_param('/wrong') else None
            self.assert_refused(self.start('/wrong', parameters, 'crtk_hand.py'), words)


if __name__ == '__main__':
    rospy.init_node('crtk_test')
    rostest.rosrun('organ_collision', 'crtk', CrtkTest, sys.argv)
