#!/usr/bin/python3
"""Both arms of dvrk.launch touch the organ with both jaws, and the hands feel forces out of it, within the limit."""

import sys
import time
import unittest

from geometry_msgs.msg import Vector3, WrenchStamped
import numpy as np
from organ_collision import contact_table
from organ_collision.msg import ContactArray
import rospy
import rostest
from std_msgs.msg import Bool

LIMIT = 60.0  # [s]
JAWS = {arm + link for arm in ('PSM1', 'PSM2') for link in ('_left_jaw', '_right_jaw')}
HANDS = ('MTMR', 'MTML')
MAX_FORCE = 2.0  # [N] as in dvrk.launch
RADII, BREATH = np.array([0.09, 0.06, 0.035]), 0.03  # of dvrk_organ.py
# The axes of the organ's frame in the camera's. The third one points out of the organ where the arms touch it.
AXES = np.array([[-1, 0, 0], [0, 0.8, 0.6], [0, 0.6, -0.8]]).T


def wait_until(condition, what):
    end = time.monotonic() + LIMIT
    while not condition():
        if time.monotonic() > end:
            raise AssertionError('waited %g s without success: %s' % (LIMIT, what()))
        time.sleep(0.01)


def force_of(message):
    force = message.wrench.force
    return np.array([force.x, force.y, force.z])


class Log:
    """All messages of a topic."""

    def __init__(self, topic, kind):
        self.messages = []
        self.subscriber = rospy.Subscriber(topic, kind, self.messages.append, queue_size=1000)


class DvrkTest(unittest.TestCase):

    def test_jaws_touch_the_organ(self):
        def touched():
            return {answer.links[contact.link] for answer in list(log.messages) for contact in answer.contacts}
        log = Log('/organ_collision/contacts', ContactArray)
        wait_until(lambda: JAWS <= touched(), lambda: 'contacts of all jaws; there are those of %s' % touched())
        for answer in list(log.messages):
            if answer.contacts:
                shape = np.linalg.norm(contact_table(answer).point / RADII, axis=1)
                self.assertLess(abs(shape - 1).max(), BREATH + 0.01)

    def test_hands_feel_limited_forces_out_of_the_organ(self):
        def pushed_out():
            """The forces of the first moments may point inward, because the jaws may begin inside the organ."""
            return [hand for hand in HANDS if any(force_of(m) @ AXES[:, 2] > 0 for m in list(logs[hand].messages))]
        logs = {hand: Log('/%s/body/servo_cf' % hand, WrenchStamped) for hand in HANDS}
        wait_until(lambda: len(pushed_out()) == 2, lambda: 'forces on both hands; there are those on %s' % pushed_out())
        for log in logs.values():
            for message in list(log.messages):
                self.assertEqual(message.header.frame_id, 'ECM')
                self.assertLessEqual(np.linalg.norm(force_of(message)), MAX_FORCE + 1e-9)
                self.assertEqual(message.wrench.torque, Vector3())

    def test_the_axes_of_forces_do_not_turn_with_the_hand(self):
        for hand in HANDS:
            log = Log('/%s/body/set_cf_orientation_absolute' % hand, Bool)
            wait_until(lambda: log.messages, lambda: 'a message for ' + hand)
            self.assertTrue(log.messages[-1].data)

    def test_a_wrench_is_turned_scaled_limited_and_ends(self):
        def is_felt():
            wrench.header.frame_id = 'liver'
            wrench.wrench.force = Vector3(*pushed)
            publisher.publish(wrench)
            return any(np.allclose(force_of(m), expected, atol=1e-3) for m in list(felt.messages))
        publisher = rospy.Publisher('/tested_hand/wrench', WrenchStamped, queue_size=1)
        felt, wrench = Log('/tested_hand/servo_cf', WrenchStamped), WrenchStamped()
        pushed, expected = np.array([0.3, -0.5, 1.2]), AXES @ [0.15, -0.25, 0.6]
        wait_until(is_felt, lambda: 'half of the force; there are %s' % felt.messages[-3:])
        pushed, expected = np.array([3.0, 0.0, 4.0]), AXES @ [0.6, 0.0, 0.8]
        wait_until(is_felt, lambda: 'a limited force; there are %s' % felt.messages[-3:])
        wait_until(lambda: not force_of(felt.messages[-1]).any(), lambda: 'the end; there is %s' % felt.messages[-1])


if __name__ == '__main__':
    rospy.init_node('dvrk_test')
    rostest.rosrun('organ_collision', 'dvrk', DvrkTest, sys.argv)
