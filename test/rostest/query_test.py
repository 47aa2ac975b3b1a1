#!/usr/bin/python3
"""The services query and query_batch: of motions in any frame and of links, with both pickers. A long batch does not
disturb the node, which may end in the middle of it. Refusals are in test/ros/queries."""

import random
import sys
import threading

import numpy as np
from organ_collision import Queries, shaft_motions
from organ_collision.msg import ContactArray, ToolPlacement
from organ_collision.srv import QueryCollisionBatch
import rospy
import rostest

from support import scenes
from support.contact_case import KeepsContract, xyz
from support.node_client import FAR_AWAY, NodeClient, shaft, wait_until
from support.processes import NodeStarter
from support.tool_case import ToolCase

STATIC, SWEPT = ContactArray.STATIC, ContactArray.SWEPT
PAPER_NAIVE = ContactArray.PAPER_NAIVE
SHEET = scenes.sheet(0.1, 5).moved(lambda v: (v[0], v[1], v[2] + 0.1 * v[0] - 0.05 * v[1]))
LIVER = scenes.liver()
CAMERA_IN_LIVER = scenes.Pose((0.3, -0.2, 0.5, 0.8), (0.4, -0.3, 0.9))
NO_TURN = (0.0, 0.0, 0.0, 1.0)
LONG = 100000  # motions of a batch that takes far longer than the test


class Batch(threading.Thread):
    """A batch that is asked in a thread of its own. `outcome`: its answer, or the error."""

    def __init__(self, node, organ, motions, **asked):
        super().__init__(daemon=True)
        self.service = rospy.ServiceProxy(node + '/query_batch', QueryCollisionBatch)
        self.request = self.service.request_class(organ=organ, motions=motions, mode=SWEPT, **asked)
        self.request.header.frame_id = 'liver_frame'
        self.outcome = None
        self.start()

    def run(self):
        try:
            self.outcome = self.service(self.request)
        except rospy.ServiceException as error:
            self.outcome = error


