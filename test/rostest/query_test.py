#!/usr/bin/python3
"""The services query and query_batch: of motions and of the node's tools, with both pickers, in any frame, with
clearance and placement. What they refuse."""

import io
import random
import sys

import numpy as np
from organ_collision import Queries, shaft_motions
from organ_collision.msg import Clearance, ContactArray, ToolPlacement
import rospy
import rostest

from support import oracle, scenes
from support.contact_case import KeepsContract, faces_of, xyz
from support.node_client import FAR_AWAY, NodeClient, shaft, wait_until
from support.tool_case import ToolCase
from support.vectors import length, lerp, scaled, sub

STATIC, SWEPT, INVALID = ContactArray.STATIC, ContactArray.SWEPT, ContactArray.INVALID_REQUEST
PAPER = (ContactArray.PAPER_STATIC, ContactArray.PAPER_SWEPT, ContactArray.PAPER_NAIVE)
NAN, INFINITY = float('nan'), float('inf')
SHEET = scenes.sheet(0.1, 5).moved(lambda v: (v[0], v[1], v[2] + 0.1 * v[0] - 0.05 * v[1]))
LIVER, SOLID = scenes.liver(), scenes.tetrahedron()
OPEN = scenes.Mesh(SOLID.vertices, SOLID.faces[:3])
CAMERA_IN_LIVER = scenes.Pose((0.3, -0.2, 0.5, 0.8), (0.4, -0.3, 0.9))
AXIS = ((0.01, 0.02, 0.3), (0.011, 0.017, 0.002))
NO_TURN = (0.0, 0.0, 0.0, 1.0)
STAMP = rospy.Time(7, 5)
HUGE = 'x' * 10**7
SMALL = 4000  # [bytes] more than the longest names and the longest message together


def size(message):
    buffer = io.BytesIO()
    message.serialize(buffer)
    return len(buffer.getvalue())


