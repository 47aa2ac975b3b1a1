#!/usr/bin/python3
"""The scenes of the 1999 paper: a tool touches 5 to 25 faces of a liver of 1224 faces, and 0 to 3
faces of a tetrahedron. Both pickers give exact contacts, and the faces of the paper's own modes."""

import random
import sys

from organ_collision.msg import ContactArray
import rospy
import rostest

from support import oracle, paper_oracle, scenes
from support.contact_case import ContactCase
from support.node_client import NodeClient, shaft
from support.vectors import lerp, scaled, unit

STATIC, SWEPT = ContactArray.STATIC, ContactArray.SWEPT
PAPER_STATIC, PAPER_SWEPT = ContactArray.PAPER_STATIC, ContactArray.PAPER_SWEPT
PAPER_NAIVE = ContactArray.PAPER_NAIVE


class PaperScenesTest(ContactCase):
    @classmethod
    def setUpClass(cls):
        cls.nodes = [NodeClient('/feedback'), NodeClient('/select')]
        cls.meshes = {'liver': scenes.liver(), 'tetrahedron': scenes.tetrahedron(0.1)}
        for node in cls.nodes:
            for organ, mesh in cls.meshes.items():
                node.send_mesh(organ, mesh, rospy.Time(1))
                node.wait_for_shape(organ, rospy.Time(1))

    def check(self, organ, motions, radius, mode=SWEPT):
        """Checks every motion (previous axis, axis) with both pickers. Returns how many faces each
        motion touches."""
        counts = []
        expected = [
            oracle.contacts(self.meshes[organ], self.meshes[organ], motion, radius)
            for motion in motions
        ]
        messages = [shaft(*now, radius, previous=previous) for previous, now in motions]
        for node in self.nodes:
            results = node.query_batch(organ, messages, mode)
            for result, right in zip(results, expected):
                self.assert_contacts(result, right, 1e-6)
            counts = [len(right) for right in expected]
        return counts

    def test_the_liver_is_palpated(self):
        """Static queries with the tip just in or on the surface."""
        rng, trocar = random.Random(31), (0.05, 0.02, 0.25)
        liver = self.meshes['liver']
        tips = [
            oracle.weighted(liver.face(rng.randrange(1224)), (0.3, 0.3, 0.4)) for _ in range(60)
        ]
        tips = [
            (x + rng.uniform(-0.003, 0.003), y + rng.uniform(-0.003, 0.003), z)
            for x, y, z in tips
            if z > 0.005
        ]
        counts = self.check(
            'liver', [((trocar, tip), (trocar, tip)) for tip in tips], 0.005, STATIC
        )
        self.assertGreater(sum(5 <= n <= 25 for n in counts), len(counts) / 2)

    def test_the_liver_is_swept(self):
        rng, trocar = random.Random(32), (0.05, 0.02, 0.25)

        def tip():
            return (rng.uniform(-0.03, 0.1), rng.uniform(-0.03, 0.03), rng.uniform(0.0, 0.05))

        motions = []
        for _ in range(25):
            start, towards = tip(), tip()
            motions.append(((trocar, start), (trocar, lerp(start, towards, 0.3))))
        counts = self.check('liver', motions, 0.005)
        self.assertGreater(sum(5 <= n <= 25 for n in counts), 3)

    def test_the_tetrahedron(self):
        rng = random.Random(33)

        def point(reach):
            return tuple(rng.uniform(-reach, reach) for _ in range(3))

        motions = []
        for _ in range(150):
            trocar = scaled(unit(point(1.0)), 0.2)
            motions.append(((trocar, point(0.08)), (trocar, point(0.08))))
        swept = self.check('tetrahedron', motions, 0.003)
        static = self.check('tetrahedron', [(m[1], m[1]) for m in motions], 0.003, STATIC)
        self.assertLessEqual({0, 1, 2, 3}, set(swept))
        self.assertLessEqual({0, 1, 2}, set(static))

    def check_paper(self, organ, message, mode, volume):
        """Checks the faces of the paper's volume and their depth ranges. Because of 32-bit
        clipping, a face may be in the answer or not if growing or shrinking the volume by 1e-5 m
        decides it."""
        mesh = self.meshes[organ]
        grown, shrunk = ([(n, d + margin) for n, d in volume] for margin in (1e-5, -1e-5))
        certain, possible = set(paper_oracle.picked(mesh, shrunk)), set(
            paper_oracle.picked(mesh, grown)
        )
        ranges = paper_oracle.picked(mesh, volume)
        for node in self.nodes:
            result = node.query(organ, message, mode)
            self.assert_ok(result)
            self.assertEqual(result.mode, mode)
            found = [c.face for c in result.contacts]
            self.assertEqual(found, sorted(set(found)))
            self.assertLessEqual(certain, set(found))
            self.assertLessEqual(set(found), possible)
            for contact in result.contacts:
                self.assertEqual((contact.fraction, contact.depth, contact.shaft), (0, 0, 0))
                self.assertEqual(contact.barycentric, (0, 0, 0))
                if contact.face in certain:
                    low, high = ranges[contact.face]
                    self.assertAlmostEqual(contact.view_min, low, delta=2e-4)
                    self.assertAlmostEqual(contact.view_max, high, delta=2e-4)
        return len(certain)

    def test_the_papers_own_volumes(self):
        rng, faces = random.Random(34), 0
        for organ, number in (('liver', 8), ('tetrahedron', 25)):
            for _ in range(number):
                trocar = (rng.uniform(0.0, 0.06), rng.uniform(-0.02, 0.03), rng.uniform(0.15, 0.25))
                previous, tip = [
                    (rng.uniform(-0.04, 0.09), rng.uniform(-0.03, 0.03), rng.uniform(-0.01, 0.04))
                    for _ in range(2)
                ]
                motion = shaft(trocar, tip, 0.005, previous=(trocar, previous))
                faces += self.check_paper(
                    organ, motion, PAPER_STATIC, paper_oracle.static_volume((trocar, tip), 0.005)
                )
                volume = paper_oracle.swept_volume(trocar, previous, tip, 0.005)
                faces += self.check_paper(organ, motion, PAPER_SWEPT, volume)
                faces += self.check_paper(organ, motion, PAPER_NAIVE, volume)
        self.assertGreater(faces, 500)

    def test_every_face_at_once(self):
        """In every mode, the buffers are large enough for all 1224 faces."""
        trocar, previous, tip = (0.05, 0.02, 0.3), (0.02, 0.0, -0.1), (0.08, 0.01, -0.12)
        for node in self.nodes:
            for mode in range(5):
                motion = shaft(trocar, tip, 2.0, previous=(trocar, previous))
                result = node.query('liver', motion, mode, regions=mode == SWEPT)
                self.assert_ok(result)
                self.assertEqual([c.face for c in result.contacts], list(range(1224)))

    def test_a_ball_has_no_paper_volume(self):
        point = (0.01, 0.02, 0.03)
        for node in self.nodes:
            for mode in (PAPER_STATIC, PAPER_SWEPT, PAPER_NAIVE):
                result = node.query('liver', shaft(point, point, 0.005, (point, point)), mode)
                self.assertEqual(
                    (result.status, result.contacts), (ContactArray.INVALID_REQUEST, [])
                )
                self.assertNotEqual(result.message, '')


if __name__ == '__main__':
    rospy.init_node('paper_scenes_test')
    rostest.rosrun('organ_collision', 'paper_scenes', PaperScenesTest, sys.argv)
