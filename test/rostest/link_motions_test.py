#!/usr/bin/python3
"""Motions of the node's own tools that a request gives: they touch what the same steps touch."""

import random
import sys

import numpy as np
from organ_collision import Queries, contacts_of_all, link_motions, shaft_motions
from organ_collision.msg import ContactArray
import rospy
import rostest

from support import scenes
from support.contact_case import xyz
from support.link_case import LinkCase

SHEET = scenes.sheet(0.1, 6)
NO_TURN = (0.0, 0.0, 0.0, 1.0)


def rows(contacts):
    """What of contacts does not depend on rounding."""
    return [(c.face, c.link) for c in contacts]


class LinkMotionsTest(LinkCase):
    link_frames = {'hook': ('hook_trocar', 'hook_tip', 'hook/ball'), 'ball': ('ball/ball',)}

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.queries = Queries(timeout=20.0)

    @staticmethod
    def places(rng):
        """Places of the hook's trocar, its tip and its ball."""

        def near(low, high):
            return (rng.uniform(-0.04, 0.04), rng.uniform(-0.04, 0.04), rng.uniform(low, high))

        return (near(0.2, 0.3), near(-0.04, 0.04), near(-0.04, 0.04))

    def asked(self, way):
        """The arguments of the same steps as motions of a batch."""
        trocars, tips, balls = np.swapaxes(np.array(way), 0, 1)
        poses = [[(*ball, *NO_TURN)] for ball in balls]
        shafts = shaft_motions(trocars[1:], tips[1:], 0.0, trocars[:-1], tips[:-1])
        return dict(links=poses[1:], previous_links=poses[:-1], shafts=shafts, frame='liver_frame')

    def test_steps_again_as_motions(self):
        rng = random.Random(23)
        way = [self.places(rng) for _ in range(12)]
        first = {'hook': way[0], 'ball': way[0][2:]}
        self.step(SHEET, first)
        steps = [
            self.step(SHEET, {'hook': places, 'ball': places[2:]}, vertices=True)
            for places in way[1:]
        ]
        touched = 0
        for tool in ('hook', 'ball'):
            asked = self.asked(way)
            if tool == 'ball':
                asked['shafts'] = ()
            answers = self.queries.answer_links(self.organ, tool, **asked)
            self.assertEqual(len(answers), len(steps))
            for answer, step in zip(answers, (step[tool] for step in steps)):
                self.assert_ok(answer)
                self.assertEqual((answer.tool, answer.links), (tool, step.links))
                self.assertEqual(rows(answer.contacts), rows(step.contacts))
                for found, expected in zip(answer.contacts, step.contacts):
                    self.assert_near(xyz(found.point), xyz(expected.point), 1e-6, 'point')
                    self.assertAlmostEqual(found.depth, expected.depth, delta=1e-6)
                touched += len(step.contacts)
            table = contacts_of_all(answers)
            self.assertEqual(len(table), sum(len(answer.contacts) for answer in answers))
        self.assertGreater(touched, 50)

        asked = self.asked(way)
        (single,) = link_motions(asked['links'][-1:], asked['previous_links'][-1:])
        answer = self.node.query(
            self.organ, asked['shafts'][-1], ContactArray.SWEPT, 'hook', link_motion=single
        )
        self.assertEqual(rows(answer.contacts), rows(steps[-1]['hook'].contacts))

    def test_a_batch_ends_with_the_first_motion_that_touches(self):
        self.node.send_mesh(self.organ, SHEET, rospy.Time(1))
        self.node.wait_for_shape(self.organ, rospy.Time(1))
        heights = [0.05, 0.04, 0.03, -0.03, -0.04, 0.05]
        poses = [[(0.011, 0.012, z, *NO_TURN)] for z in heights]
        answers = self.queries.answer_links(
            self.organ,
            'ball',
            poses[1:],
            poses[:-1],
            frame='liver_frame',
            stop_at_first_contact=True,
        )
        self.assertEqual([len(answer.contacts) > 0 for answer in answers], [False, False, True])

    def test_illegal_motions_are_refused_one_by_one(self):
        self.node.send_mesh(self.organ, SHEET, rospy.Time(1))
        self.node.wait_for_shape(self.organ, rospy.Time(1))
        good, no_turn, nowhere = (
            (0.0, 0.0, 0.001, *NO_TURN),
            (0.0, 0.0, 0.001, 0.0, 0.0, 0.0, 0.0),
            (0.0, float('nan'), 0.001, *NO_TURN),
        )
        answers = self.queries.answer_links(
            self.organ, 'ball', [[good], [no_turn], [nowhere], [good]], frame='liver_frame'
        )
        self.assertEqual(
            [answer.status for answer in answers],
            [0, ContactArray.INVALID_REQUEST, ContactArray.INVALID_REQUEST, 0],
        )
        self.assertIn("'ball'", answers[1].message)
        self.assertIn('(0, 0, 0, 0)', answers[1].message)
        self.assertIn('nan', answers[2].message)
        self.assertGreater(len(answers[3].contacts), 0)


if __name__ == '__main__':
    rospy.init_node('link_motions_test')
    rostest.rosrun('organ_collision', 'link_motions', LinkMotionsTest, sys.argv)
