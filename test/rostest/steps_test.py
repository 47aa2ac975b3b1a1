#!/usr/bin/python3
"""The `contacts` that the node publishes in simulated time: step by step, as poses of tips arrive, and at a fixed rate.
Transforms that lag, and a clock that jumps. What doc/hosts.md says of clocks that differ: the robot sends its poses with
the stamps of its own clock, the simulator sends shapes with those of another. The sequences of messages are in
test/ros/steps."""

import sys

from geometry_msgs.msg import PoseStamped
from organ_collision.msg import ContactArray
import rospy
import rostest

from support import oracle, scenes
from support.contact_case import KeepsContract, faces_of
from support.node_client import NodeClient, is_heard, pose_stamped, wait_until
from support.tool_case import SimulatedCase, ball_contacts
from support.tool_over_sheet import at_height

STATIC, SWEPT = ContactArray.STATIC, ContactArray.SWEPT
SHEET = scenes.sheet(0.1, 4).moved(lambda v: (v[0], v[1], v[2] + 0.1 * v[0]))
ABOVE = ((0.02, -0.03, 0.3), (0.011, 0.006, 0.05))
BELOW = ((0.02, -0.03, 0.3), (0.004, -0.003, -0.04))
INSIDE = ((0.02, -0.03, 0.3), (0.011, 0.006, 0.002))
GRASPER, BALL = 0.005, 0.006  # [m] radii
DIFFERENCE = rospy.Duration(0, 50_000_000)  # of the robot's clock
BASE = scenes.Pose((0.3, -0.2, 0.1, 0.9), (0.013, 0.007, 0.4))  # of the arm PSM1 in the organ's frame
ARM = 0.004  # [m] radius of PSM1


