#!/usr/bin/python3
"""Asks which faces of `tissue` a probe would touch at many places. Prints a line for each."""

import argparse

import numpy as np
from organ_collision import Queries
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
