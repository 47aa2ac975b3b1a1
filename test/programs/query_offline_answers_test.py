#!/usr/bin/python3
"""What the program prints about motions: small cases by hand, and all outputs that must be the same."""

import csv
import random
import unittest

from program import CONTACTS_HEADER, ProgramCase, motion_line, motions_text, obj_text
from support import scenes

FILES = ('--mesh', 'organ.obj', '--motions', 'motions.csv')
CONTACT_COLUMNS = CONTACTS_HEADER.split(',')

class AnswersTest(ProgramCase):
    def setUp(self):
        super().setUp()
        self.rng = random.Random(41)

    def point(self, reach, z):
        x, y = (self.rng.uniform(-reach, reach) for _ in range(2))
        return (x, y, z + self.rng.uniform(-0.03, 0.03))

    def write_scene(self, mesh, lines):
        self.write('organ.obj', obj_text(mesh))
        self.write('motions.csv', motions_text(lines))

    def printed(self, *options, files=FILES):
        done = self.run_program(*files, *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_a_radius_in_millimetres_is_warned_of_once(self):
        self.write_scene(scenes.sheet(0.1, 6), ['%d,swept,0,0,0.1,0,0,0.05,0,0,0.04,5' % i for i in range(3)])
        done = self.run_program(*FILES)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr.count('has a radius of 5 m; plausible are'), 1)
        self.assertIn('motions.csv:2: the shaft', done.stderr)

    def test_one_face_by_hand(self):
        """A tip of 5 mm radius, 4 mm above a plate, is 1 mm deep. If it falls from 10 mm to 4 mm, or the plate rises as
        much, it first touches after 5/6 of the step."""
        plate = 'v -1 -1 {0}\nv 1 -1 {0}\nv 1 1 {0}\nv -1 1 {0}\nf 1 2 3 4\n'
        self.write('organ.obj', plate.format(0.25))
        self.write('before.obj', plate.format(0.244))
        line = '%s,0.25,-0.5,0.5,0.25,-0.5,%s,0.25,-0.5,0.254,0.005'
        falls = [line % ('2,static', 0.26), line % ('1,swept', 0.26)]
        rises = [line % ('2,static', 0.254), line % ('1,swept', 0.254)]
        for lines, options in ((falls, ()), (rises, ('--mesh-before', 'before.obj'))):
            self.write('motions.csv', motions_text(lines))
            (_, *swept), (_, *static) = self.contacts(*FILES, *options)
            for row, fraction in (swept, 5 / 6), (static, 0.0):
                self.assertEqual(row[0], '0')
                for cell, right in zip(row[1:3], (fraction, 0.001)):
                    self.assertAlmostEqual(float(cell), right, delta=1e-7)
                for cell, right in zip(row[6:], (0, 0, -1)):
                    self.assertAlmostEqual(float(cell), right, delta=1e-8)
            self.assertEqual([float(cell) for cell in static[3:6]], [0.25, -0.5, 0.25])

    def test_columns_are_added(self):
        """The cells of the contacts stay, the other cells are the same in all rows of a query, and
        --help explains each column. Rows of paper modes have no added cells."""
        explained, modes = self.run_program('--help').stdout, ('static', 'swept', 'paper_swept')
        lines = [motion_line(i, modes[i % 3], self.point(0.2, 0.1), self.point(0.08, 0.1), self.point(0.08, 0), 0.004)
                 for i in range(45)]
        self.write_scene(scenes.liver(), lines)
        plain = list(csv.DictReader(self.printed().splitlines()))
        self.assertEqual(list(plain[0]), CONTACT_COLUMNS)
        for options in ('--clearance', '--placement'), ('--margin', '0.01'):
            rows = list(csv.DictReader(self.printed(*options).splitlines()))
            for name in rows[0]:
                if name[-2:] not in ('_y', '_z'):  # --help writes on_organ_x,_y,_z
                    self.assertIn(name, explained)
            self.assertEqual([{name: row[name] for name in CONTACT_COLUMNS} for row in rows if row['face']], plain)
            self.assertEqual({row['query'] for row in rows}, {str(i) for i in range(45)})
            added = {}
            for row in rows:
                cells = [cell for name, cell in row.items() if name not in CONTACT_COLUMNS]
                self.assertEqual(added.setdefault(row['query'], cells), cells)
                self.assertEqual(set(cells) == {''}, int(row['query']) % 3 == 2)

    def test_clearance_and_sides_of_a_box_by_hand(self):
        """The box is 6 x 5 x 4 cm around the origin."""
        self.write_scene(scenes.box(), [
            motion_line('outside', 'swept', (0.001, 0.002, 0.1), (0.001, 0.002, 0.06), (0.001, 0.002, 0.05), 0.005),
            motion_line('through', 'static', (0.001, 0.002, 0.1), (0, 0, 0), (0.001, 0.002, -0.01), 0.005)])
        outside, through = {row['query']: row for row in csv.DictReader(
            self.printed('--clearance', '--placement').splitlines())}.values()
        for name, right in ('distance', 0.025), ('least', 0.025), ('on_organ_z', 0.02), ('on_tool_z', 0.045):
            self.assertAlmostEqual(float(outside[name]), right, delta=1e-8)
        self.assertEqual((outside['tip_side'], outside['crossings']), ('outside', '0'))
        self.assertEqual((through['tip_side'], through['trocar_side'], through['crossings']), ('inside', 'outside', '1'))
        self.assertEqual(through['crossing_directions'], '1')
        self.assertAlmostEqual(float(through['length_inside']), 0.03, delta=1e-8)

    def test_the_same_bytes_with_each_picker_and_any_number_of_threads(self):
        modes = ('static', 'swept', 'paper_static', 'paper_swept', 'paper_naive')
        self.write_scene(scenes.liver(), [
            motion_line(query, modes[query % 5], self.point(0.05, 0.2), self.point(0.1, 0.0), self.point(0.1, 0.0), 0.003)
            for query in self.rng.sample(range(500), 500)])
        options = ('--margin', '0.01', '--placement')
        right = self.printed(*options)
        for more in (('--jobs', '1'), ('--jobs', '7'), ('--picker', 'select'), ('--picker', 'cpu')):
            self.assertEqual(self.printed(*options, *more), right)


if __name__ == '__main__':
    unittest.main()
