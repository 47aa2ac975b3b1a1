#!/usr/bin/python3
"""What programs refuse: the exit status, and one line on stderr that says where and what. There is a table for each program."""

import os
import shlex
import subprocess
import unittest

from program import PROGRAM, ProgramCase, motions_text

ORGAN = 'v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0.1 0.1 0.01\nf 1 2 3\nf 2 4 3\n'
MOTION = '%s,swept,0,0,0.2,0.02,0.02,0.1,0.03,0.02,-0.01,0.005'
MESH, MOTIONS = '--mesh organ.obj', ' --motions motions.csv'
FILES = MESH + MOTIONS

# Arguments, how the line begins, and words in it.
QUERY_OFFLINE = [
    ('--mesh broken.obj' + MOTIONS, 'broken.obj:4', 'a coordinate is nan; must be finite'),
    ('--mesh none.obj' + MOTIONS, 'none.obj', 'no such file'),
    ('--mesh .' + MOTIONS, '.', 'it is a folder'),
    (MESH + ' --motions broken.csv', 'broken.csv:3', 'query "1"', 'line 2'),
    (MESH + ' --motions short.csv --jobs 3', 'short.csv:3', 'trocar', 'tip'),
    (MESH + ' --motions none.csv', 'none.csv', 'No such file'),
    (FILES + ' --mesh-before other.obj', 'other.obj', 'face 1', '1 2 3', '1 3 2', 'organ.obj'),
    (FILES + ' --mesh-before fewer.obj', 'fewer.obj', 'has 4 vertices and 1 faces; organ.obj has 4 vertices and 2 faces'),
    (FILES + ' --shapes organ.obj', 'query_offline', '--shapes is gone; give each step its --mesh and --mesh-before'),
    (FILES + ' --gl egl', 'query_offline', '--gl is gone'),
    (MESH, 'query_offline', '--motions', 'missing'),
    (MOTIONS, 'query_offline', "the option '--mesh' is required but missing (--help explains)"),
    (FILES + ' --fast', 'query_offline', "unrecognised option '--fast' (--help explains)"),
    (FILES + ' --marg 1', 'query_offline', "unrecognised option '--marg'"),
    (FILES + ' more.csv', 'query_offline', 'too many positional options'),
    (FILES + ' ' + MESH, 'query_offline', "option '--mesh' cannot be specified more than once"),
    (FILES + ' --picker', 'query_offline', "the required argument for option '--picker' is missing"),
    (FILES + ' --picker embree', 'query_offline', 'embree', 'feedback', 'select', 'cpu')] + [
    (FILES + ' --jobs ' + text, 'query_offline', '--jobs is %s; must be from 1 to 1024' % text) for text in ('0', '-2', '1025')] + [
    (FILES + ' --margin ' + text, 'query_offline', '--margin is %s; must be a finite number above 0, in metres' % text)
    for text in ('-0.01', '0', 'nan', 'inf')] + [
    (FILES + ' --%s %s' % option, 'query_offline', "the argument ('%s') for option '--%s' is invalid" % option[::-1])
    for option in (('jobs', '1.5'), ('jobs', 'all'), ('jobs', '99999999999999999999'), ('margin', '2mm'), ('margin', '1,5'))]

REPLAY = [
    ('', 'replay', 'IN.bag'),
    ('--parameters p.yaml in.bag', 'replay', 'OUT.bag'),
    ('in.bag out.bag', 'replay', '--parameters'),
    ('--parameters p.yaml in.bag out.bag x', 'replay', 'too many positional options'),
    ('--with-input --parameters p.yaml in.bag out.bag', 'replay', '--with-input is gone; `rosbag play'),
    ('--parameters p.yaml --node ~x in.bag out.bag', 'replay', '"~x"'),
    ('--parameters p.yaml --node "a b" in.bag out.bag', 'replay', '"a b"'),
    ('--parameters p.yaml in.bag in.bag', 'replay', 'also the input'),
    ('--parameters p.yaml x.bag.incomplete x.bag', 'replay', 'also the input'),
    ('--parameters none.yaml in.bag out.bag', 'none.yaml', 'cannot be opened')]


class CommandLinesTest(ProgramCase):
    def setUp(self):
        super().setUp()
        for name, text in (
            ('organ.obj', ORGAN),
            ('other.obj', ORGAN.replace('f 2 4 3', 'f 2 3 4')),
            ('fewer.obj', ORGAN.replace('f 2 4 3', '')),
            ('broken.obj', ORGAN.replace('0.01', 'nan')),
            ('motions.csv', motions_text([MOTION % 1, MOTION % 2])),
            ('broken.csv', motions_text([MOTION % 1, MOTION % 1])),
            ('short.csv', motions_text([MOTION % 1, '2,paper_swept,0,0,1,0,0,1,0,0,1,0.005'])),
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
        for name, rows in ('QUERY_OFFLINE', QUERY_OFFLINE), ('REPLAY', REPLAY):
            for row in rows:
                self.assert_refused(*row, program=os.environ[name])
        self.assertEqual(sorted(self.folder.iterdir()), before)
        self.assertEqual((self.folder / 'x.bag.incomplete').read_text(), 'kept')

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
        commands = [(name, [os.environ[name.upper()], '--help']) for name in ('query_offline', 'replay')]
        commands += [('query_offline', [PROGRAM, *shlex.split(FILES)]), ('tool_guard', [os.environ['NODE'], '--help'])]
        for stdout, reason in (open('/dev/full', 'w'), 'No space left on device'), (os.fdopen(writer, 'w'), 'Broken pipe'):
            with stdout:
                for name, command in commands:
                    if reason == 'Broken pipe' and name == 'tool_guard':
                        continue  # Like most programs, it ends silently when its reader has gone.
                    done = subprocess.run(command, cwd=self.folder, stdout=stdout, stderr=subprocess.PIPE, text=True, timeout=100)
                    self.assertEqual(done.returncode, 1, command)
                    self.assertRegex(done.stderr.splitlines()[-1],
                                     '^%s: stdout cannot be written(: %s)?$' % (name, reason), command)


if __name__ == '__main__':
    unittest.main()
