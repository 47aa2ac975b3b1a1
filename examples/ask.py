#!/usr/bin/python3
"""Asks which faces of `tissue` a shaft would touch if its tip came down onto the sheet, and how far
it would then be from the sheet."""

import argparse

from geometry_msgs.msg import Point
from organ_collision.msg import Clearance, ContactArray, ToolMotion
from organ_collision.srv import QueryCollision
import rospy
from std_msgs.msg import Header

argparse.ArgumentParser(description=__doc__).parse_args(rospy.myargv()[1:])  # --help
rospy.init_node('ask', anonymous=True)
rospy.wait_for_service('/organ_collision/query')
query = rospy.ServiceProxy('/organ_collision/query', QueryCollision, persistent=True)
motion = ToolMotion(previous_trocar=Point(0, 0, 0.1), previous_tip=Point(0.02, 0.01, 0.02),
                    trocar=Point(0, 0, 0.1), tip=Point(0.02, 0.01, 0.003), radius=0.005)
answer = query(header=Header(frame_id='tissue'), organ='tissue', motion=motion,
               mode=ContactArray.SWEPT, margin=0.1).result
print('status', answer.status, answer.message)
for contact in answer.contacts:
    print('face %d, %.1f mm' % (contact.face, 1e3 * contact.depth))
if answer.clearance.state == Clearance.KNOWN:  # negative: the shaft touches
    print('distance %.1f mm' % (1e3 * answer.clearance.distance))