class QueryTest(KeepsContract, ToolCase, NodeStarter):
    link_frames = {'hook': ('hook_trocar', 'hook_tip', 'hook/ball'), 'ball': ('ball/ball',)}

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.select = NodeClient('/select')
        for node in (cls.node, cls.select):
            for name, mesh in (('sheet', SHEET), ('liver', LIVER)):
                node.bring(name, mesh)
        cls.tf.send_resting(('liver_frame', 'camera', CAMERA_IN_LIVER))
        wait_until(lambda: cls.node.query('sheet', FAR_AWAY, frame='camera').status == 0, 'the frame of the camera')

    def test_random_motions_with_both_pickers(self):
        """Alone and in a batch, in the frame of a camera and in the organ's: the same contacts. A large tool touches
        every face."""
        rng = random.Random(21)
        point = lambda low, high: (rng.uniform(-0.07, 0.07), rng.uniform(-0.07, 0.07), rng.uniform(low, high))
        axis = lambda: (point(0.1, 0.2), point(-0.03, 0.06))
        motions, values = [(axis(), axis()) for _ in range(12)], {}
        for node, frame in ((self.node, 'camera'), (self.select, 'liver_frame')):
            move = CAMERA_IN_LIVER.inverse().apply if frame == 'camera' else tuple
            for mode in (SWEPT, STATIC):
                given = [shaft(*map(move, now), 0.004, tuple(map(move, before))) for before, now in motions]
                results = node.query_batch('sheet', given, mode, frame=frame)
                self.assertEqual(node.query('sheet', given[3], mode, frame=frame).contacts, results[3].contacts)
                values.setdefault(frame, []).extend(
                    (i, c.face, c.fraction, *xyz(c.point), *xyz(c.normal), *c.barycentric, c.shaft, c.depth, c.behind)
                    for i, result in enumerate(results) for c in result.contacts)
        self.assertGreater(len(values['camera']), 30)
        np.testing.assert_allclose(values['camera'], values['liver_frame'], atol=1e-6)
        every = shaft((0.05, 0.02, 0.3), (0.08, 0.01, -0.12), 2.0, previous=((0.05, 0.02, 0.3), (0.02, 0.0, -0.1)))
        for node in (self.node, self.select):
            for mode in range(PAPER_NAIVE + 1):
                result = node.query('liver', every, mode, regions=mode == SWEPT)
                self.assertEqual([contact.face for contact in result.contacts], list(range(len(LIVER.faces))))

    def test_placement_comes_once_the_node_knows_the_surface(self):
        motion = shaft((0.3, 0.31, 0.32), (0.0013, -0.0021, 0.0017), 0.002)
        ask = lambda: self.node.query('liver', motion, placement=True).placement
        found = wait_until(lambda: ask() if ask().tip != ToolPlacement.UNKNOWN else None, 'sides of the liver')
        self.assertEqual((found.tip, found.trocar, len(found.crossings), found.length_known),
                         (ToolPlacement.INSIDE, ToolPlacement.OUTSIDE, 1, True))
        (of_batch,) = self.node.query_batch('liver', [motion], placement=True)
        self.assertEqual(of_batch.placement, found)

    def test_motions_of_links_are_those_of_steps(self):
        """A hook that has a shaft and a ball, and a ball alone."""
        rng, queries, touched = random.Random(23), Queries(timeout=20.0), 0
        near = lambda low, high: (rng.uniform(-0.04, 0.04), rng.uniform(-0.04, 0.04), rng.uniform(low, high))
        way = [(near(0.2, 0.3), near(-0.04, 0.04), near(-0.04, 0.04)) for _ in range(6)]
        steps = [self.step(SHEET, {'hook': places, 'ball': places[2:]}, vertices=i > 0) for i, places in enumerate(way)]
        trocars, tips, balls = np.swapaxes(np.array(way), 0, 1)
        poses = [[(*ball, *NO_TURN)] for ball in balls]
        shafts = shaft_motions(trocars[1:], tips[1:], 0.0, trocars[:-1], tips[:-1])
        for tool in ('hook', 'ball'):
            answers = queries.answer_links(self.organ, tool, poses[1:], poses[:-1], frame='liver_frame',
                                           shafts=shafts if tool == 'hook' else ())
            self.assertEqual(len(answers), len(steps) - 1)
            for answer, step in zip(answers, [step[tool] for step in steps[1:]]):
                self.assertEqual((answer.status, answer.tool, answer.links), (0, tool, step.links))
                self.assertEqual([(c.face, c.link) for c in answer.contacts], [(c.face, c.link) for c in step.contacts])
                touched += len(step.contacts)
        self.assertGreater(touched, 20)

    def test_a_long_batch_in_the_background(self):
        """Steps go on, and single queries are answered. Nothing is measured in time: the batch is going on as long as
        /diagnostics counts its motions."""
        name, tip, small = '/served', (0.01, 0.02, 0.002), scenes.sheet(0.1, 4)
        process = self.start(name, {'tools': [{'name': 'probe', 'trocar_frame': 'liver_frame', 'tip_frame': 'probe_tip',
                                               'radius': 0.005}], 'diagnostic_period_sec': 0.05})
        node = NodeClient(name)
        self.addCleanup(node.close)
        self.tf.wait_for(node)
        self.tf.send_resting(('liver_frame', 'probe_tip', tip))
        # How far a motion is from each of many faces takes milliseconds.
        for organ, mesh in (('large', scenes.sheet(0.1, 100)), ('small', small)):
            node.bring(organ, mesh, rospy.Time(1))
        answered = lambda: node.diagnostics.count('motions of batches')
        slow = shaft((0.02, 0.01, 0.5), (0.03, 0.02, 0.3), 0.005, ((0.02, 0.01, 0.5), (-0.03, 0.02, 0.3)))
        first = Batch(name, 'large', [slow] * LONG, clearance=True)
        before = wait_until(answered, 'motions of the batch')
        second = Batch(name, 'small', [FAR_AWAY])
        for step in range(2, 32):
            node.send_vertices('small', small, rospy.Time(step))
            self.assert_ok(node.contacts.wait_for('small', 'probe', mesh_stamp=rospy.Time(step)))
            self.assert_ok(node.query('small', FAR_AWAY))
        wait_until(lambda: answered() > before, 'more motions of the batch')
        self.assertLess(answered(), LONG)
        self.assertIsNone(first.outcome)
        self.stop(process)
        for batch in (first, second):
            batch.join(timeout=30)
            if not isinstance(batch.outcome, rospy.ServiceException):
                self.assertEqual((batch.outcome.status, batch.outcome.results), (ContactArray.PICKER_FAILED, []))


if __name__ == '__main__':
    rospy.init_node('query_test')
    rostest.rosrun('organ_collision', 'query', QueryTest, sys.argv)
