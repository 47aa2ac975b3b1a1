#!/usr/bin/python3
"""Transforms that come late, never or in between, and meshes that come late."""

import random
import sys

from organ_collision.msg import ContactArray
import rospy
import rostest

from contact_case import faces_of
from node_client import NodeClient, wait_until
import oracle
import scenes
from tool_case import STEP, ToolCase

STATIC, SWEPT = ContactArray.STATIC, ContactArray.SWEPT
SHEET = scenes.sheet(0.1, 4)
TROCAR = (0.013, 0.007, 0.4)
RADIUS = 0.005


def at_height(height):
    """The tool straight above (0.013, 0.007), its tip at this height."""
    return (TROCAR, (TROCAR[0], TROCAR[1], height))


class TransformsTest(ToolCase):
    def test_late_mesh_finds_the_tool_at_its_last_pose(self):
        """A mesh stamped before the last evaluation: the tool is held, the tissue moves."""
        early = self.next_stamp()
        self.step(SHEET, {'grasper': at_height(0.05)})
        last = self.stamp
        self.place('grasper', (at_height(-0.1), self.next_stamp()))
        raised = SHEET.moved(lambda v: (v[0], v[1], v[2] + 0.052))
        self.node.send_vertices(self.organ, raised, early)
        result = self.node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=early)
        axis = at_height(0.05)
        expected = oracle.contacts(raised, SHEET, (axis, axis), RADIUS)
        self.assertGreater(len(expected), 0)
        self.assert_contacts(result, expected, 1e-6)
        # The next mesh in time sweeps on from there.
        self.assertLess(last, self.stamp)
        result = self.step(raised, {'grasper': at_height(0.02)}, vertices=True)['grasper']
        self.assertEqual(result.mode, SWEPT)
        self.assertIn(faces_of(result)[0], [c.face for c in expected])

    def test_a_gap_in_tf_is_published_and_then_swept_across(self):
        self.step(SHEET, {'grasper': at_height(0.05)})
        begin = self.stamp
        gap = self.next_stamp()
        self.node.send_vertices(self.organ, SHEET, gap)
        missing = self.node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=gap)
        self.assertEqual(missing.status, ContactArray.NO_TRANSFORM)
        self.assertEqual(missing.contacts, [])
        self.assertIn('grasper_t', missing.message)
        result = self.step(SHEET, {'grasper': at_height(-0.05)}, vertices=True)['grasper']
        self.assertEqual((result.mode, result.step_start), (SWEPT, begin))
        self.assert_contacts(
            result, oracle.swept_contacts(SHEET, at_height(0.05), at_height(-0.05), RADIUS), 1e-6
        )
        self.assertGreater(len(result.contacts), 0)

    def test_tissue_that_moved_during_the_gap_is_swept_as_well(self):
        """The shape of the last evaluation that succeeded is where the step begins."""
        low = SHEET.moved(lambda v: (v[0], v[1], v[2] - 0.08))
        self.step(SHEET, {'grasper': at_height(0.05)})
        gap = self.next_stamp()
        self.node.send_vertices(self.organ, low, gap)
        missing = self.node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=gap)
        self.assertEqual(missing.status, ContactArray.NO_TRANSFORM)
        high = SHEET.moved(lambda v: (v[0], v[1], v[2] + 0.08))
        result = self.step(high, {'grasper': at_height(0.05)}, vertices=True)['grasper']
        axis = at_height(0.05)
        expected = oracle.contacts(high, SHEET, (axis, axis), RADIUS)
        self.assertGreater(len(expected), 0)
        self.assert_contacts(result, expected, 1e-6)

    def patient(self):
        """A node that waits for transforms longer than any test."""
        node = NodeClient('/patient')
        self.tf.wait_for(node)
        return node

    def await_transform(self):
        """Such a node whose organ's last shape awaits its transform, and the shape's stamp."""
        node = self.patient()
        first, second = self.next_stamp(), self.next_stamp()
        self.place('grasper', (at_height(0.05), first))
        node.send_mesh(self.organ, SHEET, first)
        self.assert_ok(node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=first))
        node.send_vertices(self.organ, SHEET, second)
        node.wait_for_shape(self.organ, second)
        return node, second

    def test_a_transform_that_lags_is_awaited(self):
        """The shape comes before the transform of its stamp, and is evaluated when that is there:
        neither without it, nor only after the time limit."""
        node, stamp = self.await_transform()
        self.assertEqual(node.contacts.of(self.organ, mesh_stamp=stamp), [])
        self.place('grasper', (at_height(0.003), stamp))
        result = node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=stamp)
        self.assert_contacts(
            result, oracle.swept_contacts(SHEET, at_height(0.05), at_height(0.003), RADIUS), 1e-6
        )

    def test_services_answer_while_a_transform_is_awaited(self):
        node, stamp = self.await_transform()
        for _ in range(20):
            self.assertEqual(node.query(self.organ, tool='grasper').status, ContactArray.OK)
        self.assertEqual(node.contacts.of(self.organ, mesh_stamp=stamp), [])
        self.place('grasper', (at_height(0.05), stamp))
        self.assert_ok(node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=stamp))

    def test_through_the_sheet_and_back_between_two_meshes(self):
        """Only the poses in between touch: above at both ends of the step."""
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
            # The way down is the first half of the step; the tip ends 0.05 m above the sheet.
            self.assertAlmostEqual(found.fraction, right.fraction / 2, delta=2e-3)
            self.assertLess(found.depth, 0)
            self.assertFalse(found.behind)

    def test_through_the_sheet_and_back_within_a_millisecond(self):
        """At any times: between those at which the way is sampled, if TF says nothing."""
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
        """A second between two meshes holds more samples than motion_samples_max: the stab in its
        midst is found all the same."""
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
        """The straight way from start to end would pierce; the way taken goes around the edge."""
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
        """Everything is seen from the organ: a resting tool is touched by an organ that breathes."""
        stamps = [self.next_stamp(), self.next_stamp()]
        poses = [scenes.Pose((0.1, 0.0, 0.0, 1.0), (0.01, 0.02, z)) for z in (-0.05, 0.06)]
        axis = at_height(0.0)
        node = self.patient()
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

    def test_a_pose_that_is_not_finite_is_like_a_gap(self):
        self.step(SHEET, {'grasper': at_height(0.05)})
        for bad in (float('inf'), float('nan')):
            stamp = self.next_stamp()
            self.place('grasper', (((bad, 0.0, 0.4), (0.013, bad, 0.05)), stamp))
            self.node.send_vertices(self.organ, SHEET, stamp)
            result = self.node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=stamp)
            self.assertNotEqual(result.status, ContactArray.OK)
            self.assertNotEqual(result.message, '')
        result = self.step(SHEET, {'grasper': at_height(-0.05)}, vertices=True)['grasper']
        expected = oracle.swept_contacts(SHEET, at_height(0.05), at_height(-0.05), RADIUS)
        self.assert_ok(result)
        self.assertEqual(faces_of(result), [c.face for c in expected])

    def test_reset_keeps_a_mesh_that_awaits_its_transform(self):
        """It is no history: it is still evaluated, as the first of its tool."""
        node, stamp = self.await_transform()
        node.reset()
        self.place('grasper', (at_height(0.003), stamp))
        result = node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=stamp)
        self.assertEqual(result.mode, STATIC)
        expected = oracle.static_contacts(SHEET, at_height(0.003), RADIUS)
        self.assert_contacts(result, expected)

    def test_an_organ_is_removed_while_it_awaits_a_transform(self):
        node, gone = self.await_transform()
        node.remove(self.organ)
        back = self.next_stamp()
        self.place('grasper', (at_height(0.003), back))
        node.send_mesh(self.organ, SHEET, back)
        result = node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=back)
        self.assertEqual(result.mode, STATIC)
        self.assertEqual(node.contacts.of(self.organ, 'grasper', mesh_stamp=gone), [])

    def test_frames_that_are_not_connected(self):
        """The organ's frame hangs on no tree: no answer, which is not an empty one."""
        message = self.node.mesh_message(self.organ, SHEET, self.next_stamp())
        message.header.frame_id = 'adrift'
        self.node.meshes.publish(message)
        result = self.node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=self.stamp)
        self.assertEqual((result.status, result.contacts), (ContactArray.NO_TRANSFORM, []))
        self.assertIn('adrift', result.message)


if __name__ == '__main__':
    rospy.init_node('transforms_test')
    rostest.rosrun('organ_collision', 'transforms', TransformsTest, sys.argv)
