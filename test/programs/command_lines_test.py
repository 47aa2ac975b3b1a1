#!/usr/bin/python3
"""What programs refuse: the exit status, and one line on stderr that says where and what. There is a table for each program."""

import os
import shlex
import subprocess
import unittest

from program import CONTACTS_HEADER, PROGRAM, ProgramCase, motions_text

ORGAN = 'v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0.1 0.1 0.01\nf 1 2 3\nf 2 4 3\n'
MOTION = '%s,swept,0,0,0.2,0.02,0.02,0.1,0.03,0.02,-0.01,0.005'
MESH, MOTIONS, SHAPES = '--mesh organ.obj', ' --motions motions.csv', '--shapes shapes'
FILES = MESH + MOTIONS

# Arguments, how the line begins, and words in it.
QUERY_OFFLINE = [
    ('--mesh broken.obj' + MOTIONS, 'broken.obj:4', '"nan"'),
    ('--mesh none.obj' + MOTIONS, 'none.obj', 'No such file'),
    ('--mesh .' + MOTIONS, '.', 'Is a directory'),
    (FILES + ' --mesh-before other.obj', 'other.obj:6', '2 3 4', '2 4 3', 'organ.obj'),
    (MESH + ' --motions broken.csv', 'broken.csv:3', 'query "1"', 'line 2'),
    (MESH + ' --motions short.csv --jobs 3', 'short.csv:3', 'trocar', 'tip'),
    (MESH + ' --motions none.csv', 'none.csv', 'No such file'),
    ('--shapes none' + MOTIONS, 'none', 'No such file'),
    ('--shapes organ.obj' + MOTIONS, 'organ.obj', 'cannot be read: Not a directory'),
    ('--shapes empty' + MOTIONS, 'empty', 'no OBJ file'),
    ('', 'query_offline', 'option --mesh is missing'),
    (MESH, 'query_offline', '--motions', 'missing'),
    (MOTIONS, 'query_offline', '--mesh', 'missing'),
    ('--mesh' + MOTIONS, 'query_offline', 'option --mesh has no value (--help explains)'),
    (FILES + ' --fast', 'query_offline', 'unknown option "--fast"; legal are --mesh, --motions, --mesh-before, --shapes, --jobs, '
     '--picker, --gl, --margin, --clearance, --placement, --blank-lines and --help (--help explains)'),
    (FILES + ' --marg 1', 'query_offline', 'unknown option "--marg"'),
    (FILES + ' more.csv', 'query_offline', 'unknown argument "more.csv"'),
    (FILES + ' ' + MESH, 'query_offline', "option '--mesh' cannot be specified more than once"),
    (FILES + ' --picker', 'query_offline', "the required argument for option '--picker' is missing"),
    (FILES + ' --picker embree', 'query_offline', 'embree', 'feedback', 'select', 'cpu'),
    (FILES + ' --gl glx', 'query_offline', 'glx', 'auto', 'osmesa', 'egl'),
    (SHAPES + ' ' + FILES, 'query_offline', '--shapes', '--mesh', 'all shapes')] + [
    (FILES + ' --jobs ' + text, 'query_offline', '"%s"; must be a whole number from 1 to 1024' % text)
    for text in ('0', '-2', '1.5', 'all', '1025', '99999999999999999999')] + [
    (FILES + ' --margin ' + text, 'query_offline', '"%s"; must be a finite number above 0, in metres' % text)
    for text in ('-0.01', '0', 'nan', 'inf', '1e999', '2mm', '1,5')]

SNAPSHOT = [
    ('--size 800', 'snapshot', '--size is "800"; must be WIDTHxHEIGHT, each from 16 to 4096'),
    ('--size 800x5000', 'snapshot', '"800x5000"'),
    ('--size 80.5x80', 'snapshot', '"80.5x80"'),
    ('--view 1', 'snapshot', '--view is "1"; must be AZIMUTH,ELEVATION in degrees, or X,Y,Z'),
    ('--view 0,0,0', 'snapshot', '"0,0,0"', 'not all 0'),
    ('--target 1,2,x', 'snapshot', '--target is "1,2,x"; must be X,Y,Z'),
    ('--target 1,2,3,', 'snapshot', '"1,2,3,"'),
    ('--background white', 'snapshot', '--background is "white"; must be #RRGGBB'),
    ('--frames 0', 'snapshot', '--frames is "0"; must be a whole number from 1 to 9999'),
    ('--rate nan', 'snapshot', '--rate is "nan"; must be a number from 0.01 to 1000'),
    ('--distance -1', 'snapshot', '--distance is "-1"'),
    ('--siz 20x20', 'snapshot', 'unknown option "--siz"', '--topic', '--timeout')]

