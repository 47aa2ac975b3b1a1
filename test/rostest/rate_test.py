#!/usr/bin/python3
"""The tool is evaluated at `rate`, even if no mesh arrives."""

import sys

from organ_collision.msg import ContactArray
import rospy
import rostest

from support import oracle, scenes
from support.contact_case import faces_of
from support.node_client import NodeClient, wait_until
from support.tool_case import ToolCase

STATIC, SWEPT = ContactArray.STATIC, ContactArray.SWEPT
SHEET = scenes.sheet(0.1, 4)
RADIUS = 0.005


def at_height(height):
    return ((0.013, 0.007, 0.4), (0.013, 0.007, height))


class RateTest(ToolCase):
    def impatient(self):
        node = NodeClient('/impatient')
        self.tf.wait_for(node)
        return node

    def messages_after(self, number, node=None):
        return (node or self.node).contacts.of(self.organ, 'grasper')[number:]

    def test_a_tool_moves_while_the_organ_rests(self):
        """The tick in which the tip jumps across the sheet finds the faces, and later ticks do
        not."""
        self.step(SHEET, {'grasper': at_height(0.05)})
        wait_until(lambda: len(self.messages_after(0)) > 5, 'ticks')
        self.assertEqual([faces_of(m) for m in self.messages_after(0) if m.contacts], [])
        mesh_stamp = self.stamp
        sideways = ((0.4, 0.007, -0.05), (0.013, 0.007, -0.05))
        level = ((0.4, 0.007, 0.05), (0.013, 0.007, 0.05))
        self.place('grasper', (level, self.next_stamp()))
        wait_until(
            lambda: self.node.contacts.of(self.organ, 'grasper')[-1].header.stamp >= self.stamp,
            'a tick at the level pose',
        )
        before = len(self.messages_after(0))
        self.place('grasper', (sideways, self.next_stamp()))
        wait_until(
            lambda: len(self.node.contacts.of(self.organ, 'grasper', self.stamp)) > 10,
            'ticks after the jump',
        )
        hits = [m for m in self.messages_after(before) if m.contacts]
        expected = oracle.swept_contacts(SHEET, level, sideways, RADIUS)
        self.assertEqual([faces_of(m) for m in hits], [[c.face for c in expected]])
        self.assertGreater(len(expected), 0)
        self.assertEqual((hits[0].mode, hits[0].mesh_stamp), (SWEPT, mesh_stamp))
        for message in self.messages_after(0):
            self.assert_ok(message)

    def test_a_change_of_shape_counts_once(self):
        """The tissue swings through the tool in one step. In later ticks it rests."""
        level = ((0.4, 0.007, 0.02), (0.013, 0.007, 0.02))
        low = SHEET.moved(lambda v: (v[0], v[1], v[2] - 0.05))
        self.assert_ok(self.step(low, {'grasper': level})['grasper'])
        high = SHEET.moved(lambda v: (v[0], v[1], v[2] + 0.05))
        stamp = self.next_stamp()
        self.place_and_wait('grasper', level, stamp)
        self.node.send_vertices(self.organ, high, stamp)
        wait_until(
            lambda: len(self.node.contacts.of(self.organ, mesh_stamp=stamp)) > 10,
            'ticks after the change of shape',
        )
        after = self.node.contacts.of(self.organ, mesh_stamp=stamp)
        for message in after:
            self.assert_ok(message)
        self.assertEqual([bool(m.contacts) for m in after], [True] + [False] * (len(after) - 1))

    def test_organ_motion_off_lets_organs_jump(self):
        """Only the shape at the end of the step counts, so the swing itself touches nothing."""
        node = self.impatient()
        aside = ((0.4, 0.007, 0.02), (0.013, 0.007, 0.02))
        for height in (-0.05, 0.05, 0.022):
            stamp = self.next_stamp()
            self.place('grasper', (aside, stamp))
            node.send_mesh(self.organ, SHEET.moved(lambda v: (v[0], v[1], v[2] + height)), stamp)
            result = node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=stamp, status=0)
            self.assertEqual(bool(result.contacts), height == 0.022)

    def test_a_mesh_that_stopped_coming_is_stale(self):
        """Instead of an answer about old tissue, the status says that the mesh is stale. A new
        shape ends this state."""
        node = self.impatient()
        stamp = self.next_stamp(max(rospy.Time.now() - self.stamp, rospy.Duration(0, 10**7)))
        self.place('grasper', (at_height(0.003), stamp))
        node.send_mesh(self.organ, SHEET, stamp)
        stale = node.contacts.wait_for(self.organ, 'grasper', status=ContactArray.STALE_MESH)
        self.assertEqual(stale.contacts, [])
        self.assertIn('0.3', stale.message)
        answer = node.query(self.organ, tool='grasper')
        self.assertEqual(answer.status, ContactArray.STALE_MESH)
        fresh = self.next_stamp(max(rospy.Time.now() - self.stamp, rospy.Duration(0, 10**7)))
        self.place('grasper', (at_height(0.003), fresh))
        node.send_vertices(self.organ, SHEET, fresh)
        result = node.contacts.wait_for(
            self.organ, 'grasper', mesh_stamp=fresh, status=ContactArray.OK
        )
        self.assertGreater(len(result.contacts), 0)


if __name__ == '__main__':
    rospy.init_node('rate_test')
    rostest.rosrun('organ_collision', 'rate', RateTest, sys.argv)
