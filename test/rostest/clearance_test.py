#!/usr/bin/python3
"""The clearance between tools and organs, and near faces, compared with distances that are computed
naively for each face."""

import random
import sys

from organ_collision.msg import Clearance, ContactArray
import rospy
import rostest

from support import clearance_oracle, oracle, scenes
from support.contact_case import faces_of, xyz
from support.contract import KeepsContract
from support.node_client import shaft
from support.tool_case import ToolCase
from support.vectors import length, lerp, scaled, sub

STATIC, SWEPT = ContactArray.STATIC, ContactArray.SWEPT
NOT_ASKED, BEYOND_MARGIN, KNOWN = Clearance.NOT_ASKED, Clearance.BEYOND_MARGIN, Clearance.KNOWN
SHEET = scenes.sheet(0.1, 3).moved(
    lambda v: (v[0], v[1], v[2] + 0.1 * v[0] - 0.05 * v[1] + 3 * v[0] * v[1])
)
LIVER = scenes.liver()
RADIUS = 0.004
LEAST = 2e-6  # [m] tolerance of least distances, and of the oracle's
ABOVE = ((0.02, -0.03, 0.3), (0.011, 0.006, 0.02))
BELOW = ((0.02, -0.03, 0.3), (0.004, -0.003, -0.04))
FAR = ((0.3, 0.3, 0.3), (0.25, 0.3, 0.2))