class QueryTest(KeepsContract, ToolCase):
    link_frames = {'hook': ('hook_trocar', 'hook_tip', 'hook/ball'), 'ball': ('ball/ball',)}

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.select = NodeClient('/select')
        for node in (cls.node, cls.select):
            for name, mesh in (('sheet', SHEET), ('liver', LIVER), ('solid', SOLID), ('open', OPEN)):
                node.bring(name, mesh, STAMP)
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
        """Trocars rest or move, some tools are balls, and some motions are given in the frame of a camera."""
        rng, touched = random.Random(21), 0

        def point(low, high):
            return (rng.uniform(-0.07, 0.07), rng.uniform(-0.07, 0.07), rng.uniform(low, high))

        for organ, mesh in (('sheet', SHEET), ('liver', LIVER)):
            motions = []
            for i in range(12):
                trocar, tip = point(0.1, 0.2), point(-0.03, 0.06)
                now = (trocar if i % 2 else point(0.1, 0.2), point(-0.03, 0.06))
                motions.append(((tip, tip), now[1:] * 2) if i % 6 == 0 else ((trocar, tip), now))
            for mode, radius in ((SWEPT, 0.004), (STATIC, 0.005)):
                expected = [oracle.contacts(mesh, mesh, m if mode == SWEPT else (m[1], m[1]), radius) for m in motions]
                touched += sum(map(len, expected))
                for node, frame in ((self.node, 'camera'), (self.select, 'liver_frame')):
                    move = CAMERA_IN_LIVER.inverse().apply if frame == 'camera' else tuple
                    given = [shaft(*map(move, now), radius, tuple(map(move, before))) for before, now in motions]
                    results = node.query_batch(organ, given, mode, frame=frame)
                    self.assertEqual(len(results), len(motions))
                    for result, right in zip(results, expected):
                        self.assert_contacts(result, right, 1e-6)
                    self.assertEqual(node.query(organ, given[3], mode, frame=frame).contacts, results[3].contacts)
        self.assertGreater(touched, 200)

    def test_the_papers_modes_with_both_pickers(self):
        rng, faces = random.Random(34), 0
        for organ in ('liver', 'solid'):
            for _ in range(8):
                trocar, previous, tip = [(rng.uniform(-0.04, 0.08), rng.uniform(-0.03, 0.03), rng.uniform(*height))
                                         for height in ((0.15, 0.25), (-0.01, 0.04), (-0.01, 0.04))]
                motion = shaft(trocar, tip, 0.005, previous=(trocar, previous))
                for mode in PAPER:
                    found = [node.query(organ, motion, mode) for node in (self.node, self.select)]
                    self.assertEqual(faces_of(found[0]), faces_of(found[1]))
                    faces += len(found[0].contacts)
                    for contact in found[0].contacts:
                        self.assertEqual((contact.depth, contact.barycentric), (0, (0, 0, 0)))
                        self.assertLessEqual(contact.view_min, contact.view_max)
        self.assertGreater(faces, 200)
        every = shaft((0.05, 0.02, 0.3), (0.08, 0.01, -0.12), 2.0, previous=((0.05, 0.02, 0.3), (0.02, 0.0, -0.1)))
        for node in (self.node, self.select):
            for mode in range(5):
                result = node.query('liver', every, mode, regions=mode == SWEPT)
                self.assertEqual(faces_of(result), list(range(1224)))

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

    def test_tissue_swings_through_a_resting_tool(self):
        """With organ_motion, the tissue moves during the step from its previous to its latest shape."""
        high, low = scenes.sheet(0.1, 3, 0.031), scenes.sheet(0.1, 3, -0.02)
        low = low.moved(lambda v: (v[0], v[1] + 0.004, v[2] + 0.2 * v[0]))
        self.node.bring('swing', high, rospy.Time(1))
        self.node.send_vertices('swing', low, rospy.Time(2))
        self.node.wait_for_shape('swing', rospy.Time(2))
        axis = ((-0.2, 0.004, 0.013), (0.012, 0.007, 0.015))
        motion = shaft(*axis, 0.003, previous=axis)
        self.assert_contacts(self.node.query('swing', motion, SWEPT), [])
        expected = oracle.contacts(low, high, (axis, axis), 0.003)
        self.assertGreater(len(expected), 2)
        asked = self.node.query('swing', motion, SWEPT, organ_motion=True, regions=True)
        self.assert_contacts(asked, expected)
        self.assertEqual(len(asked.regions), len(expected))
        (result,) = self.node.query_batch('swing', [motion], SWEPT, organ_motion=True)
        self.assert_contacts(result, expected)

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

    def test_clearance(self):
        """Alone and in a batch, within a margin and without limit."""
        for axis in (((0.02, -0.03, 0.3), (0.011, 0.006, 0.02)), ((0.02, -0.03, 0.3), (0.011, 0.006, 0.0035))):
            motion, distances = shaft(*axis, 0.004), []
            for face in range(len(SHEET.faces)):
                distances.append(oracle.nearest(axis, SHEET.face(face)).distance - 0.004)
            near = sorted(d for d in distances if 0 < d <= 0.03)
            result = self.node.query('sheet', motion, margin=0.03, max_near=7)
            self.assert_ok(result)
            found = result.clearance
            self.assertEqual((found.state, found.margin, found.unlimited), (Clearance.KNOWN, 0.03, False))
            self.assertAlmostEqual(found.distance, min(distances), delta=1e-9)
            self.assertAlmostEqual(distances[found.face], min(distances), delta=1e-9)
            way = sub(xyz(found.on_organ), xyz(found.on_tool))
            self.assert_near(way, scaled(xyz(found.normal), found.distance), 1e-9, 'on_organ - on_tool')
            self.assert_near(xyz(found.on_organ), oracle.weighted(SHEET.face(found.face), found.barycentric), 1e-9,
                             'place')
            self.assertEqual(result.near_left_out, max(0, len(near) - 7))
            for contact, right in zip(result.near, near):
                self.assertAlmostEqual(-contact.depth, right, delta=1e-9)
            (unlimited,) = self.node.query_batch('sheet', [motion], clearance=True)
            self.assertTrue(unlimited.clearance.unlimited)
            self.assertEqual((unlimited.clearance.distance, unlimited.near), (found.distance, []))
        beyond = self.node.query('sheet', FAR_AWAY, margin=0.03)
        self.assertEqual((beyond.clearance, beyond.near), (Clearance(state=Clearance.BEYOND_MARGIN, margin=0.03), []))

    def test_placement(self):
        """Once the node knows whether the surface is closed. Queries wait for it, but not for ever."""
        tip, trocar = (0.0013, -0.0021, 0.0017), (0.3, 0.31, 0.32)
        motion = shaft(trocar, tip, 0.002, previous=(trocar, trocar))
        for organ, mesh in (('solid', SOLID), ('liver', LIVER)):
            ask = lambda: self.node.query(organ, motion, SWEPT, placement=True).placement
            found = wait_until(lambda: ask() if ask().tip != ToolPlacement.UNKNOWN else None, 'sides of ' + organ)
            self.assertEqual((found.tip, found.trocar), (ToolPlacement.INSIDE, ToolPlacement.OUTSIDE))
            (crossing,) = found.crossings
            self.assertEqual((crossing.direction, crossing.vertices), (1, mesh.faces[crossing.face]))
            on_face = oracle.weighted(mesh.face(crossing.face), crossing.barycentric)
            self.assert_near(xyz(crossing.point), on_face, 1e-9, 'the crossing on its face')
            self.assert_near(xyz(crossing.point), lerp(trocar, tip, crossing.shaft), 1e-9, 'the crossing on the axis')
            self.assertTrue(found.length_known)
            self.assertAlmostEqual(found.length_inside, length(sub(tip, xyz(crossing.point))), delta=1e-9)
            (of_batch,) = self.node.query_batch(organ, [motion], SWEPT, placement=True)
            self.assertEqual(of_batch.placement, found)
        opened = self.node.query('open', motion, placement=True).placement
        self.assertEqual((opened.tip, opened.length_known), (ToolPlacement.UNKNOWN, False))

    def test_motions_of_links_are_those_of_steps(self):
        """A hook that has a shaft and a ball, and a ball alone."""
        rng, queries, touched = random.Random(23), Queries(timeout=20.0), 0
        near = lambda low, high: (rng.uniform(-0.04, 0.04), rng.uniform(-0.04, 0.04), rng.uniform(low, high))
        way = [(near(0.2, 0.3), near(-0.04, 0.04), near(-0.04, 0.04)) for _ in range(10)]
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
                for found, expected in zip(answer.contacts, step.contacts):
                    self.assert_near(xyz(found.point), xyz(expected.point), 1e-6, 'point')
                touched += len(step.contacts)
        self.assertGreater(touched, 50)
        heights = [[(0.011, 0.012, z, *NO_TURN)] for z in (0.05, 0.04, 0.03, -0.03, -0.04, 0.05)]
        answers = queries.answer_links(self.organ, 'ball', heights[1:], heights[:-1], frame='liver_frame',
                                       stop_at_first_contact=True)
        self.assertEqual([len(answer.contacts) > 0 for answer in answers], [False, False, True])
        bad = [[(0.0, 0.0, 0.001, *NO_TURN)], [(0.0, 0.0, 0.001, 0.0, 0.0, 0.0, 0.0)], [(0.0, NAN, 0.001, *NO_TURN)]]
        answers = queries.answer_links(self.organ, 'ball', bad, frame='liver_frame')
        self.assertEqual([answer.status for answer in answers], [0, INVALID, INVALID])
        self.assertIn('(0, 0, 0, 0)', answers[1].message)
        self.assertIn('nan', answers[2].message)

    def assert_refused(self, answer, status, words):
        """A refusal names the value, and stays small."""
        self.assertEqual(answer.status, status, answer.message[:1000])
        self.assertEqual(getattr(answer, 'results', None) or getattr(answer, 'contacts', None) or [], [])
        self.assertLess(size(answer), SMALL)
        for word in words:
            self.assertIn(word, answer.message)

    def test_refusals(self):
        motion, bad = shaft(*AXIS, 0.005, AXIS), shaft((NAN, 0.0, 0.3), AXIS[1], 0.005, AXIS)
        expected = oracle.static_contacts(SHEET, AXIS, 0.005)
        self.assertGreater(len(expected), 0)
        for asked, status, *words in (
            (dict(motion=shaft(*AXIS, 0.0)), INVALID, 'radius', '0'),
            (dict(motion=shaft(*AXIS, -0.25)), INVALID, 'radius', '-0.25'),
            (dict(motion=shaft(*AXIS, INFINITY)), INVALID, 'radius', 'inf'),
            (dict(motion=bad), INVALID, 'nan'),
            (dict(motion=motion, mode=5), INVALID, '5', '4'),
            (dict(motion=motion, mode=PAPER[0], clearance=True), INVALID, 'mode is 2'),
            (dict(motion=motion, margin=-1.0), INVALID, 'margin is -1', 'positive'),
            (dict(motion=motion, max_near=3, clearance=True), INVALID, 'max_near is 3'),
            (dict(organ='kidney', motion=motion), ContactArray.UNKNOWN_ORGAN, 'kidney', 'sheet'),
            (dict(organ='a\nb', motion=motion), INVALID, 'organ', '256'),
            (dict(organ=HUGE, motion=motion), INVALID, 'organ', '256'),
            (dict(tool='scalpel'), ContactArray.UNKNOWN_TOOL, 'scalpel', 'grasper'),
            (dict(tool=HUGE), INVALID, 'tool', '256'),
            (dict(motion=motion, frame='nowhere'), ContactArray.NO_TRANSFORM, 'nowhere'),
            (dict(motion=motion, frame=''), INVALID, 'frame'),
            (dict(motion=motion, frame=HUGE), INVALID, 'frame_id', '256'),
        ):
            self.assert_refused(self.node.query(asked.pop('organ', 'sheet'), **asked), status, words)
            self.assert_contacts(self.node.query('sheet', shaft(*AXIS, 0.005)), expected)
        previous_is_unused = shaft(*AXIS, 0.005, ((NAN,) * 3, (NAN,) * 3))
        self.assert_contacts(self.node.query('sheet', previous_is_unused), expected)

    def test_refusals_of_batches(self):
        """max_batch is 30, and max_batch_bytes 100 000."""
        motion, through_all = shaft(*AXIS, 0.005), shaft((0.0, 0.0, 0.1), (0.0, 0.0, -0.1), 0.2)
        fit = 100000 // size(self.node.query('sheet', through_all))
        self.assertIn(fit, range(5, 30))
        for asked, status, *words in (
            (dict(motions=[motion] * 31), INVALID, '31 motions', '30', 'max_batch'),
            (dict(motions=[through_all] * 30), INVALID, 'first %d of 30' % (fit + 1), '100000', 'max_batch_bytes'),
            (dict(motions=[motion], mode=9), INVALID, '9'),
            (dict(motions=[motion], margin=NAN), INVALID, 'margin is nan', 'finite'),
            (dict(motions=[motion], organ='kidney'), ContactArray.UNKNOWN_ORGAN, 'kidney', 'sheet'),
            (dict(motions=[motion] * 30, organ=HUGE), INVALID, '256'),
            (dict(motions=[motion] * 30, frame='nowhere'), ContactArray.NO_TRANSFORM, 'nowhere'),
        ):
            self.assert_refused(self.node.answer_batch(asked.pop('organ', 'sheet'), **asked), status, words)
        self.assertEqual(len(self.node.query_batch('sheet', [through_all] * fit)), fit)
        self.assertEqual(self.node.query_batch('sheet', []), [])
        # One bad motion leaves the rest of its batch alone.
        results = self.node.query_batch('sheet', [motion, shaft(*AXIS, -0.25), motion])
        self.assertEqual([result.status for result in results], [ContactArray.OK, INVALID, ContactArray.OK])
        self.assertIn('-0.25', results[1].message)
        self.assert_contacts(results[2], oracle.static_contacts(SHEET, AXIS, 0.005))

    def test_a_loop_in_tf_with_long_names(self):
        self.tf.send_resting(('loop_a', 'loop_b', (0, 0, 1)), ('loop_b', 'loop_a', (0, 0, 1)),
                             *[('loop_b', 'x' * 1000 + str(i), (0, 0, 1)) for i in range(500)])
        motion = shaft(*AXIS, 0.005)
        wait_until(lambda: 'loop.' in self.node.query('sheet', motion, frame='loop_a').message, 'the loop')
        for answer in (self.node.query('sheet', motion, frame='loop_a'),
                       self.node.answer_batch('sheet', [motion] * 30, frame='loop_a')):
            self.assert_refused(answer, ContactArray.NO_TRANSFORM, ['loop.'])


if __name__ == '__main__':
    rospy.init_node('query_test')
    rostest.rosrun('organ_collision', 'query', QueryTest, sys.argv)
