#!/usr/bin/python3
"""--motions -: motions from standard input are answered at once, in their order."""

import os
import re
import select
import subprocess
import time
import unittest

from program import CONTACTS_HEADER, PROGRAM, ProgramCase, motion_line, motions_text, obj_text
from support import scenes

FILES = ('--mesh', 'organ.obj', '--motions', '-')
TROCAR, BEFORE, TIP = (0.01, 0.02, 0.2), (0.0, 0.03, 0.01), (0.02, 0.01, -0.01)
ABOVE = (0.0, 0.031, 0.011)  # a tip that touches nothing
LIMIT = 60.0  # [s] for one answer


def line(query, tip=TIP):
    return motion_line(query, 'swept', TROCAR, BEFORE, tip, 0.005) + '\n'


def without_progress(error):
    """What the program says on stderr besides its progress, which it prints once a second."""
    return re.sub(r'^query_offline: \d+ motions\n', '', error, flags=re.M)


class Conversation:
    """The program with a pipe into it and one out of it. A line that does not come raises an error."""

    def __init__(self, folder, *options, blocks=True):
        reader, self.writer = os.pipe()
        os.set_blocking(reader, blocks)
        self.process = subprocess.Popen([PROGRAM, *FILES, *options], cwd=folder, bufsize=0, stdin=reader,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        os.close(reader)
        self.arrived = b''

    def write(self, text):
        os.write(self.writer, text.encode())

    def line(self):
        """The next line that the program prints; without a line feed at the end of its output."""
        deadline = time.monotonic() + LIMIT
        while b'\n' not in self.arrived:
            if not select.select([self.process.stdout], [], [], deadline - time.monotonic())[0]:
                raise TimeoutError('no line in %g s' % LIMIT)
            piece = os.read(self.process.stdout.fileno(), 1 << 16)
            if not piece:
                break
            self.arrived += piece
        line, feed, self.arrived = self.arrived.partition(b'\n')
        return (line + feed).decode()

    def answer(self):
        """The lines up to the next blank line."""
        return list(iter(self.line, '\n'))

    def is_silent(self):
        """Whether nothing has been printed that was not read."""
        return not self.arrived and not select.select([self.process.stdout], [], [], 0.0)[0]

    def end(self):
        """What is left of the output, stderr without progress, and the exit status, when there is no more input."""
        os.close(self.writer)
        rest, error = self.process.communicate(timeout=LIMIT)
        return (self.arrived + rest).decode(), without_progress(error.decode()), self.process.returncode


class StreamTest(ProgramCase):
    def setUp(self):
        super().setUp()
        self.write('organ.obj', obj_text(scenes.sheet(0.1, 5)))

    def start(self, *options, **named):
        talk = Conversation(self.folder, *options, **named)
        self.addCleanup(talk.process.kill)
        return talk

    def from_file(self, text, *options):
        self.write('motions.csv', text)
        done = self.run_program('--mesh', 'organ.obj', '--motions', 'motions.csv', *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def piped(self, text, *options):
        done = self.run_program(*FILES, *options, text=text)
        return done.stdout, without_progress(done.stderr), done.returncode

    def test_each_answer_comes_before_the_next_motion(self):
        for jobs in '1', '3':
            talk = self.start('--jobs', jobs, blocks=jobs == '1')
            self.assertEqual(talk.line(), CONTACTS_HEADER + '\n')
            for query in 'stab', '7', '3':
                right = self.from_file(line(query)).splitlines(True)[1:]
                self.assertGreater(len(right), 3)
                talk.write(line(query))
                self.assertEqual([talk.line() for _ in right], right)
            self.assertEqual(talk.end(), ('', '', 0))

    def test_blank_lines_tell_where_an_answer_ends(self):
        """A motion is answered while the line of the next one is incomplete. Blank lines of the input change nothing."""
        talk = self.start('--blank-lines')
        self.assertEqual(talk.line(), CONTACTS_HEADER + '\n')
        lines = [line(query, tip) + '\n \n' for query, tip in enumerate([TIP, ABOVE, TIP, ABOVE])]
        talk.write(lines[0][:40])
        for query, tip in enumerate([TIP, ABOVE, TIP, ABOVE]):
            self.assertTrue(talk.is_silent())
            talk.write(lines[query][40:] + ''.join(lines[query + 1:query + 2])[:40])
            answer = talk.answer()
            self.assertEqual(answer, self.from_file(lines[query]).splitlines(True)[1:])
            self.assertEqual(bool(answer), tip == TIP)
        self.assertEqual(talk.end(), ('', '', 0))

    def test_the_same_bytes_as_from_a_sorted_file(self):
        text = motions_text([]) + ''.join(line(i, (0.02, 0.01, -1e-5 * i)) for i in range(3000))
        right = self.from_file(text)
        for jobs in '1', '2', '7':
            self.assertEqual(self.piped(text, '--jobs', jobs), (right, '', 0))

    def test_a_reader_that_goes_away(self):
        talk = self.start()
        talk.line()
        talk.process.stdout.close()
        talk.write(line(1))
        self.assertEqual(talk.process.wait(LIMIT), 1)
        self.assertEqual(talk.process.stderr.read(), b'query_offline: stdout cannot be written: Broken pipe\n')


if __name__ == '__main__':
    unittest.main()
