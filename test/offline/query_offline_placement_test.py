#!/usr/bin/python3
"""The columns of --margin, --clearance and --placement, compared with naive oracles."""

import csv
import math
import random
import unittest

from program import CONTACTS_HEADER, ProgramCase, motion_line, motions_text, obj_text
from support import oracle, scenes
from support.vectors import add, cross, dot, length, lerp, scaled, sub

FILES = ('--mesh', 'organ.obj', '--motions', 'motions.csv')
CONTACT_COLUMNS = CONTACTS_HEADER.split(',')
EXACT = 1e-9  # [m] the error of a distance at rest
LEAST = 1e-6  # [m] how much the least distance of a step may be too large


def nearest_face(mesh, axis):
    """The distance between the axis and the mesh, and the number of the nearest face."""
    return min((oracle.nearest(axis, mesh.face(f)).distance, f) for f in range(len(mesh.faces)))


def is_inside(point, mesh):
    """By the sum of the solid angles of all faces (Van Oosterom and Strackee 1983)."""
    total = 0.0
    for number in range(len(mesh.faces)):
        a, b, c = (sub(corner, point) for corner in mesh.face(number))
        la, lb, lc = length(a), length(b), length(c)
        below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb
        total += 2.0 * math.atan2(dot(a, cross(b, c)), below)
    return abs(total) > 2.0 * math.pi


def crossings(axis, mesh):
    """(place, face, direction) of each face that the axis pierces, from trocar to tip."""
    found, along = [], sub(axis[1], axis[0])
    for number in range(len(mesh.faces)):
        face = mesh.face(number)
        normal = cross(sub(face[1], face[0]), sub(face[2], face[0]))
        slope = dot(normal, along)
        if slope == 0.0:
            continue
        place = dot(normal, sub(face[0], axis[0])) / slope
        if 0 < place < 1 and min(oracle.barycentric(lerp(*axis, place), face)) > 0:
            found.append((place, number, '+' if slope < 0 else '-'))
    return sorted(found)


def point_of(row, name):
    return tuple(float(row['%s_%s' % (name, letter)]) for letter in 'xyz')


