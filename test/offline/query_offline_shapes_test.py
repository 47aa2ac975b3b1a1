#!/usr/bin/python3
"""--shapes: the steps of a recorded simulation, compared with one run for each step."""

import random
import subprocess
import unittest

from program import CONTACTS_HEADER, PROGRAM, ProgramCase, motion_line, motions_text, obj_text
from support import scenes

FILES = ('--shapes', 'shapes', '--motions', 'motions.csv')
STEPS = 23
PLATE = 'v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\n'
MOTION = '%d,swept,0.02,0.02,0.2,0.02,0.02,0.1,0.03,0.02,-0.01,0.005'


class ShapesTest(ProgramCase):
    def setUp(self):
        super().setUp()
        (self.folder / 'shapes').mkdir()

    def write_recording(self):
        """A liver that is pushed about, and a tool in it. The queries are not in the order of the steps."""
        rng = random.Random(3)
        liver, tip, lines = scenes.liver(), (0.0, 0.0, 0.04), []
        queries = rng.sample(range(1000), STEPS)
        for step in range(STEPS):
            shift = [rng.uniform(-0.01, 0.01) for _ in range(3)]
            bend = rng.uniform(-1.0, 1.0)
            shape = liver.moved(lambda v: (v[0] + shift[0], v[1] + shift[1] + bend * v[0] * v[0], v[2] + shift[2]))
            self.write('shapes/step_%d.obj' % step, obj_text(shape))
            previous, tip = tip, tuple(rng.uniform(-0.05, 0.05) for _ in range(3))
            mode = 'static' if step % 7 == 3 else 'swept'
            lines.append(motion_line(queries[step], mode, (0.02, 0.01, 0.2), previous, tip, 0.004))
        self.write('motions.csv', motions_text(lines))
        return lines

    def step_by_step(self, lines, *options):
        """The output as of one run for each step, from the shape before it to its own."""
        rows = []
        for step, line in enumerate(lines):
            self.write('one.csv', line)
            before = ('--mesh-before', 'shapes/step_%d.obj' % (step - 1)) if step > 0 else ()
            done = self.run_program('--mesh', 'shapes/step_%d.obj' % step, '--motions', 'one.csv', *before, *options)
            self.assertEqual(done.returncode, 0, done.stderr)
            header, *answer = done.stdout.splitlines(True)
            rows += answer
        return ''.join([header] + rows)

    def test_the_steps_of_a_recording(self):
        lines = self.write_recording()
        for options in (), ('--clearance', '--placement'):
            right = self.step_by_step(lines, *options)
            self.assertGreater(right.count('\n'), 5 * STEPS)
            for jobs in '1', '2', '3', '7':
                done = self.run_program(*FILES, *options, '--jobs', jobs)
                self.assertEqual((done.stdout, done.stderr, done.returncode), (right, '', 0))

    def test_motions_from_standard_input(self):
        lines = self.write_recording()
        with open(self.folder / 'motions.csv') as motions:
            piped = subprocess.run([PROGRAM, '--shapes', 'shapes', '--motions', '-'], cwd=self.folder, stdin=motions,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=100)
        self.assertEqual((piped.stdout, piped.stderr, piped.returncode), (self.step_by_step(lines), '', 0))

    def write_plates(self, count, motions=None):
        for step in range(count):
            self.write('shapes/%d.obj' % step, PLATE + 'f 1 2 3\n')
        lines = [MOTION % query for query in range(count if motions is None else motions)]
        self.write('motions.csv', motions_text(lines))

    def assert_refused(self, said, output='', arguments=FILES):
        for jobs in '1', '3':
            done = self.run_program(*arguments, '--jobs', jobs)
            self.assertEqual((done.stderr, done.stdout, done.returncode), (said + '\n', output, 2))

    def test_as_many_motions_as_shapes(self):
        for motions in 4, 6:
            self.write_plates(5, motions)
            self.assert_refused('motions.csv: the file has %d motions; shapes has 5 OBJ files, and each needs one '
                                'motion' % motions)

    def test_as_many_motions_from_standard_input_as_shapes(self):
        self.write_plates(5)
        right = self.run_program(*FILES).stdout
        for motions, status, said in (
            (4, 2, 'standard input: the motions end; shapes without a motion: 1; each shape needs one\n'),
            (5, 0, ''),
            (6, 2, 'standard input:6: there is no shape for this motion; must have as many shapes\n'),
        ):
            text = ''.join(MOTION % query + '\n' for query in range(motions))
            done = subprocess.run([PROGRAM, *FILES[:3], '-'], cwd=self.folder, input=text, stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE, universal_newlines=True, timeout=100)
            self.assertEqual((done.returncode, done.stderr), (status, said))
            answered = [row for row in right.splitlines(True) if row == CONTACTS_HEADER + '\n' or
                        int(row.split(',')[0]) < motions]
            self.assertEqual(done.stdout, ''.join(answered))

    def test_a_folder_without_shapes(self):
        self.write('motions.csv', motions_text([MOTION % 1]))
        self.assert_refused('shapes: the folder has no OBJ file; must have at least one')
        self.assert_refused('none: cannot be read: No such file or directory',
                            arguments=('--shapes', 'none') + FILES[2:])

    def test_a_bad_first_shape(self):
        self.write_plates(3)
        self.write('shapes/0.obj', PLATE)
        self.assert_refused('shapes/0.obj:3: the file ends without an f line; a mesh in OBJ format has at least one')

    def test_a_bad_later_shape(self):
        """The steps before it are answered."""
        self.write_plates(20)
        right = self.run_program(*FILES).stdout
        before = ''.join(row for row in right.splitlines(True) if not row.split(',')[0].isdigit() or
                         int(row.split(',')[0]) < 13)
        self.assertGreater(before.count('\n'), 10)
        for text, said in (
            (PLATE + 'f 1 3 2\n', '4: face 0 has the vertices 1 3 2; in shapes/0.obj they are 1 2 3'),
            (PLATE + 'f 1 2 3\nf 1 2 3\n', '5: the file ends with 3 vertices and 2 faces; shapes/0.obj has 3 vertices '
             'and 1 faces'),
            (PLATE.replace('0.1', 'nan', 1) + 'f 1 2 3\n', '2: x is "nan"; must be finite and within 1e6 m'),
        ):
            self.write('shapes/13.obj', text)
            self.assert_refused('shapes/13.obj:' + said, before)

    def test_queries_that_come_twice(self):
        self.write_plates(2)
        self.write('motions.csv', MOTION % 5 + '\n' + MOTION % 5 + '\n')
        self.assert_refused('motions.csv:2: query "5" is already on line 1; each motion needs its own')

    def test_options_that_do_not_go_together(self):
        self.write_plates(2)
        for option in '--mesh', '--mesh-before':
            self.assert_refused('query_offline: options --shapes and %s are given; the folder has all shapes '
                                '(--help explains)' % option, arguments=FILES + (option, 'shapes/0.obj'))


if __name__ == '__main__':
    unittest.main()
