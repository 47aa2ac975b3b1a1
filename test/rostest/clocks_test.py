#!/usr/bin/python3
"""What doc/hosts.md says of clocks that differ: the robot sends its poses with the stamps of its own clock, the
simulator sends shapes with those of another one."""

import sys

from organ_collision.msg import ContactArray
import rospy
import rostest

from support import oracle
from support.contract import KeepsContract
from support.node_client import NodeClient, wait_until
from support.tool_case import ToolCase
from support.tool_over_sheet import RADIUS, SHEET, at_height

DIFFERENCE = rospy.Duration(0, 50_000_000)
PERIOD = rospy.Duration(0, 10_000_000)  # of poses
SPEED = 0.2  # [m/s] of the tool, downwards


class ClocksTest(KeepsContract, ToolCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.stamp -= rospy.Duration(60)  # It rises faster than the clock, and must not get ahead of it.

    def true_axis(self, stamp):
        """The tool on its way down. It touches the sheet at `self.touch`."""
        return at_height(RADIUS - SPEED * (stamp - self.touch).to_sec())

    def come_down(self, clock):
        """The robot moves until the present stamp, and sends its poses, except for that which has
        this stamp. `clock`: what its clock shows beyond the simulator's."""
        self.touch = self.next_stamp(rospy.Duration(1)) - rospy.Duration(0, 20_000_000)
        poses = [self.stamp - PERIOD * i for i in range(30, -1, -1)]
        way = [(self.true_axis(stamp), stamp + clock) for stamp in poses]
        self.place('grasper', *[(axis, stamp) for axis, stamp in way if stamp != self.stamp])

    def send_and_get(self, node):
        node.send_mesh(self.organ, SHEET, self.stamp)
        return node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=self.stamp)

    def touched_in_truth(self):
        return oracle.static_contacts(SHEET, self.true_axis(self.stamp), RADIUS)

    def test_with_one_clock_the_touch_is_found(self):
        self.come_down(rospy.Duration())
        self.place_and_wait('grasper', self.true_axis(self.stamp), self.stamp)
        self.assert_contacts(self.send_and_get(self.node), self.touched_in_truth(), 1e-6)
        self.assertGreater(len(self.touched_in_truth()), 0)

    def test_a_clock_behind_means_no_transform(self):
        self.come_down(-DIFFERENCE)
        missing = self.send_and_get(self.node)
        self.assertEqual((missing.status, missing.contacts), (ContactArray.NO_TRANSFORM, []))
        self.assertIn('is 50 ms behind the stamp', missing.message)

    def test_a_node_that_waits_answers_later(self):
        """The answer comes when the robot's clock, too, has reached the stamp of the shape."""
        node = NodeClient('/patient')
        self.tf.wait_for(node)
        self.come_down(-DIFFERENCE)
        node.send_mesh(self.organ, SHEET, self.stamp)
        node.wait_for_shape(self.organ, self.stamp)
        self.assertEqual(node.contacts.of(self.organ, mesh_stamp=self.stamp), [])
        later = self.true_axis(self.stamp + DIFFERENCE)
        self.place('grasper', (later, self.stamp))
        result = node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=self.stamp)
        self.assert_contacts(result, oracle.static_contacts(SHEET, later, RADIUS), 1e-6)

    def test_a_clock_ahead_gives_the_contacts_of_an_old_pose(self):
        """Nothing tells of this: the answer is OK."""
        self.come_down(DIFFERENCE)
        old = self.true_axis(self.stamp - DIFFERENCE)
        self.place_and_wait('grasper', old, self.stamp)
        result = self.send_and_get(self.node)
        self.assert_ok(result)
        self.assert_contacts(result, oracle.static_contacts(SHEET, old, RADIUS), 1e-6)
        self.assertEqual(result.contacts, [])
        self.assertGreater(len(self.touched_in_truth()), 0)

    def test_stamps_far_ahead_are_refused_and_named(self):
        """One shape and one transform that are 5 s ahead of the node's clock do not hold the tool."""
        above, below = at_height(0.05), at_height(-0.02)
        self.next_stamp()
        self.place_and_wait('grasper', above, self.stamp)
        self.assert_ok(self.send_and_get(self.node))
        ahead = rospy.Time.now() + rospy.Duration(5)
        self.place('grasper', (above, ahead))
        self.node.send_mesh(self.organ, SHEET, ahead)
        refused = self.node.contacts.wait_for(
            self.organ, 'grasper', status=ContactArray.INVALID_REQUEST
        )
        self.assertIn("ahead of this node's clock", refused.message)
        self.next_stamp()
        self.place_and_wait('grasper', below, self.stamp)
        result = self.send_and_get(self.node)
        self.assertEqual(result.mode, ContactArray.SWEPT)
        self.assert_contacts(result, oracle.swept_contacts(SHEET, above, below, RADIUS), 1e-6)
        for count in ('rejected, stamp ahead', 'rejected, transform'):
            wait_until(lambda count=count: count in self.node.diagnostics, count)


if __name__ == '__main__':
    rospy.init_node('clocks_test')
    rostest.rosrun('organ_collision', 'clocks', ClocksTest, sys.argv)