class PlacementTest(ProgramCase):
    def setUp(self):
        super().setUp()
        self.rng = random.Random(17)

    def point(self, reach):
        return tuple(self.rng.uniform(-reach, reach) for _ in range(3))

    def write_scene(self, mesh, lines):
        self.write('organ.obj', obj_text(mesh))
        self.write('motions.csv', motions_text(lines))

    def rows(self, *flags):
        done = self.run_program(*FILES, *flags)
        self.assertEqual(done.returncode, 0, done.stderr)
        return list(csv.DictReader(done.stdout.splitlines()))

    def test_contacts_stay_as_they_are(self):
        """Without flags, nothing is added. With flags, the cells of the contacts are the same, and
        the other cells are the same in all rows of a query."""
        lines = [
            motion_line(i, self.rng.choice(['static', 'swept']), self.point(0.2), self.point(0.08),
                        self.point(0.08), 0.004) for i in range(40)
        ]
        self.write_scene(scenes.liver(), lines)
        plain = self.rows()
        self.assertEqual(list(plain[0]), CONTACT_COLUMNS)
        for flags in ('--clearance', '--placement'), ('--margin', '0.01'), ('--placement',):
            rows = self.rows(*flags)
            kept = [{name: row[name] for name in CONTACT_COLUMNS} for row in rows]
            self.assertEqual([row for row in kept if row['face']], plain)
            self.assertEqual({row['query'] for row in rows}, {str(i) for i in range(40)})
            without = [row for row in kept if not row['face']]
            self.assertGreater(len(without), 0)
            for row in without:
                self.assertEqual(set(list(row.values())[1:]), {''})
                self.assertEqual(sum(other['query'] == row['query'] for other in kept), 1)
            added = {}
            for row in rows:
                cells = [cell for name, cell in row.items() if name not in CONTACT_COLUMNS]
                self.assertEqual(added.setdefault(row['query'], cells), cells)

    def assert_pair(self, row, mesh, axis, radius):
        """The nearest points belong together, to the tool and to the face."""
        distance, face = float(row['distance']), int(row['nearest_face'])
        normal, on_tool = point_of(row, 'clearance_normal'), point_of(row, 'on_tool')
        on_organ = point_of(row, 'on_organ')
        self.assertAlmostEqual(length(normal), 1.0, delta=1e-12)
        gap = sub(sub(on_organ, on_tool), scaled(normal, distance))
        self.assertLessEqual(length(gap), EXACT)
        on_axis = add(on_tool, scaled(normal, -radius))
        place = oracle.place_on_segment(on_axis, *axis)
        self.assertLessEqual(length(sub(lerp(*axis, place), on_axis)), EXACT)
        self.assertLessEqual(oracle.nearest((on_organ, on_organ), mesh.face(face)).distance, EXACT)
        self.assertEqual(row['normal_defined'], '1' if distance + radius > EXACT else '0')

    def test_static_clearance(self):
        box, motions = scenes.box(), []
        for _ in range(60):
            motions.append(((self.point(0.15), self.point(0.08)), self.rng.uniform(1e-3, 0.01)))
        self.write_scene(box, [
            motion_line(i, 'static', axis[0], axis[1], axis[1], radius)
            for i, (axis, radius) in enumerate(motions)
        ])
        rows = {int(row['query']): row for row in self.rows('--clearance')}
        close = {int(row['query']): row for row in self.rows('--margin', '0.02')}
        states = set()
        for query, (axis, radius) in enumerate(motions):
            row, right = rows[query], nearest_face(box, axis)[0] - radius
            self.assertEqual(row['clearance'], 'known')
            self.assertAlmostEqual(float(row['distance']), right, delta=EXACT)
            self.assert_pair(row, box, axis, radius)
            states.add(close[query]['clearance'])
            if close[query]['clearance'] == 'known':
                self.assertEqual(close[query], row)
                self.assertLessEqual(right, 0.02 + EXACT)
            else:
                self.assertEqual(close[query]['clearance'], 'beyond_margin')
                self.assertEqual(close[query]['distance'], '')
                self.assertGreater(right, 0.02 - EXACT)
        self.assertEqual(states, {'known', 'beyond_margin'})

    def test_the_least_distance_of_a_step(self):
        box, motions = scenes.box(), []
        for _ in range(30):
            motions.append((self.point(0.15), self.point(0.1), self.point(0.1)))
        self.write_scene(box, [
            motion_line(i, 'swept', *motion, 0.002) for i, motion in enumerate(motions)
        ])
        for row in self.rows('--clearance'):
            trocar, previous, tip = motions[int(row['query'])]

            def distance_at(time):
                return nearest_face(box, (trocar, lerp(previous, tip, time)))[0] - 0.002

            least, when = float(row['least']), float(row['least_fraction'])
            if row['face']:
                self.assertEqual(least, 0.0)
                self.assertLessEqual(distance_at(when), EXACT)
            else:
                self.assertAlmostEqual(least, distance_at(when), delta=EXACT)
                for step in range(41):
                    self.assertLessEqual(least, distance_at(step / 40) + LEAST)
            self.assertAlmostEqual(float(row['distance']), distance_at(1.0), delta=EXACT)

    def test_sides_and_crossings(self):
        liver, motions = scenes.liver(), []
        for _ in range(60):
            motions.append((self.point(0.12), self.point(0.06)))
        self.write_scene(liver, [
            motion_line(i, 'swept', axis[0], self.point(0.1), axis[1], 0.002)
            for i, axis in enumerate(motions)
        ])
        sides = set()
        for query, row in {int(row['query']): row for row in self.rows('--placement')}.items():
            axis = motions[query]
            inside = [is_inside(end, liver) for end in axis]
            sides.add(tuple(inside))
            for name, end in ('trocar_side', inside[0]), ('tip_side', inside[1]):
                self.assertEqual(row[name], 'inside' if end else 'outside')
            right = crossings(axis, liver)
            self.assertEqual(row['crossings'], str(len(right)))
            self.assertEqual(row['crossed_faces'], ' '.join(str(face) for _, face, _ in right))
            self.assertEqual(row['crossing_directions'],
                             ' '.join(sign + '1' for _, _, sign in right).replace('+', ''))
            places = [float(word) for word in row['crossing_places'].split()]
            for place, (expected, _, _) in zip(places, right):
                self.assertAlmostEqual(place, expected, delta=EXACT)
            ends = [0.0] + places + [1.0]
            within = sum(b - a for k, (a, b) in enumerate(zip(ends, ends[1:]))
                         if inside[0] == (k % 2 == 0))
            self.assertAlmostEqual(float(row['length_inside']),
                                   within * length(sub(axis[1], axis[0])), delta=EXACT)
        self.assertEqual(len(sides), 4)

    def test_an_open_surface_has_crossings_but_no_sides(self):
        self.write_scene(scenes.sheet(), [motion_line(1, 'static', (0.01, 0.012, 0.1), (0, 0, 0),
                                                      (0.01, 0.012, -0.1), 0.002)])
        for row in self.rows('--placement'):
            self.assertEqual((row['tip_side'], row['trocar_side']), ('unknown', 'unknown'))
            self.assertEqual((row['crossings'], row['length_inside']), ('1', ''))
            self.assertEqual(row['crossing_directions'], '1')

    def test_paper_modes_beside_others(self):
        """A file may have both; the rows of paper modes have no added cells."""
        axis = (0.01, 0.02, 0.2), (0.0, 0.03, 0.01), (0.02, 0.01, -0.01)
        self.write_scene(scenes.sheet(), [
            motion_line(i, mode, *axis, 0.005)
            for i, mode in enumerate(['paper_static', 'static', 'paper_swept', 'paper_naive'])
        ])
        rows = self.rows('--clearance', '--placement')
        self.assertEqual({row['query'] for row in rows}, set('0123'))
        for row in rows:
            added = {cell for name, cell in row.items() if name not in CONTACT_COLUMNS}
            if row['query'] == '1':
                self.assertEqual((row['clearance'], row['tip_side']), ('known', 'unknown'))
            else:
                self.assertEqual(added, {''})

    def test_illegal_margins(self):
        self.write_scene(scenes.sheet(), [motion_line(1, 'static', *[(0, 0, 1)] * 3, 0.005)])
        for text in '-0.01', '0', 'nan', 'inf', '1e999', 'wide':
            done = self.run_program(*FILES, '--margin', text)
            self.assertEqual((done.returncode, done.stdout), (2, ''))
            self.assertEqual(
                done.stderr,
                'query_offline: --margin is "%s"; must be a finite number above 0, in metres '
                '(--help explains)\n' % text,
            )

    def test_help_explains_each_column(self):
        self.write_scene(scenes.box(), [motion_line(1, 'static', *[(0, 0, 1)] * 3, 0.005)])
        explained = self.run_program('--help').stdout
        for name in self.rows('--clearance', '--placement')[0]:
            if name[-2:] not in ('_y', '_z'):  # --help writes on_organ_x,_y,_z
                self.assertIn(name, explained)


if __name__ == '__main__':
    unittest.main()
