#!/usr/bin/python3
"""The services query and query_batch: of motions in any frame and of the node's tools, with both pickers. What they
refuse. A long batch does not disturb the node, which may end in the middle of it."""

import io
import random
import sys
import threading

import numpy as np
from organ_collision import Queries, shaft_motions
from organ_collision.msg import Clearance, ContactArray, ToolPlacement
from organ_collision.srv import QueryCollisionBatch
import rospy
import rostest

from support import oracle, scenes
from support.contact_case import KeepsContract, xyz
from support.node_client import FAR_AWAY, NodeClient, shaft, wait_until
from support.processes import NodeStarter
from support.tool_case import ToolCase

STATIC, SWEPT, INVALID = ContactArray.STATIC, ContactArray.SWEPT, ContactArray.INVALID_REQUEST
PAPER_NAIVE = ContactArray.PAPER_NAIVE
NAN = float('nan')
SHEET = scenes.sheet(0.1, 5).moved(lambda v: (v[0], v[1], v[2] + 0.1 * v[0] - 0.05 * v[1]))
LIVER = scenes.liver()
CAMERA_IN_LIVER = scenes.Pose((0.3, -0.2, 0.5, 0.8), (0.4, -0.3, 0.9))
AXIS = ((0.01, 0.02, 0.3), (0.011, 0.017, 0.002))
NO_TURN = (0.0, 0.0, 0.0, 1.0)
HUGE = 'x' * 10**7
SMALL = 4000  # [bytes] more than the longest names and the longest message together
LONG = 100000  # motions of a batch that takes far longer than the test


