#!/usr/bin/python3
"""Asks which faces of `tissue` a probe would touch at many places, and how far it would be at the first one."""

import argparse

import numpy as np
from organ_collision import clearance_record, Queries
from organ_collision.msg import Clearance
import rospy

argparse.ArgumentParser(description=__doc__).parse_args(rospy.myargv()[1:])  # --help
rospy.init_node('ask_many', anonymous=True)
x = np.linspace(-0.08, 0.08, 9)
tips = np.column_stack([x, np.full(9, 0.01), np.zeros(9)])
trocars = tips + [0, 0, 0.1]

queries = Queries('/organ_collision')
queries.wait_for('tissue')
for tip, contacts in zip(tips, queries.query_many('tissue', trocars, tips, radius=0.005)):
    print('x = %.2f m: %d faces' % (tip[0], len(contacts)), *contacts.face)

clearance = clearance_record(queries.answer('tissue', trocars[0], tips[0], radius=0.005, margin=0.1))
if clearance.state == Clearance.KNOWN:
    print('x = %.2f m: %.1f mm away' % (tips[0][0], 1e3 * clearance.distance))
