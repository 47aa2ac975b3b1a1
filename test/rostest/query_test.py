#!/usr/bin/python3
"""The services `query` and `query_batch`, on geometry whose contacts are known."""

import random
import sys

from organ_collision.msg import ContactArray
import rospy
import rostest

from support import oracle, scenes
from support.contact_case import ContactCase, faces_of, xyz
from support.node_client import NodeClient, shaft
from support.vectors import add, length, scaled, sub

STATIC, SWEPT = ContactArray.STATIC, ContactArray.SWEPT


class QueryTest(ContactCase):
    @classmethod
    def setUpClass(cls):
        cls.node = NodeClient()
        cls.sheet = scenes.sheet(0.1, 5).moved(
            lambda v: (v[0], v[1], v[2] + 0.1 * v[0] - 0.05 * v[1])
        )
        cls.node.send_mesh('sheet', cls.sheet, rospy.Time(7, 5))
        cls.node.wait_for_shape('sheet', rospy.Time(7, 5))

    def test_one_face_every_field_by_hand(self):
        """The tip is 4 mm above a horizontal face and its radius is 5 mm, so it is 1 mm deep."""
        self.node.send_mesh('plate', scenes.one_face(0.25), rospy.Time(3, 4), topology=17)
        self.node.wait_for_shape('plate', rospy.Time(3, 4), topology=17)
        result = self.node.query('plate', shaft((0.01, 0.02, 0.5), (0.01, 0.02, 0.254), 0.005))
        self.assert_ok(result)
        self.assertEqual(
            (result.header.frame_id, result.organ, result.topology, result.mesh_stamp),
            ('liver_frame', 'plate', 17, rospy.Time(3, 4)),
        )
        self.assertEqual(
            (result.tool, result.links, result.mode, result.regions), ('', [''], STATIC, [])
        )
        self.assertEqual(result.step_start, result.header.stamp)
        (contact,) = result.contacts
        self.assertEqual(
            (contact.face, contact.link, contact.fraction, contact.behind), (0, 0, 0.0, False)
        )
        self.assert_near(xyz(contact.point), (0.01, 0.02, 0.25), 1e-9, 'point')
        self.assert_near(xyz(contact.normal), (0, 0, -1), 1e-9, 'normal')
        self.assertAlmostEqual(contact.shaft, 1.0, delta=1e-12)
        self.assertAlmostEqual(contact.depth, 0.001, delta=1e-9)

    def test_static_contacts_of_a_slanted_sheet(self):
        rng = random.Random(20)
        touched = 0
        for _ in range(60):
            trocar = [rng.uniform(-0.08, 0.08), rng.uniform(-0.08, 0.08), rng.uniform(0.02, 0.2)]
            tip = [rng.uniform(-0.06, 0.06), rng.uniform(-0.06, 0.06), rng.uniform(-0.05, 0.03)]
            axis, radius = (tuple(trocar), tuple(tip)), rng.choice([0.0015, 0.005, 0.012])
            expected = oracle.static_contacts(self.sheet, axis, radius)
            self.assert_contacts(self.node.query('sheet', shaft(*axis, radius)), expected)
            touched += len(expected)
        self.assertGreater(touched, 100)

    def test_a_step_through_the_sheet_that_static_queries_miss(self):
        above = ((0.011, 0.004, 0.3), (0.013, -0.002, 0.04))
        below = ((0.011, 0.004, -0.03), (0.013, -0.002, -0.29))
        previous, now = ((0.2, 0.1, 0.05), (0.01, 0.002, 0.06)), (
            (0.2, 0.1, 0.05),
            (0.003, 0.011, -0.04),
        )
        self.assert_contacts(self.node.query('sheet', shaft(*above, 0.005)), [])
        self.assert_contacts(self.node.query('sheet', shaft(*below, 0.005)), [])
        swept = self.node.query('sheet', shaft(*below, 0.005, previous=above), SWEPT)
        self.assert_contacts(swept, oracle.swept_contacts(self.sheet, above, below, 0.005))
        self.assertGreater(len(swept.contacts), 0)
        lever = self.node.query('sheet', shaft(*now, 0.004, previous=previous), SWEPT)
        self.assert_contacts(lever, oracle.swept_contacts(self.sheet, previous, now, 0.004))
        self.assertGreater(len(lever.contacts), 2)

    def test_swept_contacts_with_fixed_and_moving_trocars(self):
        rng = random.Random(21)

        def point(low, high):
            return (rng.uniform(-0.07, 0.07), rng.uniform(-0.07, 0.07), rng.uniform(low, high))

        touched = 0
        for i in range(60):
            trocar = point(0.05, 0.2)
            moved = trocar if i % 2 else point(0.05, 0.2)
            previous, now = (trocar, point(-0.03, 0.06)), (moved, point(-0.03, 0.06))
            radius = rng.choice([0.002, 0.005])
            expected = oracle.swept_contacts(self.sheet, previous, now, radius)
            result = self.node.query('sheet', shaft(*now, radius, previous=previous), SWEPT)
            self.assert_contacts(result, expected, 1e-6)
            touched += len(expected)
        self.assertGreater(touched, 200)

    def test_degenerate_motions(self):
        """No motion, along the axis, tiny, and a tip that swings to the far side of the trocar."""
        trocar, tip = (0.01, 0.013, 0.11), (0.012, 0.004, 0.003)
        axis = sub(tip, trocar)
        for now in (
            tip,
            add(tip, scaled(axis, 0.2)),
            sub(tip, scaled(axis, 0.2)),
            add(tip, (1e-7, 2e-7, -1e-7)),
            sub(trocar, scaled(axis, 0.5)),
            trocar,
        ):
            motion = ((trocar, tip), (trocar, now))
            result = self.node.query('sheet', shaft(*motion[1], 0.005, previous=motion[0]), SWEPT)
            self.assert_contacts(result, oracle.swept_contacts(self.sheet, *motion, 0.005))

    def test_a_ball(self):
        """With the tip at the trocar, the tool is a ball. It rests, or is thrown through the
        sheet."""
        above, inside, below = (0.012, 0.003, 0.03), (0.012, 0.003, 0.004), (0.02, -0.01, -0.03)
        result = self.node.query('sheet', shaft(inside, inside, 0.006))
        self.assert_contacts(result, oracle.static_contacts(self.sheet, (inside, inside), 0.006))
        self.assertGreater(len(result.contacts), 0)
        result = self.node.query(
            'sheet', shaft(below, below, 0.006, previous=(above, above)), SWEPT
        )
        self.assert_contacts(
            result, oracle.swept_contacts(self.sheet, (above, above), (below, below), 0.006)
        )
        self.assertGreater(len(result.contacts), 0)

    def test_degenerate_faces_are_touched_like_others(self):
        """The side of a shaft touches two degenerate faces: a needle and a point."""
        mesh = scenes.Mesh(
            [(0.0, 0.0, 0.0), (0.03, 0.0, 0.0), (0.01, 0.0, 0.0), (0.05, 0.02, 0.0)],
            [(0, 1, 2), (3, 3, 3), (0, 1, 3)],
        )
        self.node.send_mesh('needle', mesh, rospy.Time(1))
        self.node.wait_for_shape('needle', rospy.Time(1))
        result = self.node.query('needle', shaft((0.02, -0.1, 0.003), (0.02, 0.1, 0.003), 0.004))
        self.assertEqual(faces_of(result), [0, 2])
        self.assertAlmostEqual(result.contacts[0].depth, 0.001, delta=1e-8)
        result = self.node.query('needle', shaft((0.05, 0.0, -0.003), (0.05, 0.1, -0.003), 0.004))
        self.assertEqual(faces_of(result), [1, 2])
        # The axis pierces the needle, which has no normal. The contact's normal is still unit.
        result = self.node.query('needle', shaft((0.02, -0.1, 0.0), (0.02, -0.001, 0.0), 0.004))
        for contact in result.contacts:
            self.assertAlmostEqual(length(xyz(contact.normal)), 1.0, delta=1e-9)

    def test_regions_lie_in_face_and_volume(self):
        previous, now = ((0.013, 0.01, 0.2), (0.01, 0.002, 0.05)), (
            (0.013, 0.01, 0.2),
            (0.02, 0.01, -0.05),
        )
        result = self.node.query(
            'sheet', shaft(*now, 0.005, previous=previous), SWEPT, regions=True
        )
        self.assertGreater(len(result.contacts), 0)
        self.assert_regions_lie_on_faces(result, self.sheet)
        self.assertTrue(any(len(region.points) >= 3 for region in result.regions))
        result = self.node.query('sheet', shaft(*now, 0.005), regions=True)
        self.assert_regions_lie_on_faces(result, self.sheet)

    def test_batch_answers_in_the_order_of_its_motions(self):
        rng = random.Random(22)
        trocar = (0.01, 0.02, 0.3)
        tips = [
            (rng.uniform(-0.04, 0.04), rng.uniform(-0.04, 0.04), rng.uniform(-0.02, 0.02))
            for _ in range(25)
        ]
        steps = list(zip(tips, tips[1:] + tips[:1]))
        motions = [shaft(trocar, now, 0.003, previous=(trocar, old)) for old, now in steps]
        results = self.node.query_batch('sheet', motions, SWEPT)
        self.assertEqual(len(results), len(motions))
        for result, (old, now) in zip(results, steps):
            self.assert_contacts(
                result, oracle.swept_contacts(self.sheet, (trocar, old), (trocar, now), 0.003), 1e-6
            )
        self.assertEqual(self.node.query_batch('sheet', []), [])

    def test_one_bad_motion_leaves_the_rest_of_its_batch_alone(self):
        axis = ((0.01, 0.003, 0.3), (0.01, 0.003, 0.004))
        good, bad = shaft(*axis, 0.005), shaft(axis[0], axis[1], -0.25)
        results = self.node.query_batch('sheet', [good, bad, good])
        self.assertEqual(
            [r.status for r in results],
            [ContactArray.OK, ContactArray.INVALID_REQUEST, ContactArray.OK],
        )
        self.assertIn('-0.25', results[1].message)
        for result in (results[0], results[2]):
            self.assert_contacts(result, oracle.static_contacts(self.sheet, axis, 0.005))


if __name__ == '__main__':
    rospy.init_node('query_test')
    rostest.rosrun('organ_collision', 'query', QueryTest, sys.argv)
