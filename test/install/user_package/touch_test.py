#!/usr/bin/python3
"""The probe of the example touches its tissue."""

import unittest

from geometry_msgs.msg import Point
from organ_collision.msg import ContactArray, ToolMotion
from organ_collision.srv import QueryCollision
import rospy
from std_msgs.msg import Header

LIMIT = 60.0  # s
ROW = list(range(64, 80))  # the faces of the example's tissue whose y are between 0 and 12.5 mm


class TouchTest(unittest.TestCase):

    def test_contacts_are_published(self):
        end = rospy.Time.now() + rospy.Duration(LIMIT)
        touched = []
        while not touched and rospy.Time.now() < end:
            answer = rospy.wait_for_message('/organ_collision/contacts', ContactArray, LIMIT)
            touched = [contact.face for contact in answer.contacts]
        self.assertTrue(touched)
        self.assertEqual((answer.status, answer.organ, answer.tool), (ContactArray.OK, 'tissue', 'probe'))

    def test_a_motion_through_the_tissue_touches_all_faces_of_a_row(self):
        rospy.wait_for_message('/organ_collision/contacts', ContactArray, LIMIT)  # The organ has come.
        query = rospy.ServiceProxy('/organ_collision/query', QueryCollision)
        motion = ToolMotion(previous_trocar=Point(0, 0, 0.1), previous_tip=Point(0.08, 0.01, -0.05),
                            trocar=Point(0, 0, 0.1), tip=Point(-0.08, 0.01, -0.05), radius=0.005)
        answer = query(header=Header(frame_id='tissue'), organ='tissue', motion=motion, mode=ContactArray.SWEPT)
        self.assertEqual(answer.result.status, ContactArray.OK, answer.result.message)
        self.assertEqual([contact.face for contact in answer.result.contacts], ROW)


if __name__ == '__main__':
    import rostest
    rospy.init_node('touch_test')
    rostest.rosrun('user_package', 'touch', TouchTest)