class StepsTest(KeepsContract, SimulatedCase):
    link_frames = {'ball': ('ball',)}

    def move(self, axis, vertices=True):
        """A step of the grasper alone."""
        return self.step(SHEET, {'grasper': axis}, vertices=vertices)['grasper']

    def connected(self, name):
        node = NodeClient(name)
        self.addCleanup(node.close)
        self.tf.wait_for(node)
        return node

    def assert_swept(self, result, before, after, radius=GRASPER):
        """Checks a swept step through the sheet against the oracle."""
        self.assertEqual(result.mode, SWEPT)
        expected = oracle.swept_contacts(SHEET, before, after, radius)
        self.assertGreater(len(expected), 0)
        self.assert_contacts(result, expected, 1e-6)

    def test_a_stab_through_a_sheet(self):
        """By a shaft and a ball. The first step is static, the second is swept through the sheet, and the fourth is
        clear of it. After a reset, a step is static again."""
        above, below = ({'grasper': axis, 'ball': axis[1:]} for axis in (ABOVE, BELOW))
        first, begin = self.step(SHEET, above), self.stamp
        for answer in first.values():
            self.assert_contacts(answer, [])
            self.assertEqual((answer.mode, answer.step_start, answer.header.stamp), (STATIC, begin, begin))
        second = self.step(SHEET, below, vertices=True)
        self.assert_swept(second['grasper'], ABOVE, BELOW)
        self.assert_contacts(second['ball'], ball_contacts(SHEET, ABOVE[1:], BELOW[1:], BALL), 1e-6)
        for tool, links in (('grasper', []), ('ball', ['ball'])):
            answer = second[tool]
            self.assertEqual((answer.step_start, answer.header.stamp, answer.mesh_stamp),
                             (begin, self.stamp, self.stamp))
            self.assertEqual((answer.header.frame_id, answer.organ, answer.topology, answer.tool, answer.links),
                             ('liver_frame', self.organ, 1, tool, links))
        self.assert_regions_lie_on_faces(second['grasper'], SHEET)
        self.step(SHEET, above, vertices=True)
        self.assert_contacts(self.step(SHEET, above)['grasper'], [])  # The same triangles are a shape.
        self.node.reset()
        static = self.step(SHEET, below, vertices=True)
        self.assertEqual({answer.mode for answer in static.values()}, {STATIC})
        self.assert_contacts(static['grasper'], oracle.static_contacts(SHEET, BELOW, GRASPER))

    def test_a_large_mesh_and_what_follows_at_once_come_in_order(self):
        """The mesh is prepared in another thread. Later messages about the same organ wait for it; other organs do
        not."""
        large, name = scenes.sheet(0.1, 80), self.organ
        self.organ += '_other'
        self.move(ABOVE, vertices=False)
        first, second = self.next_stamp(), self.next_stamp()
        self.place('grasper', (BELOW, first), (BELOW, second))
        self.node.send_mesh(name, large, first, 1)
        self.node.send_mesh(name, SHEET, second, 2)
        self.node.send_vertices(self.organ, SHEET, first)
        for organ, topology, stamp in ((name, 1, first), (name, 2, second), (self.organ, 1, first)):
            result = self.node.contacts.wait_for(organ, 'grasper', mesh_stamp=stamp)
            self.assert_ok(result)
            self.assertEqual(result.topology, topology)
            self.assertGreater(len(result.contacts), 0)

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
        self.assertEqual(node.query(self.organ, tool='grasper').status, ContactArray.OK)
        self.place('grasper', (INSIDE, stamp))
        self.assert_swept(node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=stamp), ABOVE, INSIDE)

    def test_the_limit_of_waiting_counts_in_simulated_time(self):
        """60 s are over in a moment."""
        node, stamp = self.await_transform()
        self.next_stamp(self.clock.now - self.stamp + rospy.Duration(61))
        result = node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=stamp)
        self.assert_no_transform(result, 'ms behind the stamp', 'waited 60 s')

    def come_down(self, clock):
        """The robot moves down until the present stamp, where it touches the sheet. `clock`: what its clock shows
        beyond the simulator's. Returns where it is at the stamp of the next shape, as its poses say."""
        self.next_stamp(rospy.Duration(1))
        way = [(at_height(0.001 + 0.001 * i), self.stamp - rospy.Duration(0, 5 * 10**6) * i + clock)
               for i in range(60, -1, -1)]
        self.place('grasper', *way[:-1])
        self.place_and_wait('grasper', *way[-1])
        return {stamp: axis for axis, stamp in way}.get(self.stamp)

    def answer_to_mesh(self):
        self.node.send_mesh(self.organ, SHEET, self.stamp)
        return self.node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=self.stamp)

    def test_clocks_that_differ(self):
        """With one clock, the touch is found. If the robot's clock is behind, the answer says by how much. If it is
        ahead, the contacts are those of an old pose, and nothing tells of this."""
        for clock in (rospy.Duration(), DIFFERENCE):
            axis, result = self.come_down(clock), self.answer_to_mesh()
            expected = oracle.static_contacts(SHEET, axis, GRASPER)
            self.assert_contacts(result, expected, 1e-6)
            self.assertEqual(len(expected) > 0, clock == rospy.Duration())
            self.node.remove(self.organ)
        self.come_down(-DIFFERENCE)
        self.assert_no_transform(self.answer_to_mesh(), 'is 50 ms behind the stamp')

    def test_a_jump_back_forgets_the_history(self):
        """Also while a transform is awaited: a shape of the old time is not evaluated with a transform of the new
        time."""
        for seconds in (9000, 5000):
            self.jump(seconds)
            first = self.move(ABOVE, vertices=False)
            self.assertEqual(first.mode, STATIC)
            self.assert_swept(self.move(BELOW), ABOVE, BELOW)
        self.node.send_vertices(self.organ, SHEET, self.next_stamp())
        self.jump(4000)
        result = self.move(BELOW)
        self.assertEqual(result.mode, STATIC)
        self.assert_contacts(result, oracle.static_contacts(SHEET, BELOW, GRASPER))
        self.node.diagnostics.values.clear()
        wait_until(lambda: self.node.diagnostics.values, 'diagnostics after the jump')

    def test_ticks(self):
        """They come in the simulator's time, and not while it stands still. Of all ticks, only the one in which the tip
        goes through the sheet finds its faces."""
        node = self.connected('/ticking')
        above, below = (((0.4, 0.007, height), (0.013, 0.007, height)) for height in (0.05, -0.05))
        with self.clock.lock:
            self.place('grasper', (above, self.next_stamp()))
            node.bring(self.organ, SHEET, self.stamp)
            node.contacts.wait_for(self.organ, 'grasper', status=ContactArray.OK)
            self.place_and_wait('grasper', below, self.next_stamp())
            before = len(node.contacts.of(self.organ))
            for _ in range(10):
                count = len(node.contacts.of(self.organ))
                self.clock.tick()
                wait_until(lambda: len(node.contacts.of(self.organ)) > count, 'one more tick')
            answers = node.contacts.of(self.organ)
            self.assertLessEqual(len(answers) - before, 10 + 5)  # A few are from before.
            (hit,) = [answer for answer in answers if answer.contacts]
            self.assertEqual(faces_of(hit), [c.face for c in oracle.swept_contacts(SHEET, above, below, GRASPER)])

    def posed(self):
        """Connects to the node whose tips come as poses. Returns its client and the publisher of the arm's poses."""
        node = self.connected('/posed')
        arm, base = (rospy.Publisher(topic, PoseStamped, queue_size=1000, latch=latch) for topic, latch in (
            ('/PSM1/local/measured_cp', False), ('/SUJ/PSM1/measured_cp', True)))
        wait_until(lambda: is_heard(arm, '/posed') and is_heard(base, '/posed'), 'the topics of PSM1')
        base.publish(pose_stamped('liver_frame', BASE.translation, rotation=BASE.rotation))
        return node, arm

    def test_poses_faster_than_the_node_are_all_swept(self):
        """A pose is answered when it comes, without a new shape. The tip jumps from side to side, each time through
        the sheet. Each step begins where the previous one ended."""
        node, arm = self.posed()
        tips = [(-0.09 + 0.18 * i / 99, 0.007, 0.05 if i % 2 else -0.05) for i in range(100)]
        for tip in tips:
            last = self.next_stamp(rospy.Duration(0, 10**6))
            arm.publish(pose_stamped('PSM1_base', BASE.inverse().apply(tip), last))
            if tip is tips[0]:
                node.send_mesh(self.organ, SHEET, last)
                first = node.contacts.wait_for(self.organ, 'PSM1', mesh_stamp=last, status=ContactArray.OK)
        node.contacts.wait_for(self.organ, 'PSM1', stamp=last)
        swept = node.contacts.of(self.organ, 'PSM1', mode=SWEPT)
        self.assertEqual({(answer.status, answer.mesh_stamp) for answer in swept}, {(0, first.mesh_stamp)})
        ends = [first.header.stamp] + [answer.header.stamp for answer in swept]
        self.assertEqual([answer.step_start for answer in swept], ends[:-1])
        axes = [(BASE.translation, tip) for tip in tips]
        touched = {c.face for before, after in zip(axes, axes[1:])
                   for c in oracle.swept_contacts(SHEET, before, after, ARM)}
        self.assertEqual({face for answer in swept for face in faces_of(answer)}, touched)



if __name__ == '__main__':
    rospy.init_node('steps_test')
    rostest.rosrun('organ_collision', 'steps', StepsTest, sys.argv)