REPLAY = [
    ('', 'replay', 'IN.bag'),
    ('in.bag', 'replay', 'IN.bag'),
    ('in.bag out.bag', 'replay', '--parameters'),
    ('--parameters p.yaml in.bag out.bag x', 'replay', '3 are given'),
    ('--parameters "" in.bag out.bag', 'replay', '--parameters is ""; must be a text'),
    ('--with-input=1 --parameters p.yaml in.bag out.bag', 'replay', "'--with-input' does not take any arguments"),
    ('--parameters p.yaml --node ~x in.bag out.bag', 'replay', '"~x"'),
    ('--parameters p.yaml --node "a b" in.bag out.bag', 'replay', '"a b"'),
    ('--parameters p.yaml in.bag in.bag', 'replay', 'also the input'),
    ('--parameters p.yaml x.bag.incomplete x.bag', 'replay', 'also the input'),
    ('--parameters none.yaml in.bag out.bag', 'none.yaml', 'cannot be opened')]


class CommandLinesTest(ProgramCase):
    def setUp(self):
        super().setUp()
        (self.folder / 'shapes').mkdir()
        (self.folder / 'empty').mkdir()
        for name, text in (
            ('organ.obj', ORGAN),
            ('other.obj', ORGAN.replace('f 2 4 3', 'f 2 3 4')),
            ('broken.obj', ORGAN.replace('0.01', 'nan')),
            ('motions.csv', motions_text([MOTION % 1, MOTION % 2])),
            ('broken.csv', motions_text([MOTION % 1, MOTION % 1])),
            ('short.csv', motions_text([MOTION % 1, '2,paper_swept,0,0,1,0,0,1,0,0,1,0.005'])),
            ('shapes/0.obj', ORGAN), ('shapes/1.obj', ORGAN),
            ('p.yaml', 'tools: []\n'), ('in.bag', 'kept'), ('x.bag.incomplete', 'kept'),
        ):
            self.write(name, text)

    def assert_refused(self, arguments, beginning, *words, status=2, output='', **named):
        with self.subTest(arguments):
            done = self.run_program(*shlex.split(arguments), **named)
            said = 'stderr: ' + done.stderr
            self.assertEqual((done.returncode, done.stdout), (status, output), said)
            self.assertRegex(done.stderr, r'\A%s: .*\n\Z' % beginning, said)
            for word in words:
                self.assertIn(word, done.stderr)

    def test_what_is_refused(self):
        before = sorted(self.folder.iterdir())
        self.assertEqual(self.run_program(*shlex.split(FILES)).returncode, 0)
        for name, rows in ('QUERY_OFFLINE', QUERY_OFFLINE), ('SNAPSHOT', SNAPSHOT), ('REPLAY', REPLAY):
            for row in rows:
                self.assert_refused(*row, program=os.environ[name])
        self.assertEqual(sorted(self.folder.iterdir()), before)
        self.assertEqual((self.folder / 'x.bag.incomplete').read_text(), 'kept')

    def test_legal_options_of_snapshot(self):
        """They are followed by the lack of a ROS master."""
        for options in (
            '', '--topic /a --topic=/b --hide surface --hide=names --output x.png --frame world',
            '--size 640x480 --target -0.1,0.2,3e-1 --distance 0.4 --view -3,0,4', '--view "0, 30" __name:=other',
            '--background #ff8000 --after 0 --frames 12 --rate 25 --timeout 3.5',
        ):
            self.assert_refused(options, 'snapshot', 'there is no ROS master', program=os.environ['SNAPSHOT'], status=1)

    def test_help_alone_matters(self):
        for name, words in (
            ('QUERY_OFFLINE', '--mesh --shapes --motions --jobs --picker --gl --margin --blank-lines'),
            ('REPLAY', 'IN.bag OUT.bag --parameters --node --with-input'),
            ('SNAPSHOT', '--topic --hide --frame --after --timeout --view --target --distance --output --size --background '
                         '--frames --rate'),
        ):
            for arguments in ['-h'], ['--size', 'nonsense', '--help']:
                done = self.run_program(*arguments, program=os.environ[name])
                self.assertEqual((done.returncode, done.stderr), (0, ''))
                for word in words.split():
                    self.assertIn(word + ' ', done.stdout)

    def test_as_many_motions_as_shapes(self):
        self.write('shapes/2.obj', ORGAN)
        self.assert_refused(SHAPES + MOTIONS, 'motions.csv', '2 motions', '3 OBJ files')
        right = self.run_program(*shlex.split(FILES)).stdout
        for motions, said in (
            (2, 'standard input: the motions end; shapes without a motion: 1; each shape needs one\n'),
            (4, 'standard input:4: there is no shape for this motion; must have as many shapes\n'),
        ):
            text = ''.join(MOTION % (i + 1) + '\n' for i in range(motions))
            done = self.run_program(*shlex.split(SHAPES + ' --motions -'), text=text)
            self.assertEqual((done.returncode, done.stderr), (2, said))
            self.assertTrue(done.stdout.startswith(right))

    def test_a_bad_later_shape(self):
        """The steps before it are answered."""
        right = self.run_program(*shlex.split(FILES)).stdout
        before = ''.join(row for row in right.splitlines(True) if row[0] != '2')
        self.assertTrue(before.startswith(CONTACTS_HEADER) and before != right)
        self.write('shapes/1.obj', ORGAN.replace('f 2 4 3', 'f 2 3 4'))
        for jobs in '1', '3':
            self.assert_refused(SHAPES + MOTIONS + ' --jobs ' + jobs, 'shapes/1.obj:6', '2 4 3', output=before)
        self.write('shapes/0.obj', 'v 0 0 0\n')
        self.assert_refused(SHAPES + MOTIONS, 'shapes/0.obj:1', 'f line')

    def test_opengl_that_does_not_work(self):
        """A forward compatible context has no picking mode. Mesa ends the process if it does not know the driver."""
        for options in '', ' --picker select', ' --jobs 3':
            self.assert_refused(FILES + options, 'query_offline', 'OpenGL', status=1, MESA_GL_VERSION_OVERRIDE='3.2FC')
        for driver in 'nonsense', 'zink':
            self.assert_refused(FILES, 'query_offline', 'GALLIUM_DRIVER is "%s"' % driver, 'llvmpipe', status=1,
                                GALLIUM_DRIVER=driver)
            done = self.run_program(*shlex.split(FILES), '--picker', 'cpu', GALLIUM_DRIVER=driver)
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_stdout_that_cannot_be_written(self):
        """Of the programs that end by themselves, and of a node's --help."""
        reader, writer = os.pipe()
        os.close(reader)
        commands = [(name, [os.environ[name.upper()], '--help']) for name in ('query_offline', 'replay', 'snapshot')]
        commands += [('query_offline', [PROGRAM, *shlex.split(FILES)]), ('organ_mesh_adapter', [os.environ['NODE'], '--help'])]
        for stdout, reason in (open('/dev/full', 'w'), 'No space left on device'), (os.fdopen(writer, 'w'), 'Broken pipe'):
            with stdout:
                for name, command in commands:
                    if reason == 'Broken pipe' and name in ('snapshot', 'organ_mesh_adapter'):
                        continue  # Like most programs, they end silently when their reader has gone.
                    done = subprocess.run(command, cwd=self.folder, stdout=stdout, stderr=subprocess.PIPE, text=True, timeout=100)
                    self.assertEqual(done.returncode, 1, command)
                    self.assertRegex(done.stderr.splitlines()[-1],
                                     '^%s: stdout cannot be written(: %s)?$' % (name, reason), command)


if __name__ == '__main__':
    unittest.main()
