#!/usr/bin/python3
"""The tissue of the example holds the stylus back, and the driver passes the force on. When haptic_proxy ends, the driver
switches the force off."""

import re
import sys
import threading
import unittest

from organ_collision.msg import ProxyState
import rosnode
import rospy
from rosgraph_msgs.msg import Log
import rostest

LIMIT = 30.0  # [s]


class HapticsTest(unittest.TestCase):

    def setUp(self):
        self.held, self.pushed, self.off = threading.Event(), threading.Event(), threading.Event()
        self.subscribers = [rospy.Subscriber('/rosout', Log, self.on_log),
                            rospy.Subscriber('/haptic_proxy/stylus/state', ProxyState, self.on_state)]

    def on_log(self, line):
        if line.name != '/stylus_driver':
            return
        force = re.match(r'the force on the hand is \(\S+, \S+, (\S+)\) N', line.msg)
        if force and float(force.group(1)) > 0.3:
            self.pushed.set()
        if line.msg.endswith('the force is off'):
            self.off.set()

    def on_state(self, state):
        """The proxy is above the hand, which the tissue pushes up."""
        if state.state == ProxyState.TOUCHING and state.wrench.force.z > 0.3:
            self.assertEqual(state.header.frame_id, 'stylus_base')
            if state.proxy.position.z > state.hand.position.z + 0.001:
                self.held.set()

    def test_the_hand_feels_the_tissue_and_nothing_once_the_node_is_gone(self):
        self.assertTrue(self.held.wait(LIMIT), 'waited without success for a proxy that tissue holds back')
        self.assertTrue(self.pushed.wait(LIMIT), 'waited without success for a driver that pushes the hand up')
        self.off.clear()
        rosnode.kill_nodes(['/haptic_proxy'])
        self.assertTrue(self.off.wait(LIMIT), 'waited without success for the force to be switched off')


if __name__ == '__main__':
    rospy.init_node('haptics_test')
    rostest.rosrun('organ_collision', 'haptics', HapticsTest, sys.argv)
