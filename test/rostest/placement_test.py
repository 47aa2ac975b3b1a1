#!/usr/bin/python3
"""On which side of an organ a tool is, where its axis pierces the organ, and how long it is inside,
compared with winding numbers and crossings that are computed naively from all faces."""

import random
import sys

from organ_collision.msg import ContactArray, ToolPlacement
import rospy
import rostest

from support import scenes, side_oracle
from support.contact_case import xyz
from support.contract import KeepsContract
from support.link_case import LinkCase
from support.node_client import shaft, wait_until

UNKNOWN, OUTSIDE = ToolPlacement.UNKNOWN, ToolPlacement.OUTSIDE
INSIDE, ON_SURFACE = ToolPlacement.INSIDE, ToolPlacement.ON_SURFACE
RADIUS = 0.002
OUT_OF_ALL = (0.3, 0.31, 0.32)


def turned(mesh):
    """The same surface with its faces pointing to the other side."""
    return scenes.Mesh(mesh.vertices, [(a, c, b) for a, b, c in mesh.faces])


def together(first, second):
    count = len(first.vertices)
    faces = [tuple(i + count for i in face) for face in second.faces]
    return scenes.Mesh(first.vertices + second.vertices, first.faces + faces)


def scaled(mesh, factor):
    return mesh.moved(lambda v: tuple(factor * c for c in v))


TETRAHEDRON = scenes.tetrahedron()
# A box in which a smaller one is a cavity, and beside it an organ whose faces point inward.
WITH_CAVITY = together(
    scaled(scenes.box(), 1.7), turned(scaled(scenes.box(), 0.9))
)
TWO_PARTS = together(
    WITH_CAVITY, turned(scenes.tetrahedron(0.05).moved(lambda v: (v[0] + 0.12, v[1], v[2])))
)
ORGANS = {
    'tetrahedron': TETRAHEDRON,
    'inward': turned(TETRAHEDRON),
    'liver': scenes.liver(),
    'two_parts': TWO_PARTS,
}
OPEN = scenes.Mesh(TETRAHEDRON.vertices, TETRAHEDRON.faces[:3])
CENTRE = (0.0013, -0.0021, 0.0017)  # [m] inside the tetrahedron


