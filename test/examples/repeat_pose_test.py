#!/usr/bin/python3
"""A tool sends one pose and then rests. Shapes get no transform, until repeat_pose.py repeats this pose."""

import signal
import subprocess
import sys
import unittest

from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion
from organ_collision.msg import ContactArray, OrganMesh, OrganVertices
import roslib.packages
import rospy
import rostest
from std_msgs.msg import Header

LIMIT = 30.0  # [s]
ANSWERS = 20
SHEET = [-0.1, -0.1, 0.05, 0.1, -0.1, 0.05, 0.1, 0.1, 0.05, -0.1, 0.1, 0.05]


class RepeatPoseTest(unittest.TestCase):

    def setUp(self):
        self.pose = rospy.Publisher('/stylus/pose', PoseStamped, queue_size=1, latch=True)
        self.mesh = rospy.Publisher('/organ_collision/organ_mesh', OrganMesh, queue_size=1, latch=True)
        self.shape = rospy.Publisher('/organ_collision/organ_vertices', OrganVertices, queue_size=1)
        self.repeated = []
        self.listener = rospy.Subscriber('/stylus/pose_repeated', PoseStamped, self.repeated.append)
        self.answers = []
        self.contacts = rospy.Subscriber('/organ_collision/contacts', ContactArray, self.answers.append)

    def move_until(self, is_done, what):
        """Sends shapes until a condition holds."""
        deadline = rospy.Time.now() + rospy.Duration(LIMIT)
        while not is_done():
            self.assertLess(rospy.Time.now(), deadline, what)
            self.shape.publish(OrganVertices(Header(stamp=rospy.Time.now(), frame_id='tissue'), 'sheet', 0, SHEET))
            rospy.sleep(0.02)

    def count(self, status):
        return sum(answer.status == status for answer in self.answers)

    def test_shapes_are_answered_while_the_tool_rests(self):
        now = rospy.Time.now()
        self.mesh.publish(OrganMesh(Header(stamp=now, frame_id='tissue'), 'sheet', 0, SHEET, [0, 1, 2, 0, 2, 3]))
        resting = Pose(Point(0.01, 0.02, 0.047), Quaternion(0, 0, 0, 1))
        self.pose.publish(PoseStamped(Header(stamp=now, frame_id='tissue'), resting))
        self.move_until(lambda: self.count(ContactArray.NO_TRANSFORM) > 0, 'no answer NO_TRANSFORM')

        program, = roslib.packages.find_node('organ_collision', 'repeat_pose.py')
        repeater = subprocess.Popen([program, '/stylus/pose', '/stylus/pose_repeated'])
        try:
            self.move_until(lambda: self.count(ContactArray.OK) >= ANSWERS, 'too few answers OK')
        finally:
            repeater.send_signal(signal.SIGINT)
            self.assertEqual(repeater.wait(LIMIT), 0)

        answered = [answer for answer in self.answers if answer.status == ContactArray.OK]
        self.assertTrue(all(answer.contacts for answer in answered))
        stamps = [pose.header.stamp for pose in self.repeated]
        self.assertEqual(stamps, sorted(set(stamps)))
        self.assertTrue(all(pose.pose == resting and pose.header.frame_id == 'tissue' for pose in self.repeated))


if __name__ == '__main__':
    rospy.init_node('repeat_pose_test')
    rostest.rosrun('organ_collision', 'repeat_pose', RepeatPoseTest, sys.argv)
