#!/usr/bin/python3
"""Transforms that lag, clocks that differ, stand still and jump, and evaluation at a fixed rate. What doc/hosts.md says
of clocks that differ: the robot sends its poses with the stamps of its own clock, the simulator sends shapes with those
of another one."""

import sys

from organ_collision.msg import ContactArray
import rospy
import rostest

from support import oracle
from support.contact_case import KeepsContract, faces_of
from support.node_client import NodeClient, wait_until
from support.simulated_clock import SimulatedCase
from support.tool_over_sheet import RADIUS, SHEET, at_height

STATIC, SWEPT = ContactArray.STATIC, ContactArray.SWEPT
ABOVE, BELOW, INSIDE = at_height(0.05), at_height(-0.05), at_height(0.003)
DIFFERENCE = rospy.Duration(0, 50_000_000)  # of the robot's clock


class TimesTest(KeepsContract, SimulatedCase):
    start = 3000

    def move(self, axis, vertices=True):
        return self.step(SHEET, {'grasper': axis}, vertices=vertices)['grasper']

    def connected(self, name):
        node = NodeClient(name)
        self.addCleanup(node.close)
        self.tf.wait_for(node)
        return node

    def await_transform(self):
        """Makes the patient node wait for the transform of the organ's last shape. Returns its client and the stamp."""
        node = self.connected('/patient')
        self.place('grasper', (ABOVE, self.next_stamp()))
        node.send_mesh(self.organ, SHEET, self.stamp)
        self.assert_ok(node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=self.stamp))
        node.send_vertices(self.organ, SHEET, self.next_stamp())
        node.wait_for_shape(self.organ, self.stamp)
        self.assertEqual(node.contacts.of(self.organ, mesh_stamp=self.stamp), [])
        return node, self.stamp

    def test_a_transform_that_lags_is_awaited(self):
        """The shape is evaluated as soon as the transform arrives. Meanwhile, services answer."""
        node, stamp = self.await_transform()
        for _ in range(20):
            self.assertEqual(node.query(self.organ, tool='grasper').status, ContactArray.OK)
        self.place('grasper', (INSIDE, stamp))
        result = node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=stamp)
        self.assert_contacts(result, oracle.swept_contacts(SHEET, ABOVE, INSIDE, RADIUS), 1e-6)

    def test_reset_keeps_a_mesh_that_awaits_its_transform(self):
        """A waiting mesh is no history. It is still evaluated, as the tool's first step."""
        node, stamp = self.await_transform()
        node.reset()
        self.place('grasper', (INSIDE, stamp))
        result = node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=stamp)
        self.assertEqual(result.mode, STATIC)
        self.assert_contacts(result, oracle.static_contacts(SHEET, INSIDE, RADIUS))

    def test_an_organ_is_removed_while_it_awaits_a_transform(self):
        node, gone = self.await_transform()
        node.remove(self.organ)
        self.place('grasper', (INSIDE, self.next_stamp()))
        node.send_mesh(self.organ, SHEET, self.stamp)
        self.assertEqual(node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=self.stamp).mode, STATIC)
        self.assertEqual(node.contacts.of(self.organ, 'grasper', mesh_stamp=gone), [])

    def test_the_limit_counts_in_simulated_time(self):
        """60 s are over in a moment."""
        node, stamp = self.await_transform()
        self.next_stamp(rospy.Duration(61))
        result = node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=stamp)
        self.assert_no_transform(result, 'ms behind the stamp', 'waited 60 s')

    def test_a_clock_that_stands_still(self):
        """A simulator may stop its clock until it has the answer. The node waits for transforms by this clock, but not
        for ever."""
        node = self.connected('/ticking')
        self.move(ABOVE, vertices=False)
        with self.clock.lock:
            stamp = self.next_stamp()
            node.bring(self.organ, SHEET, stamp)
            rospy.rostime.wallsleep(0.2)  # longer than tf_timeout_sec, which is 20 ms
            self.place('grasper', (ABOVE, stamp))
            self.assert_ok(node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=stamp))
            self.node.send_vertices(self.organ, SHEET, self.next_stamp())
            self.assert_no_transform(self.node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=self.stamp))

    def come_down(self, clock):
        """The robot moves down until the present stamp, where it touches the sheet. `clock`: what its clock shows
        beyond the simulator's. Returns where it is at the stamp of the next shape, as its poses say."""
        self.next_stamp(rospy.Duration(1))
        way = [(at_height(0.001 + 0.001 * i), self.stamp - rospy.Duration(0, 5 * 10**6) * i + clock)
               for i in range(60, -1, -1)]
        self.place('grasper', *way[:-1])
        self.place_and_wait('grasper', *way[-1])
        return {stamp: axis for axis, stamp in way}.get(self.stamp)

    def get(self):
        self.node.send_mesh(self.organ, SHEET, self.stamp)
        return self.node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=self.stamp)

    def test_clocks_that_differ(self):
        """With one clock, the touch is found. If the robot's clock is behind, the answer says by how much. If it is
        ahead, the contacts are those of an old pose, and nothing tells of this."""
        for clock in (rospy.Duration(), DIFFERENCE):
            axis, result = self.come_down(clock), self.get()
            expected = oracle.static_contacts(SHEET, axis, RADIUS)
            self.assert_contacts(result, expected, 1e-6)
            self.assertEqual(len(expected) > 0, clock == rospy.Duration())
            self.node.remove(self.organ)
        self.come_down(-DIFFERENCE)
        self.assert_no_transform(self.get(), 'is 50 ms behind the stamp')

    def test_stamps_far_ahead_are_refused_and_named(self):
        """One shape and one transform that are 5 s ahead of the node's clock do not hold the tool."""
        self.move(ABOVE, vertices=False)
        ahead = self.clock.now + rospy.Duration(5)
        self.place('grasper', (ABOVE, ahead))
        self.node.send_mesh(self.organ, SHEET, ahead)
        refused = self.node.contacts.wait_for(self.organ, 'grasper', status=ContactArray.INVALID_REQUEST)
        self.assertIn("ahead of this node's clock", refused.message)
        result = self.move(BELOW)
        self.assertEqual(result.mode, SWEPT)
        self.assert_contacts(result, oracle.swept_contacts(SHEET, ABOVE, BELOW, RADIUS), 1e-6)
        for count in ('rejected, stamp ahead', 'rejected, transform'):
            self.node.diagnostics.wait_for_count(count)

    def check_stab(self):
        """From above the sheet to below it, without history."""
        first, second = self.move(ABOVE, vertices=False), self.move(BELOW)
        self.assertEqual((first.mode, second.mode, second.step_start), (STATIC, SWEPT, first.header.stamp))
        self.assert_contacts(second, oracle.swept_contacts(SHEET, ABOVE, BELOW, RADIUS), 1e-6)
        self.assertGreater(len(second.contacts), 0)

    def test_a_jump_back_forgets_the_history(self):
        """Also while a transform is awaited: a shape of the old time is not evaluated with a transform of the new
        time."""
        self.jump(9000)
        self.check_stab()
        self.jump(5000)
        self.check_stab()
        self.node.send_vertices(self.organ, SHEET, self.next_stamp())
        self.jump(4000)
        result = self.move(BELOW)
        self.assertEqual(result.mode, STATIC)
        self.assert_contacts(result, oracle.static_contacts(SHEET, BELOW, RADIUS))
        self.node.diagnostics.values.clear()
        wait_until(lambda: self.node.diagnostics.values, 'diagnostics after the jump')

    def test_a_jump_forward_is_a_long_step(self):
        first = self.move(ABOVE, vertices=False)
        self.jump(self.clock.now.to_sec() + 4)
        second = self.move(BELOW)
        self.assertEqual((second.mode, second.step_start), (SWEPT, first.header.stamp))
        self.assert_contacts(second, oracle.swept_contacts(SHEET, ABOVE, BELOW, RADIUS), 1e-6)

    def test_ticks(self):
        """As many as the rate says, in the simulator's time. The one in which the tip jumps across the sheet finds the
        faces, and later ones do not. A change of shape counts once, too."""
        node = self.connected('/ticking')
        level, sideways = (((0.4, 0.007, z), (0.013, 0.007, z)) for z in (0.05, -0.05))

        def ticks(condition, since):
            """Ticks until some more answers fulfil the condition. Returns all answers since this number of them."""
            while len([a for a in node.contacts.of(self.organ)[since:] if condition(a)]) < 10:
                before = len(node.contacts.of(self.organ))
                self.clock.tick()
                wait_until(lambda: len(node.contacts.of(self.organ)) > before, 'one more tick')
            answers = node.contacts.of(self.organ)[since:]
            for answer in answers:
                self.assert_ok(answer)
            return answers

        with self.clock.lock:
            self.place('grasper', (level, self.next_stamp()))
            node.bring(self.organ, SHEET, self.stamp)
            node.contacts.wait_for(self.organ, 'grasper', status=ContactArray.OK)
            first = len(node.contacts.of(self.organ))
            self.assertEqual([faces_of(a) for a in ticks(lambda a: True, first) if a.contacts], [])
            self.assertLessEqual(len(node.contacts.of(self.organ)) - first, 10 + 5)  # A few are from before.
            second, mesh_stamp = len(node.contacts.of(self.organ)), self.stamp
            self.place_and_wait('grasper', sideways, self.next_stamp())
            stamp = self.stamp
            hits = [a for a in ticks(lambda a: a.header.stamp >= stamp, second) if a.contacts]
            expected = oracle.swept_contacts(SHEET, level, sideways, RADIUS)
            self.assertEqual([faces_of(a) for a in hits], [[c.face for c in expected]])
            self.assertEqual((hits[0].mode, hits[0].mesh_stamp), (SWEPT, mesh_stamp))
            third = len(node.contacts.of(self.organ))
            self.place_and_wait('grasper', sideways, self.next_stamp())
            node.send_vertices(self.organ, SHEET.moved(lambda v: (v[0], v[1], v[2] - 0.1)), self.stamp)
            node.wait_for_shape(self.organ, self.stamp)
            stamp = self.stamp
            answers = ticks(lambda a: a.mesh_stamp == stamp, third)
            self.assertEqual(len([a for a in answers if a.contacts]), 1)

    def test_a_mesh_that_stopped_coming_is_stale(self):
        """Instead of an answer about old tissue, the status says so, until a new shape comes. The node has organ_motion
        off: the swing of the tissue through the tool itself touches nothing."""
        node = self.connected('/impatient')
        aside = ((0.4, 0.007, 0.02), (0.013, 0.007, 0.02))
        with self.clock.lock:
            for height in (-0.05, 0.05, 0.022):
                self.place('grasper', (aside, self.next_stamp()))
                node.send_mesh(self.organ, SHEET.moved(lambda v: (v[0], v[1], v[2] + height)), self.stamp)
                result = node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=self.stamp, status=0)
                self.assertEqual(bool(result.contacts), height == 0.022)
        stale = node.contacts.wait_for(self.organ, 'grasper', status=ContactArray.STALE_MESH)
        self.assertEqual(stale.contacts, [])
        self.assertIn('0.3', stale.message)
        self.assertEqual(node.query(self.organ, tool='grasper').status, ContactArray.STALE_MESH)
        with self.clock.lock:
            self.next_stamp(max(self.clock.now - self.stamp, rospy.Duration(0, 10**7)))
            self.place('grasper', (INSIDE, self.stamp))
            node.send_vertices(self.organ, SHEET, self.stamp)
            result = node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=self.stamp, status=ContactArray.OK)
            self.assertGreater(len(result.contacts), 0)


if __name__ == '__main__':
    rospy.init_node('times_test')
    rostest.rosrun('organ_collision', 'times', TimesTest, sys.argv)
