#!/usr/bin/python3
"""Bad input: exit status 2, one line on stderr that says where and what, nothing on stdout."""

from program import MOTIONS_HEADER, ProgramCase, motions_text

import unittest

VERTICES = 'v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0.1 0.1 0.01\n'
ORGAN = VERTICES + 'f 1 2 3\nf 2 4 3\n'
MOTION = '1,swept,0,0,0.2,0.02,0.02,0.1,0.03,0.02,-0.01,0.005'
FILES = ('--mesh', 'organ.obj', '--motions', 'motions.csv')


class InputTest(ProgramCase):
    def setUp(self):
        super().setUp()
        self.write('organ.obj', ORGAN)
        self.write('motions.csv', motions_text([MOTION]))

    def assert_refused(self, beginning, *words, arguments=FILES):
        done = self.run_program(*arguments)
        said = 'stderr: ' + done.stderr
        self.assertEqual((done.returncode, done.stdout), (2, ''), said)
        self.assertEqual(done.stderr.count('\n'), 1, said)
        self.assertTrue(done.stderr.startswith(beginning + ': ') and done.stderr.endswith('\n'), said)
        for word in words:
            self.assertIn(word, done.stderr)

    def test_good_input_is_not_refused(self):
        done = self.run_program(*FILES)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater(done.stdout.count('\n'), 1)

    def test_drivers_of_opengl(self):
        """Mesa ends the process if it does not know the driver."""
        for driver in ('nonsense', 'zink', 'swr'):
            done = self.run_program(*FILES, GALLIUM_DRIVER=driver)
            self.assertEqual((done.returncode, done.stdout), (1, ''), done.stderr)
            self.assertRegex(done.stderr, '^query_offline: .*GALLIUM_DRIVER is "%s".*llvmpipe.*softpipe.*\n$' % driver)
            done = self.run_program(*FILES, '--picker', 'cpu', GALLIUM_DRIVER=driver)
            self.assertEqual(done.returncode, 0, done.stderr)
        for driver in ('llvmpipe', 'softpipe', ''):
            done = self.run_program(*FILES, GALLIUM_DRIVER=driver)
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_meshes(self):
        for text, line, *words in [
                ('', 1, 'f line'),
                (VERTICES, 4, 'f line'),
                (b'\x00\x01\x02 f 1 2 3', 1, 'f line'),
                (VERTICES + 'f 1 2 3\nf 2 4 5\n', 6, 'vertex 5', '4'),
                (VERTICES + 'f 1 2 0\n', 5, 'vertex 0', 'from 1'),
                (VERTICES + 'f 1 2 -5\n', 5, 'vertex -5', '-4'),
                (VERTICES + 'f 1 2 99999999999\n', 5, '99999999999'),
                (VERTICES + 'f 1 2 x/1/1\n', 5, '"x/1/1"'),
                (VERTICES + 'f 1 2 3\nf 1 2\n', 6, '2 corners', '3'),
                ('v 0 0 0\nv 0 nan 0\n' + ORGAN, 2, 'y', '"nan"', 'finite'),
                ('v 0 0 0\nv 0 0 -inf\n' + ORGAN, 2, 'z', '"-inf"', 'finite'),
                ('v 1e39 0 0\n' + ORGAN, 1, 'x', '"1e39"', 'finite'),
                ('v 1e7 0 0\n' + ORGAN, 1, 'x', '"1e7"', '1e6 m'),
                ('v 0 zero 0\n' + ORGAN, 1, 'y', '"zero"', 'number'),
                ('\r\nv 0 0\r\n' + ORGAN, 2, '2 coordinates')]:
            with self.subTest(text=text):
                self.write('organ.obj', text)
                self.assert_refused('organ.obj:%d' % line, *words)

    def test_earlier_meshes(self):
        for text, line, *words in [
                ('', 1, 'f line'),
                (VERTICES + 'f 1 2 3\n', 5, '4 vertices', '1 faces', '2 faces', 'organ.obj'),
                ('v 0 0 0\n' + ORGAN, 7, '5 vertices', '4 vertices', 'organ.obj'),
                (VERTICES + 'f 1 2 3\nf 2 3 4\n', 6, '2 3 4', '2 4 3', 'organ.obj'),
                (ORGAN.replace('0.01', 'nan'), 4, '"nan"')]:
            with self.subTest(text=text):
                self.write('old.obj', text)
                self.assert_refused('old.obj:%d' % line, *words,
                                    arguments=FILES + ('--mesh-before', 'old.obj'))

    def test_motions(self):
        def cells(**changed):
            names = MOTIONS_HEADER.split(',')
            return ','.join(changed.get(name, cell) for name, cell in zip(names, MOTION.split(',')))

        for text, line, *words in [
                ('', 1, 'motion'),
                (motions_text([]), 1, 'motion'),
                (motions_text(['', '', '']), 4, 'motion'),
                (MOTIONS_HEADER.replace('tip_x,tip_y', 'tip_y,tip_x') + '\n', 1, 'header', MOTIONS_HEADER),
                ('a,b\n', 1, '2 columns', '12')] + [
                (motions_text([MOTION, line]), 3, *words) for line, *words in [
                    ('2' + MOTION[1:] + ',7', '13 columns', '12'),
                    ('2,swept,1,2,3', '5 columns', '12'),
                    (MOTION, 'query "1"', 'line 2'),
                    (cells(query=''), 'query'),
                    (cells(query='2', mode='sweep'), '"sweep"', 'static', 'swept', 'paper_static',
                     'paper_swept', 'paper_naive'),
                    (cells(query='2', mode=''), 'mode', '""'),
                    (cells(query='2', trocar_x='one'), 'trocar_x', '"one"', 'number'),
                    (cells(query='2', previous_y=''), 'previous_y', '""', 'number'),
                    (cells(query='2', tip_z='nan'), 'tip_z', '"nan"', 'finite'),
                    (cells(query='2', tip_z='1e999'), 'tip_z', '"1e999"', 'finite'),
                    (cells(query='2', tip_z='1e7'), '1e+07', '1e+06 m'),
                    (cells(query='2', radius='inf'), 'radius', '"inf"', 'finite'),
                    (cells(query='2', radius='0'), 'radius', '"0"', 'above 0'),
                    (cells(query='2', radius='-0.005'), 'radius', '"-0.005"', 'above 0')]]:
            with self.subTest(text=text):
                self.write('motions.csv', text)
                self.assert_refused('motions.csv:%d' % line, *words)

    def test_tools_without_length_in_the_papers_modes(self):
        for mode in 'paper_static', 'paper_swept', 'paper_naive':
            with self.subTest(mode=mode):
                line = '2,%s,0,0,0.2,0,0,0.2,0,0,0.2,0.005' % mode
                self.write('motions.csv', motions_text([MOTION, line]))
                self.assert_refused('motions.csv:3', 'trocar', 'tip')

    def test_files_that_are_missing_or_unreadable(self):
        for name in '--mesh', '--motions', '--mesh-before':
            arguments = dict(zip(FILES[::2], FILES[1::2]))
            for file, words in ('none.obj', 'No such file'), ('.', 'Is a directory'):
                with self.subTest(name=name, file=file):
                    arguments[name] = file
                    given = [word for pair in arguments.items() for word in pair]
                    self.assert_refused(file, words, arguments=given)

    def test_options(self):
        for arguments, *words in [
                ((), '--mesh', 'missing'),
                (FILES[:2], '--motions', 'missing'),
                (FILES[2:], '--mesh', 'missing'),
                (FILES + ('--fast',), '"--fast"', '--mesh-before', '--picker'),
                (FILES + ('more.csv',), '"more.csv"'),
                (FILES + ('--mesh', 'organ.obj'), '--mesh', 'twice'),
                (FILES + ('--picker',), '--picker', 'no value'),
                (FILES + ('--picker', 'embree'), 'embree', 'feedback', 'select', 'cpu'),
                (FILES + ('--gl', 'glx'), 'glx', 'auto', 'osmesa', 'egl')]:
            with self.subTest(arguments=arguments):
                self.assert_refused('query_offline', *words, arguments=arguments)


if __name__ == '__main__':
    unittest.main()
