#!/usr/bin/python3
"""Meshes that arrive late, and transforms that arrive late or never."""

import sys

from organ_collision.msg import ContactArray
import rospy
import rostest

from support import oracle
from support.contact_case import faces_of
from support.node_client import NodeClient
from support.tool_case import ToolCase
from support.tool_over_sheet import RADIUS, SHEET, at_height

STATIC, SWEPT = ContactArray.STATIC, ContactArray.SWEPT


class TransformsTest(ToolCase):
    def test_late_mesh_finds_the_tool_at_its_last_pose(self):
        """The mesh is stamped before the last evaluation, so the tool rests while the tissue
        moves."""
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
        # The next mesh, with a later stamp, is swept from there.
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
        """The step begins with the shape of the last successful evaluation."""
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
        """A client of the node that waits for transforms longer than any test lasts."""
        node = NodeClient('/patient')
        self.tf.wait_for(node)
        return node

    def await_transform(self):
        """Makes that node wait for the transform of the organ's last shape. Returns its client and
        the shape's stamp."""
        node = self.patient()
        first, second = self.next_stamp(), self.next_stamp()
        self.place('grasper', (at_height(0.05), first))
        node.send_mesh(self.organ, SHEET, first)
        self.assert_ok(node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=first))
        node.send_vertices(self.organ, SHEET, second)
        node.wait_for_shape(self.organ, second)
        return node, second

    def test_a_transform_that_lags_is_awaited(self):
        """The shape arrives before the transform with its stamp. It is evaluated as soon as the
        transform arrives, neither without it nor after the time limit."""
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
        self.assertEqual((result.status, result.path_incomplete), (ContactArray.OK, True))
        self.assertIn('is not finite', result.message)
        self.assertEqual(faces_of(result), [c.face for c in expected])

    def test_reset_keeps_a_mesh_that_awaits_its_transform(self):
        """A waiting mesh is no history. It is still evaluated, as the tool's first step."""
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
        """TF does not know the organ's frame. The status says so, instead of an empty answer."""
        message = self.node.mesh_message(self.organ, SHEET, self.next_stamp())
        message.header.frame_id = 'adrift'
        self.node.meshes.publish(message)
        result = self.node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=self.stamp)
        self.assertEqual((result.status, result.contacts), (ContactArray.NO_TRANSFORM, []))
        self.assertIn('adrift', result.message)


if __name__ == '__main__':
    rospy.init_node('transforms_test')
    rostest.rosrun('organ_collision', 'transforms', TransformsTest, sys.argv)
