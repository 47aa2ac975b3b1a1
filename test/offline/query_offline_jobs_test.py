#!/usr/bin/python3
"""--jobs: any number of threads prints the same bytes, in the same order, and the same errors."""

import random
import unittest

from program import ProgramCase, motion_line, motions_text, obj_text
from support import scenes

FILES = ('--mesh', 'organ.obj', '--motions', 'motions.csv')
MODES = ('static', 'swept', 'paper_static', 'paper_swept', 'paper_naive')


class JobsTest(ProgramCase):
    def setUp(self):
        super().setUp()
        self.rng = random.Random(7)
        liver = scenes.liver()
        self.write('organ.obj', obj_text(liver))
        self.write('old.obj', obj_text(liver.moved(lambda v: (v[0] + 0.004, v[1], v[2] - 0.006))))

    def point(self, reach, z):
        return tuple(self.rng.uniform(-reach, reach) for _ in range(2)) + (z + self.rng.uniform(-0.03, 0.03),)

    def write_motions(self, queries):
        lines = [
            motion_line(query, self.rng.choice(MODES), self.point(0.05, 0.2), self.point(0.1, 0.0),
                        self.point(0.1, 0.0), self.rng.choice([0.0005, 0.003, 0.01])) for query in queries
        ]
        self.write('motions.csv', motions_text(lines))

    def printed(self, *options):
        done = self.run_program(*FILES, *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_the_same_bytes_for_any_number(self):
        queries = list(range(3000))
        self.rng.shuffle(queries)
        self.write_motions(queries)
        for options in (), ('--mesh-before', 'old.obj', '--margin', '0.01', '--placement'):
            right = self.printed(*options, '--jobs', '1')
            self.assertGreater(right.count('\n'), 3000)
            for jobs in '2', '3', '7':
                self.assertEqual(self.printed(*options, '--jobs', jobs), right)
            self.assertEqual(self.printed(*options), right)

    def test_more_threads_than_motions(self):
        self.write_motions(['stab'])
        self.assertEqual(self.printed('--jobs', '40'), self.printed('--jobs', '1'))

    def test_the_same_errors(self):
        self.write_motions(range(500))
        with open(self.folder / 'motions.csv', 'a') as file:
            file.write('500,paper_swept,0,0,1,0,0,1,0,0,1,0.005\n')
        for jobs in '1', '3':
            done = self.run_program(*FILES, '--jobs', jobs)
            self.assertEqual((done.returncode, done.stdout), (2, ''))
            self.assertRegex(done.stderr, r'^motions\.csv:502: .*\n$')

    def test_illegal_numbers(self):
        self.write_motions([1])
        for text in '0', '-1', '1.5', 'all', '1025', '99999999999999999999':
            done = self.run_program(*FILES, '--jobs', text)
            self.assertEqual((done.returncode, done.stdout), (2, ''))
            self.assertEqual(done.stderr, 'query_offline: --jobs is "%s"; must be a whole number from 1 to 1024 '
                             '(--help explains)\n' % text)

    def test_opengl_that_does_not_work(self):
        self.write_motions(range(100))
        done = self.run_program(*FILES, '--jobs', '3', MESA_GL_VERSION_OVERRIDE='3.2FC')
        self.assertEqual((done.returncode, done.stdout), (1, ''))
        self.assertRegex(done.stderr, r'^query_offline: .*OpenGL.*\n$')


if __name__ == '__main__':
    unittest.main()