class ClearanceTest(KeepsContract, ToolCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        for name, mesh in (('sheet', SHEET), ('liver', LIVER)):
            cls.node.send_mesh(name, mesh, rospy.Time(7))
            cls.node.wait_for_shape(name, rospy.Time(7))
        cls.rng = random.Random(31)

    def random_axis(self, low=0.02):
        def point(lowest, highest):
            x, y = self.rng.uniform(-0.08, 0.08), self.rng.uniform(-0.08, 0.08)
            return (x, y, self.rng.uniform(lowest, highest))

        return (point(0.05, 0.2), point(low, 0.1))

    def assert_nearest_points(self, clearance, mesh, axis):
        """Checks points, normal and place on the face against each other, the face and the axis."""
        self.assertTrue(clearance.normal_defined)
        self.assertFalse(clearance.unresolved)
        normal, on_organ = xyz(clearance.normal), xyz(clearance.on_organ)
        self.assertAlmostEqual(length(normal), 1.0, delta=1e-9)
        way = sub(on_organ, xyz(clearance.on_tool))
        self.assert_near(way, scaled(normal, clearance.distance), 1e-9, 'on_organ - on_tool')
        self.assertEqual(clearance.vertices, mesh.faces[clearance.face])
        on_face = oracle.weighted(mesh.face(clearance.face), clearance.barycentric)
        self.assert_near(on_organ, on_face, 1e-9, 'on_organ')
        on_axis = sub(on_organ, scaled(normal, clearance.distance + RADIUS))
        place = oracle.place_on_segment(on_axis, *axis)
        self.assert_near(on_axis, lerp(*axis, place), 1e-8, 'the point of the axis')

    def assert_known(self, clearance, mesh, axis, margin=0.0):
        """Checks the clearance at the end of a step, where the axis does not pierce the mesh."""
        self.assertEqual((clearance.state, clearance.margin), (KNOWN, margin))
        self.assertEqual(clearance.unlimited, margin == 0.0)
        distances = clearance_oracle.distances(mesh, axis, RADIUS)
        self.assertAlmostEqual(clearance.distance, min(distances), delta=1e-9)
        self.assertAlmostEqual(distances[clearance.face], min(distances), delta=1e-9)
        self.assertEqual(clearance.link, 0)
        self.assert_nearest_points(clearance, mesh, axis)

    def assert_near_faces(self, result, least, margin):
        """Checks all near faces. `least`: the least distance of each face during the step."""
        near = {face: d for face, d in enumerate(least) if 0 < d <= margin}
        found = {contact.face: -contact.depth for contact in result.near}
        self.assertEqual(len(found), len(result.near))
        for face in set(near) ^ set(found):  # Only rounding may decide differently.
            self.assertLess(min(abs(least[face]), abs(least[face] - margin)), LEAST, face)
        for face, distance in found.items():
            self.assertAlmostEqual(distance, least[face], delta=LEAST, msg=face)
        depths = [contact.depth for contact in result.near]
        self.assertEqual(depths, sorted(depths, reverse=True))
        self.assertEqual(set(found) & set(faces_of(result)), set())
        self.assertEqual((result.near_left_out, result.near_unresolved), (0, 0))

    def test_nothing_is_measured_unless_it_is_asked_for(self):
        result = self.node.query('sheet', shaft(*ABOVE, RADIUS))
        self.assert_ok(result)
        self.assertEqual((result.clearance, result.near), (Clearance(), []))

    def test_static_clearance(self):
        """Without limit, and up to a margin that most poses are within."""
        states = []
        for i in range(40):
            name, mesh = ('liver', LIVER) if i % 10 == 0 else ('sheet', SHEET)
            axis = self.random_axis()
            motion = shaft(*axis, RADIUS)
            distances = clearance_oracle.distances(mesh, axis, RADIUS)
            if min(distances) < -0.9 * RADIUS:
                continue
            unlimited = self.node.query(name, motion, clearance=True)
            self.assert_ok(unlimited)
            self.assert_known(unlimited.clearance, mesh, axis)
            self.assertEqual(unlimited.clearance.least, unlimited.clearance.distance)
            margin = self.rng.choice([0.01, 0.03, 0.06])
            limited = self.node.query(name, motion, margin=margin, max_near=10000)
            states.append(limited.clearance.state)
            if min(distances) > margin:
                expected = Clearance(state=BEYOND_MARGIN, margin=margin)
                self.assertEqual((limited.clearance, limited.near), (expected, []))
            else:
                self.assert_known(limited.clearance, mesh, axis, margin)
                self.assert_near_faces(limited, distances, margin)
        self.assertGreater(min(states.count(BEYOND_MARGIN), states.count(KNOWN)), 5)

    def test_swept_clearance(self):
        """The least distance, and near faces at their closest approach. Trocars rest or move."""
        margin, passed, touched = 0.03, 0, 0
        for i in range(20):
            lowest = self.rng.choice([-0.05, 0.035])
            previous, now = self.random_axis(lowest), self.random_axis(lowest)
            if i % 2:
                previous = (now[0], previous[1])
            motion = (previous, now)
            distances = clearance_oracle.distances(SHEET, now, RADIUS)
            least = clearance_oracle.least_distances(SHEET, motion, RADIUS)
            result = self.node.query(
                'sheet',
                shaft(*now, RADIUS, previous=previous),
                SWEPT,
                clearance=True,
                margin=margin,
                max_near=100,
            )
            self.assert_ok(result)
            self.assert_near_faces(result, least, margin)
            clearance = result.clearance
            self.assertEqual((clearance.state, clearance.unlimited), (KNOWN, True))
            self.assertAlmostEqual(clearance.distance, min(distances), delta=1e-9)
            if result.contacts:
                touched += 1
                self.assertEqual(clearance.least, 0.0)
                first = min(contact.fraction for contact in result.contacts)
                self.assertEqual(clearance.least_fraction, first)
            else:
                passed += clearance.least < clearance.distance - 1e-4
                self.assertAlmostEqual(clearance.least, min(least), delta=LEAST)
                then = tuple(lerp(a, b, clearance.least_fraction) for a, b in zip(*motion))
                at_that_time = min(clearance_oracle.distances(SHEET, then, RADIUS))
                self.assertAlmostEqual(clearance.least, at_that_time, delta=LEAST)
        self.assertGreater(min(passed, touched), 1)

    def test_a_touching_shaft_is_as_far_as_its_distance_says(self):
        axis = (ABOVE[0], (0.011, 0.006, 0.0035))
        result = self.node.query('sheet', shaft(*axis, RADIUS), margin=0.02, max_near=100)
        self.assertGreater(len(result.contacts), 0)
        deepest = max(contact.depth for contact in result.contacts)
        self.assertAlmostEqual(result.clearance.distance, -deepest, delta=1e-9)
        self.assertEqual(result.clearance.least, result.clearance.distance)
        self.assert_known(result.clearance, SHEET, axis, 0.02)
        self.assert_near_faces(result, clearance_oracle.distances(SHEET, axis, RADIUS), 0.02)

    def test_the_clearance_has_no_memory_but_the_contacts_have(self):
        end = ((0.011, 0.004, -0.03), (0.013, -0.002, -0.29))
        begin = ((0.011, 0.004, 0.3), (0.013, -0.002, 0.04))
        motion = shaft(*end, RADIUS, previous=begin)
        result = self.node.query('sheet', motion, SWEPT, clearance=True)
        self.assertGreater(len(result.contacts), 0)
        self.assertGreater(result.clearance.distance, 0.01)
        self.assertEqual(result.clearance.least, 0.0)
        self.assert_known(result.clearance, SHEET, end)

    def test_only_the_nearest_faces_are_listed(self):
        axis = ((0.03, 0.02, 0.2), (0.011, 0.006, 0.06))
        every = self.node.query('liver', shaft(*axis, RADIUS), margin=0.05, max_near=10000)
        self.assertGreater(len(every.near), 20)
        for most in (1, 7, len(every.near) - 1, len(every.near)):
            some = self.node.query('liver', shaft(*axis, RADIUS), margin=0.05, max_near=most)
            self.assertEqual(some.near, every.near[:most])
            self.assertEqual(some.near_left_out, len(every.near) - most)

    def test_a_margin_larger_than_the_organ(self):
        for margin in (1.0, 1e3, 1e9, 1e300):
            result = self.node.query('sheet', shaft(*FAR, RADIUS), margin=margin, max_near=1000)
            self.assert_ok(result)
            self.assert_known(result.clearance, SHEET, FAR, margin)
            self.assertEqual(len(result.near), len(SHEET.faces))

    def test_a_batch(self):
        axes = [self.random_axis(0.03) for _ in range(8)] + [FAR]
        motions = [shaft(*axis, RADIUS) for axis in axes]
        for result, axis in zip(self.node.query_batch('sheet', motions, clearance=True), axes):
            self.assert_known(result.clearance, SHEET, axis)
        limited = self.node.query_batch('sheet', motions, margin=0.1)
        for result, axis in zip(limited[:-1], axes):
            self.assert_known(result.clearance, SHEET, axis, 0.1)
        self.assertEqual(limited[-1].clearance.state, BEYOND_MARGIN)
        self.assertEqual([result.near for result in limited], [[]] * len(axes))

    def test_bad_margins_are_refused_with_their_value(self):
        motion = shaft(*ABOVE, RADIUS)
        for margin, word in ((-1.0, '-1'), (float('nan'), 'nan'), (float('inf'), 'inf')):
            batch = self.node.answer_batch('sheet', [motion], margin=margin)
            for refused in (self.node.query('sheet', motion, margin=margin), batch):
                self.assertEqual(refused.status, ContactArray.INVALID_REQUEST)
                for text in ('margin is ' + word, 'positive', 'finite'):
                    self.assertIn(text, refused.message)
            self.assertEqual(batch.results, [])
        refused = self.node.query('sheet', motion, max_near=3, clearance=True)
        self.assertEqual(refused.status, ContactArray.INVALID_REQUEST)
        self.assertIn('max_near is 3', refused.message)

    def test_the_papers_modes_refuse(self):
        motion = shaft(*BELOW, RADIUS, previous=ABOVE)
        for mode in (
            ContactArray.PAPER_STATIC,
            ContactArray.PAPER_SWEPT,
            ContactArray.PAPER_NAIVE,
        ):
            self.assert_ok(self.node.query('sheet', motion, mode))
            for asked in ({'margin': 0.01}, {'clearance': True}, {'placement': True}):
                refused = self.node.query('sheet', motion, mode, **asked)
                self.assertEqual(refused.status, ContactArray.INVALID_REQUEST)
                self.assertIn('mode is %d' % mode, refused.message)

    def test_steps_of_a_tool_with_a_margin(self):
        near = ((0.02, -0.03, 0.3), (0.011, 0.006, 0.01))
        first = self.step(SHEET, {'probe': ABOVE, 'blind': ABOVE})
        self.assertEqual((first['blind'].clearance, first['blind'].near), (Clearance(), []))
        self.assert_known(first['probe'].clearance, SHEET, ABOVE, 0.03)
        self.step(SHEET, {'probe': near, 'blind': near}, vertices=True)
        swept = self.step(SHEET, {'probe': ABOVE, 'blind': ABOVE}, vertices=True)['probe']
        self.assert_known(swept.clearance, SHEET, ABOVE, 0.03)
        least = min(clearance_oracle.distances(SHEET, near, RADIUS))
        self.assertAlmostEqual(swept.clearance.least, least, delta=LEAST)
        self.assertAlmostEqual(swept.clearance.least_fraction, 0.0, delta=1e-3)
        self.assertEqual(len(swept.near), 5)
        self.assertGreater(swept.near_left_out, 0)
        far = self.step(SHEET, {'probe': FAR, 'blind': FAR}, vertices=True)['probe']
        self.assertEqual(far.clearance, Clearance(state=BEYOND_MARGIN, margin=0.03))

    def test_a_step_through_the_sheet(self):
        self.step(SHEET, {'probe': ABOVE, 'blind': ABOVE})
        swept = self.step(SHEET, {'probe': BELOW, 'blind': BELOW}, vertices=True)
        self.assertGreater(len(swept['probe'].contacts), 0)
        self.assertEqual(swept['probe'].contacts, swept['blind'].contacts)
        self.assertEqual(swept['probe'].clearance.least, 0.0)


if __name__ == '__main__':
    rospy.init_node('clearance_test')
    rostest.rosrun('organ_collision', 'clearance', ClearanceTest, sys.argv)
