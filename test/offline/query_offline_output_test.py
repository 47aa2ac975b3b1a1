#!/usr/bin/python3
"""The output of the program: order, digits, progress, and failures to write or to draw."""

import os
import subprocess
import time
import unittest

from program import CONTACTS_HEADER, PROGRAM, ProgramCase, motion_line, motions_text, obj_text
from support import scenes

FILES = ('--mesh', 'organ.obj', '--motions', 'motions.csv')
TROCAR, BEFORE, TIP = (0.01, 0.02, 0.2), (0.0, 0.03, 0.01), (0.02, 0.01, -0.01)


class OutputTest(ProgramCase):
    def setUp(self):
        super().setUp()
        self.write('organ.obj', obj_text(scenes.sheet(0.1, 5)))

    def write_motions(self, queries, tip=TIP):
        lines = [motion_line(query, 'swept', TROCAR, BEFORE, tip, 0.005) for query in queries]
        self.write('motions.csv', motions_text(lines))

    def test_rows_are_sorted_by_query_then_face(self):
        for queries, ordered in (
            ([10, 9, -1, 100], ['-1', '9', '10', '100']),
            (['stab', 'palpate', '7'], ['7', 'palpate', 'stab']),
        ):
            self.write_motions(queries)
            rows = self.contacts(*FILES)
            self.assertEqual(list(dict.fromkeys(row[0] for row in rows)), ordered)
            faces = [int(row[1]) for row in rows if row[0] == ordered[0]]
            self.assertGreater(len(faces), 3)
            self.assertEqual(
                [row[:2] for row in rows], [[q, str(f)] for q in ordered for f in sorted(faces)]
            )

    def test_numbers_have_all_their_digits(self):
        self.write_motions([1])
        for row in self.contacts(*FILES):
            for cell in row[2:]:
                self.assertEqual(cell, '%.17g' % float(cell))

    def test_a_motion_without_contact_has_no_row(self):
        self.write_motions([1], tip=(0.0, 0.031, 0.011))
        self.assertEqual(self.run_program(*FILES).stdout, CONTACTS_HEADER + '\n')

    def test_help(self):
        done = self.run_program('--help')
        self.assertEqual((done.returncode, done.stderr), (0, ''))
        for word in '--mesh', '--motions', '--mesh-before', '--picker', CONTACTS_HEADER:
            self.assertIn(word, done.stdout)

    def test_progress_of_a_long_run(self):
        """Progress is printed on stderr at most once a second, and nothing else. The number of
        motions is doubled until a run takes long enough to print progress."""
        self.write('organ.obj', obj_text(scenes.sheet(0.1, 60)))
        for count in (100 * 2**i for i in range(10)):
            self.write_motions(range(count))
            started = time.monotonic()
            done = self.run_program(*FILES)
            elapsed = time.monotonic() - started
            self.assertEqual(done.returncode, 0)
            said = done.stderr.splitlines()
            self.assertLessEqual(len(said), elapsed)
            for line in said:
                self.assertRegex(line, r'^query_offline: \d+ of %d motions$' % count)
            if said:
                return
        self.fail('no progress in a run of %g s' % elapsed)

    def test_stdout_that_cannot_be_written(self):
        self.write_motions(range(100))
        with open('/dev/full', 'w') as full:
            self.assert_unwritable(full, 'No space left on device')
        reader, writer = os.pipe()
        os.close(reader)
        with os.fdopen(writer, 'w') as closed_pipe:
            self.assert_unwritable(closed_pipe, 'Broken pipe')

    def assert_unwritable(self, stdout, reason):
        done = subprocess.run(
            [PROGRAM, *FILES], cwd=self.folder, stdout=stdout, stderr=subprocess.PIPE, timeout=100
        )
        self.assertEqual(done.returncode, 1)
        said = done.stderr.decode().splitlines()
        self.assertEqual(said[-1], 'query_offline: stdout cannot be written: ' + reason)

    def test_opengl_that_does_not_work(self):
        """A forward compatible context has neither picking mode."""
        self.write_motions([1])
        for picker in 'feedback', 'select':
            done = self.run_program(*FILES, '--picker', picker, MESA_GL_VERSION_OVERRIDE='3.2FC')
            self.assertEqual((done.returncode, done.stdout), (1, ''))
            self.assertRegex(done.stderr, r'^query_offline: .*OpenGL.*\n$')


if __name__ == '__main__':
    unittest.main()
