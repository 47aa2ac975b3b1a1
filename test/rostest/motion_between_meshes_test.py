#!/usr/bin/python3
"""The motion of a tool or an organ between two meshes, as TF knows it."""

import random
import sys

from organ_collision.msg import ContactArray
import rospy
import rostest

from support import oracle, scenes
from support.contact_case import faces_of
from support.node_client import NodeClient, wait_until
from support.tool_case import STEP, ToolCase
from support.tool_over_sheet import RADIUS, SHEET, at_height

SWEPT = ContactArray.SWEPT


class MotionBetweenMeshesTest(ToolCase):
    def test_through_the_sheet_and_back_between_two_meshes(self):
        """The tool is above the sheet at both ends of the step, so it touches only in between."""
        self.step(SHEET, {'grasper': at_height(0.05)})
        middle, end = self.stamp + STEP, self.stamp + STEP + STEP
        self.place('grasper', (at_height(-0.05), middle))
        result = self.step(
            SHEET, {'grasper': at_height(0.05)}, vertices=True, step=end - self.stamp
        )
        self.check_there_and_back(result['grasper'])

    def check_there_and_back(self, result):
        way_down = oracle.swept_contacts(SHEET, at_height(0.05), at_height(-0.05), RADIUS)
        self.assert_ok(result)
        self.assertEqual(result.mode, SWEPT)
        self.assertEqual(faces_of(result), [c.face for c in way_down])
        self.assertGreater(len(way_down), 0)
        for found, right in zip(result.contacts, way_down):
            # The tip descends in the first half of the step and ends 0.05 m above the sheet.
            self.assertAlmostEqual(found.fraction, right.fraction / 2, delta=2e-3)
            self.assertLess(found.depth, 0)
            self.assertFalse(found.behind)

    def test_through_the_sheet_and_back_within_a_millisecond(self):
        """The poses are at random times, between the node's regular samples of the motion."""
        chance = random.Random(5)
        self.step(SHEET, {'grasper': at_height(0.05)})
        for _ in range(50):
            begin = self.stamp
            start, down, up = sorted(chance.randrange(4 * 10**6, 5 * 10**6) for _ in range(3))
            self.place(
                'grasper',
                *[
                    (at_height(height), begin + rospy.Duration(0, nanoseconds))
                    for height, nanoseconds in ((0.05, start), (-0.05, down), (0.05, up))
                ]
            )
            result = self.step(SHEET, {'grasper': at_height(0.05)}, vertices=True)['grasper']
            way_down = oracle.swept_contacts(SHEET, at_height(0.05), at_height(-0.05), RADIUS)
            self.assert_ok(result)
            self.assertEqual(faces_of(result), [c.face for c in way_down])
            for found, right in zip(result.contacts, way_down):
                touch = (start + right.fraction * (down - start)) / 1e7
                self.assertAlmostEqual(found.fraction, touch, delta=1e-6)

    def test_transforms_after_their_step_are_counted(self):
        self.step(SHEET, {'grasper': at_height(0.05)})
        begin = self.stamp
        self.step(SHEET, {'grasper': at_height(0.05)}, vertices=True)
        self.place('grasper', (at_height(-0.05), begin + rospy.Duration(0, 3 * 10**6)))
        wait_until(
            lambda: int(self.node.diagnostics.get('transforms after their step', 0)) >= 2,
            lambda: 'two late transforms in /diagnostics: %s' % self.node.diagnostics,
        )

    def test_a_long_step_is_not_cut_short(self):
        """A second between two meshes has more samples than motion_samples_max. The stab in the
        middle is still found."""
        self.step(SHEET, {'grasper': at_height(0.05)})
        begin = self.stamp
        heights = [0.05 - 0.1 * max(0.0, 1 - abs(i - 50) / 10) for i in range(100)]
        self.place(
            'grasper',
            *[
                (at_height(height), begin + rospy.Duration(0, i * 10**7))
                for i, height in enumerate(heights)
            ]
        )
        result = self.step(
            SHEET, {'grasper': at_height(0.05)}, vertices=True, step=rospy.Duration(1)
        )['grasper']
        wait_until(
            lambda: any(
                k.endswith(' cut') and int(v) > 0 for k, v in self.node.diagnostics.items()
            ),
            'a count of what was cut in /diagnostics',
        )
        expected = oracle.swept_contacts(SHEET, at_height(0.05), at_height(-0.05), RADIUS)
        self.assertEqual(faces_of(result), [c.face for c in expected])
        for found, right in zip(result.contacts, expected):
            self.assertAlmostEqual(found.fraction, 0.4 + 0.1 * right.fraction, delta=0.02)

    def test_around_the_sheet_without_a_touch(self):
        """The straight line from start to end would pierce the sheet, but the tool goes around its
        edge."""
        way = [(0.013, 0.007, 0.05), (0.2, 0.007, 0.05), (0.2, 0.007, -0.05), (0.013, 0.007, -0.05)]
        axes = [((0.25, 0.007, p[2]), p) for p in way]
        self.step(SHEET, {'grasper': axes[0]})
        begin = self.stamp
        self.place('grasper', *[(axes[i], begin + rospy.Duration(0, i * 10**7)) for i in (1, 2)])
        result = self.step(
            SHEET, {'grasper': axes[3]}, vertices=True, step=rospy.Duration(0, 3 * 10**7)
        )['grasper']
        self.assert_contacts(result, [])
        self.assertGreater(len(oracle.swept_contacts(SHEET, axes[0], axes[3], RADIUS)), 0)

    def test_an_organ_whose_frame_moves(self):
        """Motion is relative to the organ: a breathing organ touches a tool that rests in the
        world."""
        stamps = [self.next_stamp(), self.next_stamp()]
        poses = [scenes.Pose((0.1, 0.0, 0.0, 1.0), (0.01, 0.02, z)) for z in (-0.05, 0.06)]
        axis = at_height(0.0)
        node = NodeClient('/patient')
        self.tf.wait_for(node)
        for stamp, pose in zip(stamps, poses):
            self.tf.send(('liver_frame', 'breathing', pose, stamp))
            self.place('grasper', (axis, stamp))
            message = node.mesh_message(self.organ, SHEET, stamp)
            message.header.frame_id = 'breathing'
            node.meshes.publish(message)
            result = node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=stamp)
        self.assertEqual(result.header.frame_id, 'breathing')
        seen = [tuple(map(pose.inverse().apply, axis)) for pose in poses]
        self.assertEqual(oracle.static_contacts(SHEET, seen[0], RADIUS), [])
        expected = oracle.swept_contacts(SHEET, *seen, RADIUS)
        self.assertGreater(len(expected), 0)
        self.assert_contacts(result, expected, 1e-6)


if __name__ == '__main__':
    rospy.init_node('motion_between_meshes_test')
    rostest.rosrun('organ_collision', 'motion_between_meshes', MotionBetweenMeshesTest, sys.argv)
