#!/usr/bin/python3
"""The contacts that the program prints, compared with the naive oracle's."""

import random
import unittest

from program import ProgramCase, motion_line, motions_text, obj_text
from support import oracle, paper_oracle, scenes
from support.vectors import length, lerp, sub

FILES = ('--mesh', 'organ.obj', '--motions', 'motions.csv')
TOLERANCE = 1e-7  # [m], and as a share of the step


class ContactsTest(ProgramCase):
    def setUp(self):
        super().setUp()
        self.rng = random.Random(41)

    def point(self, reach, z):
        x, y = (self.rng.uniform(-reach, reach) for _ in range(2))
        return (x, y, z + self.rng.uniform(-0.03, 0.03))

    def write_scene(self, mesh, lines):
        self.write('organ.obj', obj_text(mesh))
        self.write('motions.csv', motions_text(lines))

    def assert_row(self, row, query, right):
        """Checks that a row is the oracle's contact."""
        what = 'query %s: %r instead of %r' % (query, row, right)
        self.assertEqual(row[:2], [str(query), str(right.face)], what)
        fraction, depth, *vectors = map(float, row[2:])
        self.assertAlmostEqual(fraction, right.fraction, delta=TOLERANCE, msg=what)
        self.assertAlmostEqual(depth, right.depth, delta=TOLERANCE, msg=what)
        self.assertLessEqual(length(sub(vectors[:3], right.point)), TOLERANCE, what)
        self.assertLessEqual(length(sub(vectors[3:], right.normal)), 100 * TOLERANCE, what)

    def assert_rows(self, rows, expected):
        """`expected`: pairs (query, contacts of the oracle), in the order of the output."""
        flat = [(query, right) for query, contacts in expected for right in contacts]
        self.assertEqual(
            [row[:2] for row in rows], [[str(query), str(c.face)] for query, c in flat]
        )
        for row, (query, right) in zip(rows, flat):
            self.assert_row(row, query, right)

    def test_one_face_by_hand(self):
        """A tip of 5 mm radius, 4 mm above a plate, is 1 mm deep. If it falls from 10 mm to 4 mm,
        it first touches after 5/6 of the step."""
        self.write('organ.obj', 'v -1 -1 0.25\nv 1 -1 0.25\nv 1 1 0.25\nv -1 1 0.25\nf 1 2 3 4\n')
        line = '%s,0.25,-0.5,0.5,0.25,-0.5,0.26,0.25,-0.5,0.254,0.005'
        self.write('motions.csv', motions_text([line % '2,static', line % '1,swept']))
        (_, *swept), (_, *static) = self.contacts(*FILES)
        for row, fraction in (swept, 5 / 6), (static, 0.0):
            self.assertEqual(row[0], '0')
            for cell, right in zip(row[1:], (fraction, 0.001, 0.25, -0.5, 0.25, 0, 0, -1)):
                self.assertAlmostEqual(float(cell), right, delta=1e-8)

    def test_static_and_swept_contacts(self):
        liver, expected, lines = scenes.liver(), [], []
        for query in range(60):
            trocar, radius = self.point(0.05, 0.2), self.rng.choice([0.0005, 0.003, 0.01])
            previous, tip = self.point(0.1, 0.02), self.point(0.1, 0.02)
            mode, start = self.rng.choice([('static', tip), ('swept', lerp(tip, previous, 0.4))])
            lines.append(motion_line(query, mode, trocar, start, tip, radius))
            motion = ((trocar, start), (trocar, tip))
            expected.append((query, oracle.contacts(liver, liver, motion, radius)))
        self.rng.shuffle(lines)
        self.write_scene(liver, lines)
        rows = self.contacts(*FILES)
        self.assertGreater(len(rows), 300)
        self.assert_rows(rows, expected)
        self.assertEqual(rows, self.contacts(*FILES, '--picker', 'select'))
        self.assertEqual(rows, self.contacts(*FILES, '--picker', 'cpu'))
        self.assertEqual(rows, self.contacts(*FILES, '--gl', 'egl'))
        self.assertEqual(rows, self.contacts(*FILES, '--gl', 'osmesa'))
        self.assertEqual(rows, self.contacts(*FILES, '--picker=feedback'))
        self.assertEqual(rows, self.contacts(*FILES, '--mesh-before', 'organ.obj'))

    def test_a_moving_organ(self):
        """Tissue that swings through tools, some of them at rest."""
        before = scenes.sheet(0.1, 6)
        now = before.moved(lambda v: (v[0] + 0.01, v[1], v[2] + 0.05 + 0.3 * v[0]))
        expected, lines = [], []
        for query in range(60):
            trocar, tip = self.point(0.03, 0.15), self.point(0.05, 0.04)
            start = tip if query % 2 else self.point(0.05, 0.04)
            lines.append(motion_line(query, 'swept', trocar, start, tip, 0.002))
            motion = ((trocar, start), (trocar, tip))
            expected.append((query, oracle.contacts(now, before, motion, 0.002)))
            if query == 1:  # a static query looks at the organ's present shape only
                lines.append(motion_line(100, 'static', trocar, start, tip, 0.002))
                static = (100, oracle.static_contacts(now, (trocar, tip), 0.002))
        self.write_scene(now, lines)
        self.write('old.obj', obj_text(before))
        rows = self.contacts(*FILES, '--mesh-before', 'old.obj')
        self.assertGreater(len(rows), 100)
        self.assert_rows(rows, expected + [static])
        self.assertEqual(
            rows, self.contacts(*FILES, '--mesh-before', 'old.obj', '--picker', 'select')
        )
        self.assertNotEqual(rows, self.contacts(*FILES))

    def test_the_papers_modes(self):
        """Faces within 1e-5 m of the volume's boundary are left to 32-bit clipping."""
        liver, lines, allowed = scenes.liver(), [], []
        for number in range(8):
            trocar, previous, tip = self.point(0.05, 0.2), self.point(0.06, 0), self.point(0.06, 0)
            static = paper_oracle.static_volume((trocar, tip), 0.005)
            swept = paper_oracle.swept_volume(trocar, previous, tip, 0.005)
            for mode, volume in (
                ('paper_static', static),
                ('paper_swept', swept),
                ('paper_naive', swept),
            ):
                lines.append(motion_line(len(lines), mode, trocar, previous, tip, 0.005))
                certain, possible = (
                    set(paper_oracle.picked(liver, [(n, d + margin) for n, d in volume]))
                    for margin in (-1e-5, 1e-5)
                )
                allowed.append((certain, possible))
        self.write_scene(liver, lines)
        for picker in 'feedback', 'select', 'cpu':
            rows = self.contacts(*FILES, '--picker', picker)
            self.assertTrue(all(row[2:] == [''] * 8 for row in rows))
            keys = [(int(query), int(face)) for query, face, *_ in rows]
            self.assertEqual(keys, sorted(set(keys)))
            for query, (certain, possible) in enumerate(allowed):
                found = {face for q, face in keys if q == query}
                self.assertLessEqual(certain, found)
                self.assertLessEqual(found, possible)
            self.assertGreater(len(keys), 300)

    def test_polygons_count_as_so_many_faces(self):
        """A row of squares: a tool over the fourth one touches its two triangles, 6 and 7."""
        corners = ''.join('v %d 0 0\nv %d 1 0\n' % (x, x) for x in range(6))
        quads = ''.join('f %d %d %d %d\n' % (i, i + 2, i + 3, i + 1) for i in range(1, 11, 2))
        self.write('organ.obj', corners + quads)
        self.write('motions.csv', motions_text(['1,static,3.5,0.5,1,,,,3.5,0.5,0.05,0.1']))
        self.assertEqual([row[1] for row in self.contacts(*FILES)], ['6', '7'])


if __name__ == '__main__':
    unittest.main()
