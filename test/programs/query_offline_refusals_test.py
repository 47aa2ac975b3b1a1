#!/usr/bin/python3
"""What the program cannot do: its exit status, and one line on stderr that says where and what."""

import os
import subprocess
import unittest

from program import CONTACTS_HEADER, PROGRAM, ProgramCase, motions_text

ORGAN = 'v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0.1 0.1 0.01\nf 1 2 3\nf 2 4 3\n'
MOTION = '%s,swept,0,0,0.2,0.02,0.02,0.1,0.03,0.02,-0.01,0.005'
MESH, MOTIONS, SHAPES = ('--mesh', 'organ.obj'), ('--motions', 'motions.csv'), ('--shapes', 'shapes')
FILES = MESH + MOTIONS


class RefusalsTest(ProgramCase):
    def setUp(self):
        super().setUp()
        (self.folder / 'shapes').mkdir()
        (self.folder / 'empty').mkdir()
        self.write('organ.obj', ORGAN)
        self.write('other.obj', ORGAN.replace('f 2 4 3', 'f 2 3 4'))
        self.write('broken.obj', ORGAN.replace('0.01', 'nan'))
        self.write('motions.csv', motions_text([MOTION % 1, MOTION % 2]))
        self.write('broken.csv', motions_text([MOTION % 1, MOTION % 1]))
        self.write('short.csv', motions_text([MOTION % 1, '2,paper_swept,0,0,1,0,0,1,0,0,1,0.005']))
        for step in range(2):
            self.write('shapes/%d.obj' % step, ORGAN)

    def assert_refused(self, arguments, beginning, *words, status=2, output='', **environment):
        done = self.run_program(*arguments, **environment)
        said = 'stderr: ' + done.stderr
        self.assertEqual((done.returncode, done.stdout), (status, output), said)
        self.assertRegex(done.stderr, r'\A%s: .*\n\Z' % beginning, said)
        for word in words:
            self.assertIn(word, done.stderr)

    def test_files_and_options(self):
        """The tests of the readers have a row for each illegal line."""
        self.assertEqual(self.run_program(*FILES).returncode, 0)
        here = 'query_offline'
        for arguments, beginning, *words in [
                (('--mesh', 'broken.obj') + MOTIONS, 'broken.obj:4', '"nan"'),
                (('--mesh', 'none.obj') + MOTIONS, 'none.obj', 'No such file'),
                (('--mesh', '.') + MOTIONS, '.', 'Is a directory'),
                (FILES + ('--mesh-before', 'other.obj'), 'other.obj:6', '2 3 4', '2 4 3', 'organ.obj'),
                (MESH + ('--motions', 'broken.csv'), 'broken.csv:3', 'query "1"', 'line 2'),
                (MESH + ('--motions', 'short.csv', '--jobs', '3'), 'short.csv:3', 'trocar', 'tip'),
                (MESH + ('--motions', 'none.csv'), 'none.csv', 'No such file'),
                (('--shapes', 'none') + MOTIONS, 'none', 'No such file'),
                (('--shapes', 'empty') + MOTIONS, 'empty', 'no OBJ file'),
                ((), here, '--mesh', 'missing'),
                (MESH, here, '--motions', 'missing'),
                (MOTIONS, here, '--mesh', 'missing'),
                (FILES + ('--fast',), here, '"--fast"', '--mesh-before', '--picker'),
                (FILES + ('more.csv',), here, '"more.csv"'),
                (FILES + MESH, here, '--mesh', 'more than once'),
                (FILES + ('--picker',), here, '--picker', 'missing'),
                (FILES + ('--picker', 'embree'), here, 'embree', 'feedback', 'select', 'cpu'),
                (FILES + ('--gl', 'glx'), here, 'glx', 'auto', 'osmesa', 'egl'),
                (SHAPES + FILES, here, '--shapes', '--mesh', 'all shapes')] + [
                (FILES + ('--jobs', text), here, '"%s"; must be a whole number from 1 to 1024' % text)
                for text in ('0', '-2', '1.5', 'all', '1025', '99999999999999999999')] + [
                (FILES + ('--margin', text), here, '"%s"; must be a finite number above 0, in metres' % text)
                for text in ('-0.01', '0', 'nan', 'inf', '1e999', '2mm', '1,5')]:
            with self.subTest(arguments=arguments):
                self.assert_refused(arguments, beginning, *words)

    def test_as_many_motions_as_shapes(self):
        self.write('shapes/2.obj', ORGAN)
        self.assert_refused(SHAPES + MOTIONS, 'motions.csv', '2 motions', '3 OBJ files')
        right = self.run_program(*FILES).stdout
        for motions, status, said in (
            (2, 2, 'standard input: the motions end; shapes without a motion: 1; each shape needs one\n'),
            (4, 2, 'standard input:4: there is no shape for this motion; must have as many shapes\n'),
        ):
            done = subprocess.run([PROGRAM, *SHAPES, '--motions', '-'], cwd=self.folder, stdout=subprocess.PIPE,
                                  input=''.join(MOTION % (i + 1) + '\n' for i in range(motions)),
                                  stderr=subprocess.PIPE, text=True, timeout=100)
            self.assertEqual((done.returncode, done.stderr), (status, said))
            self.assertTrue(done.stdout.startswith(right))

    def test_a_bad_later_shape(self):
        """The steps before it are answered."""
        right = self.run_program(*FILES).stdout
        before = ''.join(row for row in right.splitlines(True) if row[0] != '2')
        self.assertTrue(before.startswith(CONTACTS_HEADER) and before != right)
        self.write('shapes/1.obj', ORGAN.replace('f 2 4 3', 'f 2 3 4'))
        for jobs in '1', '3':
            self.assert_refused(SHAPES + MOTIONS + ('--jobs', jobs), 'shapes/1.obj:6', '2 4 3', output=before)
        self.write('shapes/0.obj', 'v 0 0 0\n')
        self.assert_refused(SHAPES + MOTIONS, 'shapes/0.obj:1', 'f line')

    def test_opengl_that_does_not_work(self):
        """A forward compatible context has no picking mode. Mesa ends the process if it does not know the driver."""
        for options in (), ('--picker', 'select'), ('--jobs', '3'):
            self.assert_refused(FILES + options, 'query_offline', 'OpenGL', status=1, MESA_GL_VERSION_OVERRIDE='3.2FC')
        for driver in 'nonsense', 'zink':
            self.assert_refused(FILES, 'query_offline', 'GALLIUM_DRIVER is "%s"' % driver, 'llvmpipe', status=1,
                                GALLIUM_DRIVER=driver)
            done = self.run_program(*FILES, '--picker', 'cpu', GALLIUM_DRIVER=driver)
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_stdout_that_cannot_be_written(self):
        reader, writer = os.pipe()
        os.close(reader)
        for stdout, reason in (open('/dev/full', 'w'), 'No space left on device'), (os.fdopen(writer, 'w'), 'Broken pipe'):
            with stdout:
                done = subprocess.run([PROGRAM, *FILES], cwd=self.folder, stdout=stdout, stderr=subprocess.PIPE, text=True,
                                      timeout=100)
                self.assertEqual(done.returncode, 1)
                self.assertEqual(done.stderr.splitlines()[-1], 'query_offline: stdout cannot be written: ' + reason)


if __name__ == '__main__':
    unittest.main()
