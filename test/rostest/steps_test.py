#!/usr/bin/python3
"""The `contacts` that the node publishes in simulated time. The sequences of messages are in test/node/steps."""

import sys

from geometry_msgs.msg import PoseStamped
from organ_collision.msg import ContactArray, OrganMesh, ProxyState
import rospy
import rostest

from support import scenes
from support.contact_case import KeepsContract
from support.node_client import FAR_AWAY, Log, NodeClient, is_heard, mesh_message, pose_stamped, wait_until
from support.tool_case import SimulatedCase
from support.tool_over_sheet import RADIUS, SHEET, at_height, depth_at

STATIC, SWEPT = ContactArray.STATIC, ContactArray.SWEPT
HIGH, LOW = 0.05, -0.04  # [m] heights of tips over the sheet and below it
BALL = 0.006  # [m] radius


class StepsTest(KeepsContract, SimulatedCase):
    link_frames = {'ball': ('ball',)}

    def move(self, height, vertices=True):
        """A step of the grasper alone."""
        return self.step(SHEET, {'grasper': at_height(height)}, vertices=vertices)['grasper']

    def connected(self, name):
        node = NodeClient(name)
        self.addCleanup(node.close)
        self.tf.wait_for(node)
        return node

    def assert_step(self, answer, mode, depth):
        self.assertEqual(answer.mode, mode)
        self.assert_depth(answer, depth)

    def test_a_stab_through_a_sheet(self):
        """By a shaft and a ball. The first step is static, the second is swept through the sheet, and the fourth is
        clear of it. After a reset, a step is static again."""
        above, below = ({'grasper': at_height(height), 'ball': at_height(height)[1:]} for height in (HIGH, LOW))
        first, begin = self.step(SHEET, above), self.stamp
        for answer in first.values():
            self.assert_step(answer, STATIC, None)
            self.assertEqual((answer.step_start, answer.header.stamp), (begin, begin))
        second = self.step(SHEET, below, vertices=True)
        for tool, links, radius in (('grasper', [], RADIUS), ('ball', ['ball'], BALL)):
            answer = second[tool]
            self.assert_step(answer, SWEPT, depth_at(LOW, radius))
            self.assertEqual((answer.step_start, answer.header.stamp, answer.mesh_stamp),
                             (begin, self.stamp, self.stamp))
            self.assertEqual((answer.header.frame_id, answer.organ, answer.topology, answer.tool, answer.links),
                             ('liver_frame', self.organ, 1, tool, links))
        self.assertEqual(len(second['grasper'].regions), len(second['grasper'].contacts))
        self.step(SHEET, above, vertices=True)
        self.assert_depth(self.step(SHEET, above)['grasper'], None)  # The same triangles are a shape.
        self.node.reset()
        static = self.step(SHEET, below, vertices=True)
        self.assert_step(static['ball'], STATIC, None)
        self.assert_step(static['grasper'], STATIC, depth_at(LOW))

    def test_a_large_mesh_and_what_follows_at_once_come_in_order(self):
        """The mesh is prepared in another thread. Later messages about the same organ wait for it; other organs do
        not."""
        large, name = scenes.sheet(0.1, 80), self.organ
        self.organ += '_other'
        self.move(HIGH, vertices=False)
        first, second = self.next_stamp(), self.next_stamp()
        self.place('grasper', (at_height(LOW), first), (at_height(LOW), second))
        self.node.send_mesh(name, large, first, 1)
        self.node.send_mesh(name, SHEET, second, 2)
        self.node.send_vertices(self.organ, SHEET, first)
        for organ, topology, stamp in ((name, 1, first), (name, 2, second), (self.organ, 1, first)):
            result = self.node.contacts.wait_for(organ, 'grasper', mesh_stamp=stamp)
            self.assert_depth(result, depth_at(LOW))
            self.assertEqual(result.topology, topology)

    def test_no_clock_and_no_stamp_ends_a_node(self):
        """The clock goes to the ends of what ROS can count, and messages have stamps from there. Afterwards, all nodes
        answer as before."""
        nodes = self.node, self.connected('/ticking'), self.connected('/posed')
        arm = rospy.Publisher('/PSM1/local/measured_cp', PoseStamped, queue_size=1000)
        meshes = rospy.Publisher('/haptic_proxy/organ_mesh', OrganMesh, queue_size=100)
        states = Log('/haptic_proxy/grasper/state', ProxyState)
        wait_until(lambda: is_heard(arm, '/posed') and is_heard(meshes, '/haptic_proxy'), 'connections')

        def have_time():
            self.clock.publisher.publish(now)
            return all(node.query('nobody', FAR_AWAY).header.stamp == now for node in nodes)

        ends = (0, 1, 2**31 - 1, 2**31, 2**32 - 300, 2**32 - 1)
        with self.clock.lock:
            for seconds in ends + (10,) + ends[::-1] + (2**31 + 7, 10, 2**32 - 20, 10):
                now = rospy.Time(seconds)
                wait_until(have_time, 'the nodes at %d s' % seconds)
                for stamp in map(rospy.Time, sorted({seconds, *ends})):
                    self.place('grasper', (at_height(HIGH), stamp))
                    arm.publish(pose_stamped('PSM1_base', (0, 0, 0.1), stamp))
                    meshes.publish(mesh_message(self.organ, SHEET, stamp))
                    for node in nodes:
                        node.send_mesh(self.organ, SHEET, stamp)
                        node.send_vertices(self.organ, SHEET, stamp)
                wait_until(have_time, 'the nodes after messages at %d s' % seconds)
        self.jump(6000)
        begin = self.stamp
        self.move(HIGH, vertices=False)
        self.assert_step(self.move(LOW), SWEPT, depth_at(LOW))
        nodes[1].bring(self.organ, SHEET, self.stamp)
        nodes[1].contacts.wait_for(self.organ, 'grasper', mesh_stamp=self.stamp, status=ContactArray.OK)
        meshes.publish(mesh_message(self.organ, SHEET, self.stamp))
        wait_until(lambda: states.last() and begin <= states.last().header.stamp <= self.clock.now,
                   'a state of the proxy')


if __name__ == '__main__':
    rospy.init_node('steps_test')
    rostest.rosrun('organ_collision', 'steps', StepsTest, sys.argv)
