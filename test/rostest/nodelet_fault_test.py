#!/usr/bin/python3
"""A nodelet that breaks down says so, sends its last answers, and ends. Its manager and the other
nodelets go on, and it can be loaded again."""

import math
import subprocess
import sys
import time
import unittest

from geometry_msgs.msg import PoseStamped, WrenchStamped
from organ_collision.msg import ContactArray, OrganMesh, ProxyState
from rosgraph_msgs.msg import Log as LogMessage
import rospy
import rostest

from support import scenes
from support.node_client import (Log, NodeClient, TfSender, is_heard, mesh_message, pose_stamped,
                                 wait_until)

MANAGER, PROXY = '/manager', '/haptic_proxy'
NODELET = ['rosrun', 'nodelet', 'nodelet']
# The needle touches all faces of this mesh, and their contacts fit into a mebibyte.
SMALL = scenes.sheet(0.02, 4)
# These do not fit. The hook touches no face.
LARGE = scenes.sheet(0.02, 70)


class NodeletFaultTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.log = Log('/rosout', LogMessage)
        cls.tf = TfSender()
        cls.tf.send_resting(('liver_frame', 'proxy_trocar', (0.0, 0.0, 0.3)),
                            ('liver_frame', 'needle_trocar', (0.0, 0.0, 0.3)),
                            ('liver_frame', 'needle_tip', (0.0, 0.0, 0.05)),
                            ('liver_frame', 'hook_trocar', (1.0, 0.0, 0.3)),
                            ('liver_frame', 'hook_tip', (1.0, 0.0, 0.05)))

    def assert_log_says_why(self, nodelet):
        """The manager's log."""
        start = 'nodelet %s broke down, and answers nothing more: std::bad_alloc' % nodelet

        def says_why(said):
            return said.name == MANAGER and said.msg.startswith(start)

        wait_until(lambda: self.log.select(says_why), start)

    @staticmethod
    def wait_for_end(log):
        """Nobody publishes the topic any more."""
        wait_until(lambda: log.subscriber.get_num_connections() == 0, 'the end of the nodelet')

    def assert_answers(self, client, topology):
        """Sends shapes until the needle answers, and checks that it touches all faces."""

        def answers():
            client.send_mesh('liver', SMALL, stamp, topology)
            return client.contacts.of('liver', 'needle', status=ContactArray.OK, mesh_stamp=stamp)

        stamp = rospy.Time.now()
        answer = wait_until(answers, 'contacts of the shape of %s' % stamp)[0]
        self.assertEqual([c.face for c in answer.contacts], list(range(len(SMALL.faces))))

    def test_collision_node(self):
        left = NodeClient('/left/organ_collision', process=MANAGER)
        right = NodeClient('/right/organ_collision', process=MANAGER)
        self.tf.wait_for(left)
        for client in (left, right):
            self.assert_answers(client, 1)
        left.send_mesh('liver', LARGE, rospy.Time.now(), 2)
        for tool in ('needle', 'hook'):
            failure = left.contacts.wait_for('liver', tool, status=ContactArray.PICKER_FAILED)
            self.assertIn('bad_alloc', failure.message)
            self.assertEqual((failure.contacts, failure.header.frame_id), ([], 'liver_frame'))
        left.diagnostics.wait_for_summary('queries', 'bad_alloc')
        self.assert_log_says_why('/left/organ_collision')
        self.wait_for_end(left.contacts)
        self.assertEqual(left.contacts.messages[-1].status, ContactArray.PICKER_FAILED)
        self.assert_answers(right, 1)
        self.assertEqual(right.contacts.of('liver', status=ContactArray.PICKER_FAILED), [])

        left.close()
        subprocess.run(NODELET + ['unload', '/left/organ_collision', MANAGER], check=True)
        load = ['load', 'organ_collision/CollisionNodelet', MANAGER]
        loader = subprocess.Popen(NODELET + load + ['__ns:=/left', '__name:=organ_collision'])
        self.addCleanup(loader.wait)
        self.addCleanup(loader.terminate)
        self.assert_answers(NodeClient('/left/organ_collision', process=MANAGER), 3)

    def test_haptic_proxy(self):
        meshes = rospy.Publisher(PROXY + '/organ_mesh', OrganMesh, queue_size=10)
        poses = rospy.Publisher('/hand/pose', PoseStamped, queue_size=1000)
        wrenches = Log(PROXY + '/hand/wrench', WrenchStamped)
        states = Log(PROXY + '/hand/state', ProxyState)
        topics = meshes, poses, self.tf.resting
        wait_until(lambda: all(is_heard(topic, MANAGER) for topic in topics), 'connections')

        def hold(z):
            poses.publish(pose_stamped('liver_frame', (0.0, 0.0, z), rospy.Time.now()))
            time.sleep(0.002)

        def force():
            last = wrenches.last()
            if last is None:
                return 0.0
            return math.hypot(last.wrench.force.x, last.wrench.force.y, last.wrench.force.z)

        def holds_with_force():
            hold(0.09)
            return force() > 0.1

        def ends():
            hold(0.09)
            return states.last(lambda state: 'the node broke down' in state.message)

        meshes.publish(mesh_message('liver', SMALL, rospy.Time.now(), 1))
        for step in range(100):
            hold(0.15 - step * 0.0005)
        wait_until(holds_with_force, 'a force')
        meshes.publish(mesh_message('liver', LARGE, rospy.Time.now(), 2))
        self.assertIn('bad_alloc', wait_until(ends, 'the last states').message)
        self.assert_log_says_why(PROXY)
        self.wait_for_end(wrenches)
        self.assertEqual(force(), 0.0)
        last = states.last()
        self.assertEqual((last.state, last.fading), (ProxyState.NO_ANSWER, False))
        self.assertEqual(last.contacts, [])


if __name__ == '__main__':
    rospy.init_node('nodelet_fault_test')
    rostest.rosrun('organ_collision', 'nodelet_fault', NodeletFaultTest, sys.argv)