class PlacementTest(KeepsContract, LinkCase):
    link_frames = {
        'ball': ('ball',),
        'tipped': ('ball', 'tipped_tip'),
        'tipless': ('ball',),
    }

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.rng = random.Random(41)
        for name, mesh in [*ORGANS.items(), ('open', OPEN)]:
            cls.node.send_mesh(name, mesh, rospy.Time(7))
            cls.node.wait_for_shape(name, rospy.Time(7))

    def random_point(self, size=0.04):
        return tuple(self.rng.uniform(-size, size) for _ in range(3))

    def placement(self, organ, axis, **asked):
        result = self.node.query(organ, shaft(*axis, RADIUS), placement=True, **asked)
        self.assert_ok(result)
        return result.placement

    def placement_when_inspected(self, organ, axis):
        """The placement once the node knows whether the surface is closed. Queries wait for it, but
        not for ever, and the machine may be busy."""
        wait_until(lambda: self.placement(organ, axis).tip != UNKNOWN, 'sides of ' + organ)
        return self.placement(organ, axis)

    def side(self, mesh, point):
        return INSIDE if side_oracle.winding_number(mesh, point) else OUTSIDE

    def assert_crossings(self, placement, mesh, axis):
        expected = side_oracle.crossings(mesh, axis)
        found = placement.crossings
        self.assertEqual(
            [(c.face, c.direction) for c in found], [(c.face, c.direction) for c in expected]
        )
        for crossing, right in zip(found, expected):
            self.assertEqual(crossing.vertices, mesh.faces[crossing.face])
            self.assertAlmostEqual(crossing.shaft, right.shaft, delta=1e-9)
            self.assert_near(xyz(crossing.point), right.point, 1e-9, 'point')
            self.assert_near(crossing.barycentric, right.barycentric, 1e-6, 'barycentric')

    def assert_placement(self, placement, mesh, axis):
        self.assertEqual(placement.trocar, self.side(mesh, axis[0]))
        self.assertEqual(placement.tip, self.side(mesh, axis[1]))
        self.assert_crossings(placement, mesh, axis)
        self.assertTrue(placement.length_known)
        inside = side_oracle.length_inside(mesh, axis)
        self.assertAlmostEqual(placement.length_inside, inside, delta=1e-9)

    def test_nothing_is_told_unless_it_is_asked_for(self):
        result = self.node.query('tetrahedron', shaft(OUT_OF_ALL, CENTRE, RADIUS))
        self.assert_ok(result)
        self.assertEqual(result.placement, ToolPlacement())

    def test_random_shafts(self):
        for organ, mesh in ORGANS.items():
            sides = set()
            self.placement_when_inspected(organ, (OUT_OF_ALL, CENTRE))
            for _ in range(12):
                axis = (self.random_point(), self.random_point())
                placement = self.placement(organ, axis)
                self.assert_placement(placement, mesh, axis)
                sides |= {placement.trocar, placement.tip}
            self.assertEqual(sides, {INSIDE, OUTSIDE}, organ)

    def test_a_tool_that_touches_nothing_may_be_inside(self):
        axis = (CENTRE, (0.002, 0.001, -0.002))
        result = self.node.query('tetrahedron', shaft(*axis, RADIUS), placement=True)
        self.assertEqual(result.contacts, [])
        placement = self.placement_when_inspected('tetrahedron', axis)
        self.assertEqual((placement.tip, placement.trocar), (INSIDE, INSIDE))
        self.assert_placement(placement, TETRAHEDRON, axis)

    def test_a_cavity_is_outside(self):
        self.placement_when_inspected('two_parts', (OUT_OF_ALL, CENTRE))
        placement = self.placement('two_parts', (OUT_OF_ALL, CENTRE))
        self.assertEqual((placement.trocar, placement.tip), (OUTSIDE, OUTSIDE))
        self.assertEqual([c.direction for c in placement.crossings], [1, -1])
        self.assert_placement(placement, TWO_PARTS, (OUT_OF_ALL, CENTRE))

    def test_faces_that_point_inward_reverse_directions_but_not_sides(self):
        axis = (OUT_OF_ALL, CENTRE)
        outward = self.placement_when_inspected('tetrahedron', axis)
        inward = self.placement_when_inspected('inward', axis)
        self.assertEqual((outward.tip, inward.tip), (INSIDE, INSIDE))
        self.assertEqual([c.direction for c in outward.crossings], [1])
        self.assertEqual([c.direction for c in inward.crossings], [-1])
        self.assertEqual(outward.length_inside, inward.length_inside)

    def test_a_tip_at_a_vertex_is_on_the_surface(self):
        axis = (OUT_OF_ALL, TETRAHEDRON.vertices[2])
        placement = self.placement_when_inspected('tetrahedron', axis)
        self.assertEqual((placement.tip, placement.trocar), (ON_SURFACE, OUTSIDE))

    def test_an_open_surface_has_crossings_but_no_sides(self):
        wait_until(
            lambda: self.node.diagnostics.get('open, surface', '').startswith('open'),
            lambda: self.node.diagnostics,
        )
        for _ in range(12):
            axis = (self.random_point(), self.random_point(0.06))
            placement = self.placement('open', axis)
            self.assertEqual((placement.tip, placement.trocar), (UNKNOWN, UNKNOWN))
            self.assertEqual((placement.length_known, placement.length_inside), (False, 0.0))
            self.assert_crossings(placement, OPEN, axis)

    def test_a_batch(self):
        self.placement_when_inspected('liver', (OUT_OF_ALL, CENTRE))
        axes = [(self.random_point(), self.random_point()) for _ in range(10)]
        motions = [shaft(*axis, RADIUS) for axis in axes]
        results = self.node.query_batch('liver', motions, placement=True)
        for result, axis in zip(results, axes):
            self.assert_placement(result.placement, ORGANS['liver'], axis)
        plain = self.node.query_batch('liver', motions)
        self.assertEqual([r.placement for r in plain], [ToolPlacement()] * len(axes))

    def test_a_swept_query_is_placed_at_its_end(self):
        end = (OUT_OF_ALL, CENTRE)
        start = (OUT_OF_ALL, (0.2, 0.1, 0.1))
        self.placement_when_inspected('tetrahedron', end)
        for previous, now in ((start, end), (end, start)):
            motion = shaft(*now, RADIUS, previous=previous)
            result = self.node.query('tetrahedron', motion, ContactArray.SWEPT, placement=True)
            self.assert_placement(result.placement, TETRAHEDRON, now)

    def step_when_inspected(self, tool, axis):
        """The answer to a step of a tool against the tetrahedron, once the node knows its sides."""

        def answer():
            answers[:] = [self.step(TETRAHEDRON, {tool: axis}, vertices=len(answers) > 0)[tool]]
            return answers[0].placement.tip != UNKNOWN

        answers = []
        wait_until(answer, 'sides in steps')
        return answers[0]

    def test_steps_of_a_shaft(self):
        axis = (OUT_OF_ALL, CENTRE)
        answer = self.step_when_inspected('probe', axis)
        self.assert_placement(answer.placement, TETRAHEDRON, axis)
        out = (OUT_OF_ALL, (0.2, 0.1, 0.1))
        moved = self.step(TETRAHEDRON, {'probe': out}, vertices=True)['probe']
        self.assert_placement(moved.placement, TETRAHEDRON, out)

    def test_new_triangles_never_meet_the_sides_of_old_ones(self):
        """The organ gets more and fewer triangles, and is open at times."""
        axis = (OUT_OF_ALL, CENTRE)
        for topology, mesh in enumerate([TETRAHEDRON, ORGANS['liver'], OPEN, TWO_PARTS] * 3, 1):
            answer = self.step(mesh, {'probe': axis}, topology=topology)['probe']
            self.assert_ok(answer)
            self.assert_crossings(answer.placement, mesh, axis)
            sides = {UNKNOWN} if mesh is OPEN else {UNKNOWN, self.side(mesh, CENTRE)}
            self.assertIn(answer.placement.tip, sides)
            placement = self.placement(self.organ, axis)
            self.assertIn(placement.tip, sides)
            self.assert_crossings(placement, mesh, axis)

    def test_the_tip_of_links(self):
        ball, tip = (0.4, 0.1, 0.2), CENTRE
        answer = self.step_when_inspected('tipped', (ball, tip))
        self.assertEqual((answer.placement.tip, answer.placement.trocar), (INSIDE, UNKNOWN))
        self.assertEqual((answer.placement.crossings, answer.placement.length_known), ([], False))
        moved = self.step(TETRAHEDRON, {'tipped': (tip, ball)}, vertices=True)['tipped']
        self.assertEqual(moved.placement.tip, OUTSIDE)
        asked = self.node.query(self.organ, tool='tipped', placement=True)
        self.assertEqual(asked.placement.tip, OUTSIDE)
        without = self.node.query(self.organ, tool='ball', placement=True)
        self.assert_ok(without)
        self.assertEqual(without.placement, ToolPlacement())

    def test_a_tip_without_transform_is_told(self):
        self.place_and_wait('ball', (CENTRE,), self.next_stamp())
        self.node.send_mesh(self.organ, TETRAHEDRON, self.stamp)
        published = self.node.contacts.wait_for(self.organ, 'tipless', mesh_stamp=self.stamp)
        for answer in (published, self.node.query(self.organ, tool='tipless', placement=True)):
            self.assertEqual(answer.status, ContactArray.NO_TRANSFORM)
            self.assertIn("tip of tool 'tipless': frame 'nowhere' is unknown", answer.message)


if __name__ == '__main__':
    rospy.init_node('placement_test')
    rostest.rosrun('organ_collision', 'placement', PlacementTest, sys.argv)