def size(message):
    buffer = io.BytesIO()
    message.serialize(buffer)
    return len(buffer.getvalue())


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

    def test_one_face_every_field_by_hand(self):
        """The tip is 4 mm above a horizontal face and its radius is 5 mm, so it is 1 mm deep."""
        self.node.bring('plate', scenes.one_face(0.25), rospy.Time(3, 4), topology=17)
        result = self.node.query('plate', shaft((0.01, 0.02, 0.5), (0.01, 0.02, 0.254), 0.005))
        self.assert_ok(result)
        self.assertEqual((result.header.frame_id, result.organ, result.topology, result.mesh_stamp),
                         ('liver_frame', 'plate', 17, rospy.Time(3, 4)))
        self.assertEqual((result.tool, result.links, result.mode, result.regions), ('', [''], STATIC, []))
        self.assertEqual((result.step_start, result.clearance, result.placement),
                         (result.header.stamp, Clearance(), ToolPlacement()))
        (contact,) = result.contacts
        self.assertEqual((contact.face, contact.link, contact.fraction, contact.behind), (0, 0, 0.0, False))
        self.assert_near(xyz(contact.point), (0.01, 0.02, 0.25), 1e-9, 'point')
        self.assert_near(xyz(contact.normal), (0, 0, -1), 1e-9, 'normal')
        self.assertAlmostEqual(contact.shaft, 1.0, delta=1e-12)
        self.assertAlmostEqual(contact.depth, 0.001, delta=1e-9)

    def test_random_motions_with_both_pickers(self):
        """Alone and in a batch, in the frame of a camera and in the organ's. A large tool touches every face."""
        rng = random.Random(21)
        point = lambda low, high: (rng.uniform(-0.07, 0.07), rng.uniform(-0.07, 0.07), rng.uniform(low, high))
        axis = lambda: (point(0.1, 0.2), point(-0.03, 0.06))
        motions, touched = [(axis(), axis()) for _ in range(12)], 0
        for mode, radius in ((SWEPT, 0.004), (STATIC, 0.005)):
            expected = [oracle.contacts(SHEET, SHEET, m if mode == SWEPT else (m[1], m[1]), radius) for m in motions]
            touched += sum(map(len, expected))
            for node, frame in ((self.node, 'camera'), (self.select, 'liver_frame')):
                move = CAMERA_IN_LIVER.inverse().apply if frame == 'camera' else tuple
                given = [shaft(*map(move, now), radius, tuple(map(move, before))) for before, now in motions]
                results = node.query_batch('sheet', given, mode, frame=frame)
                self.assertEqual(len(results), len(motions))
                for result, right in zip(results, expected):
                    self.assert_contacts(result, right, 1e-6)
                self.assertEqual(node.query('sheet', given[3], mode, frame=frame).contacts, results[3].contacts)
        self.assertGreater(touched, 30)
        every = shaft((0.05, 0.02, 0.3), (0.08, 0.01, -0.12), 2.0, previous=((0.05, 0.02, 0.3), (0.02, 0.0, -0.1)))
        for node in (self.node, self.select):
            for mode in range(PAPER_NAIVE + 1):
                result = node.query('liver', every, mode, regions=mode == SWEPT)
                self.assertEqual([contact.face for contact in result.contacts], list(range(len(LIVER.faces))))

    def test_stamp_says_when_to_transform(self):
        """A carrier sinks by 0.1 m in 0.1 s, and takes the tip to the sheet at a known time."""
        begin = rospy.Time.now() - rospy.Duration(1)
        self.tf.send(*[('liver_frame', 'carrier', scenes.at((0, 0, 0.1 - 0.01 * i)),
                        begin + rospy.Duration(0, 10**7 * i))
                       for i in range(11)])
        motion = shaft((0.01, 0.002, 0.3), (0.01, 0.002, 0.0), 0.004)
        end = begin + rospy.Duration(0, 10**8)
        wait_until(lambda: self.node.query('sheet', motion, frame='carrier', stamp=end).status == 0, 'the carrier')
        for height, stamp in ((0.055, begin + rospy.Duration(0, 45 * 10**6)), (0.0, end), (0.0, rospy.Time())):
            axis = ((0.01, 0.002, 0.3 + height), (0.01, 0.002, height))
            result = self.node.query('sheet', motion, frame='carrier', stamp=stamp)
            self.assert_contacts(result, oracle.static_contacts(SHEET, axis, 0.004))
        early = self.node.query('sheet', motion, frame='carrier', stamp=begin - rospy.Duration(1))
        self.assertEqual(early.status, ContactArray.NO_TRANSFORM)

    def test_a_tool_of_the_node_by_name(self):
        """STATIC uses the tool's present pose in TF. SWEPT moves it there from its last published pose."""
        axes = [((0.1, 0.02, 0.3), tip) for tip in ((0.01, 0.003, 0.05), (0.013, 0.001, -0.05))]
        first = self.step(SHEET, {'grasper': axes[0]})['grasper']
        self.assert_contacts(first, [])
        self.place_and_wait('grasper', axes[1], self.next_stamp())
        static = self.node.query(self.organ, tool='grasper')
        self.assert_contacts(static, oracle.static_contacts(SHEET, axes[1], 0.005), 1e-6)
        self.assertEqual((static.tool, static.links), ('grasper', ['']))
        for _ in range(2):  # twice, because queries change no history
            swept = self.node.query(self.organ, mode=SWEPT, tool='grasper', regions=True)
            self.assert_contacts(swept, oracle.swept_contacts(SHEET, *axes, 0.005), 1e-6)
            self.assertGreater(len(swept.contacts), 0)
            self.assert_regions_lie_on_faces(swept, SHEET)
        self.assertEqual(len(self.node.contacts.of(self.organ, 'grasper')), 1)

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
        heights = [[(0.011, 0.012, z, *NO_TURN)] for z in (0.05, 0.04, 0.03, -0.03, -0.04, 0.05)]
        answers = queries.answer_links(self.organ, 'ball', heights[1:], heights[:-1], frame='liver_frame',
                                       stop_at_first_contact=True)
        self.assertEqual([len(answer.contacts) > 0 for answer in answers], [False, False, True])

    def assert_refused(self, answer, status, words):
        """A refusal names the value, and stays small."""
        self.assertEqual(answer.status, status, answer.message[:1000])
        self.assertEqual(getattr(answer, 'results', None) or getattr(answer, 'contacts', None) or [], [])
        self.assertLess(size(answer), SMALL)
        for word in words:
            self.assertIn(word, answer.message)

    def test_refusals(self):
        motion, expected = shaft(*AXIS, 0.005, AXIS), oracle.static_contacts(SHEET, AXIS, 0.005)
        for asked, status, *words in (
            (dict(motion=shaft(*AXIS, -0.25)), INVALID, 'radius', '-0.25'),
            (dict(motion=shaft((NAN, 0.0, 0.3), AXIS[1], 0.005)), INVALID, 'nan'),
            (dict(motion=motion, mode=5), INVALID, '5', '4'),
            (dict(organ='kidney', motion=motion), ContactArray.UNKNOWN_ORGAN, 'kidney', 'sheet'),
            (dict(organ=HUGE, motion=motion), INVALID, 'organ', '256'),
            (dict(tool='scalpel'), ContactArray.UNKNOWN_TOOL, 'scalpel', 'grasper'),
            (dict(motion=motion, frame='nowhere'), ContactArray.NO_TRANSFORM, 'nowhere'),
            (dict(motion=motion, frame=HUGE), INVALID, 'frame_id', '256'),
        ):
            self.assert_refused(self.node.query(asked.pop('organ', 'sheet'), **asked), status, words)
            self.assert_contacts(self.node.query('sheet', shaft(*AXIS, 0.005)), expected)

    def test_refusals_of_batches(self):
        """max_batch is 30, and max_batch_bytes 100 000. One bad motion leaves the rest of its batch alone."""
        motion, through_all = shaft(*AXIS, 0.005), shaft((0.0, 0.0, 0.1), (0.0, 0.0, -0.1), 0.2)
        fit = 100000 // size(self.node.query('sheet', through_all))
        self.assertIn(fit, range(5, 30))
        for asked, status, *words in (
            (dict(motions=[motion] * 31), INVALID, '31 motions', '30', 'max_batch'),
            (dict(motions=[through_all] * 30), INVALID, 'first %d of 30' % (fit + 1), '100000', 'max_batch_bytes'),
            (dict(motions=[motion], organ='kidney'), ContactArray.UNKNOWN_ORGAN, 'kidney', 'sheet'),
            (dict(motions=[motion] * 30, organ=HUGE), INVALID, '256'),
            (dict(motions=[motion] * 30, frame='nowhere'), ContactArray.NO_TRANSFORM, 'nowhere'),
        ):
            self.assert_refused(self.node.answer_batch(asked.pop('organ', 'sheet'), **asked), status, words)
        self.assertEqual(len(self.node.query_batch('sheet', [through_all] * fit)), fit)
        results = self.node.query_batch('sheet', [motion, shaft(*AXIS, -0.25), motion])
        self.assertEqual([result.status for result in results], [ContactArray.OK, INVALID, ContactArray.OK])
        self.assertIn('-0.25', results[1].message)
        self.assert_contacts(results[2], oracle.static_contacts(SHEET, AXIS, 0.005))

    def test_a_long_batch_in_the_background(self):
        """Steps go on, and single queries are answered. Nothing is measured in time: the batch is going on as long as
        /diagnostics counts its motions."""
        name, tip, small = '/served', (0.01, 0.02, 0.002), scenes.sheet(0.1, 4)
        process = self.start(name, {'tools': [{'name': 'probe', 'trocar_frame': 'liver_frame', 'tip_frame': 'probe_tip',
                                               'radius': 0.005}], 'diagnostic_period': 0.05})
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
