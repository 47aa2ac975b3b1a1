#!/usr/bin/python3
"""Other triangles with the organ's present topology number. From a new connection they are a new
organ; from a known one they are an error."""

import os
import subprocess
import sys

from organ_collision.msg import ContactArray
import rospy
import rostest

from support import scenes
from support.contact_case import ContactCase
from support.contract import KeepsContract
from support.node_client import NodeClient, TfSender

STATIC, SWEPT = ContactArray.STATIC, ContactArray.SWEPT
SIMULATOR = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'organ_simulator.py')
TIP = (0.013, 0.007, 0.0)


class RestartTest(KeepsContract, ContactCase):
    @classmethod
    def setUpClass(cls):
        cls.node = NodeClient()
        cls.tf = TfSender()
        cls.tf.wait_for(cls.node)
        cls.tf.send_resting(
            ('liver_frame', 'grasper_trocar', scenes.Pose((0, 0, 0, 1), (0.013, 0.007, 0.3))),
            ('liver_frame', 'grasper_tip', scenes.Pose((0, 0, 0, 1), TIP)),
        )
        cls.seconds = 0

    @classmethod
    def next_second(cls):
        cls.seconds += 1
        return cls.seconds

    def simulator(self, cells):
        """Starts a simulator, always with the same name. Returns it and the node's answer."""
        stamp = self.next_second()
        process = subprocess.Popen(
            [SIMULATOR, str(cells), str(stamp), '__name:=simulator'],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process, self.node.contacts.wait_for('tissue', 'grasper', stamp=rospy.Time(stamp))

    def stop(self, process):
        process.terminate()
        process.wait()

    def send(self, organ, cells):
        """Sends over this test's own permanent connection. Returns the node's answer."""
        stamp = rospy.Time(self.next_second())
        self.node.send_mesh(organ, scenes.sheet(0.1, cells), stamp)
        return self.node.contacts.wait_for(organ, 'grasper', stamp=stamp)

    def assert_step(self, answer, mode):
        self.assert_ok(answer)
        self.assertEqual(answer.mode, mode)
        self.assertGreater(len(answer.contacts), 0)

    def test_a_restarted_simulator_brings_a_new_organ(self):
        simulator, answer = self.simulator(3)
        self.assert_step(answer, STATIC)
        self.stop(simulator)
        simulator, answer = self.simulator(5)
        self.assert_step(answer, STATIC)
        self.node.wait_for_shape('tissue', rospy.Time(self.seconds), topology=0)
        self.stop(simulator)
        # A reconnecting simulator sends its latched mesh again. It is a new shape, and its step
        # begins at the last one.
        simulator, answer = self.simulator(5)
        self.assert_step(answer, SWEPT)
        self.stop(simulator)
        self.node.remove('tissue')

    def test_one_simulator_must_raise_the_number_or_reset(self):
        self.assert_step(self.send('sheet', 3), STATIC)
        self.assert_step(self.send('sheet', 3), SWEPT)
        refused = self.send('sheet', 5)
        self.assertEqual(refused.status, ContactArray.INVALID_REQUEST)
        for word in ("'sheet'", 'topology', 'reset'):
            self.assertIn(word, refused.message)
        self.assert_step(self.send('sheet', 3), SWEPT)
        self.node.reset()
        self.assert_step(self.send('sheet', 5), STATIC)
        self.assertEqual(self.send('sheet', 3).status, ContactArray.INVALID_REQUEST)
        self.assert_step(self.send('sheet', 5), SWEPT)


if __name__ == '__main__':
    rospy.init_node('restart_test')
    rostest.rosrun('organ_collision', 'restart', RestartTest, sys.argv)
