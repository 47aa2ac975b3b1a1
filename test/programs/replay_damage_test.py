#!/usr/bin/python3
"""Damaged bags, and disks that are full: replay answers, or says one line, and is never ended by a signal."""

import multiprocessing.pool
import os
import random
import re
import resource
import subprocess
import unittest

from support.tool_over_sheet import SHEET, at_height

from recording import messages, ReplayCase, TOOLS

PARAMETERS = 'picker: cpu\n' + TOOLS  # OpenGL would only take time.


def numbers_of_records(data, begin, end):
    """The places of all bytes in a bag that are lengths of records, or data of an index."""
    while begin < end:
        after_header = begin + 4 + int.from_bytes(data[begin:begin + 4], 'little')
        header, content = data[begin + 4:after_header], after_header + 4
        next_record = content + int.from_bytes(data[after_header:content], 'little')
        yield from [*range(begin, begin + 4), *range(after_header, content)]
        if b'op=\x04' in header:
            yield from range(content, next_record)
        if b'compression=none' in header:
            yield from numbers_of_records(data, content, next_record)
        begin = next_record


class DamageTest(ReplayCase):
    def record_scene(self, compression='none'):
        with self.record(compression=compression) as bag:
            bag.resting(1.0)
            for i in range(6):
                bag.tool(2.0 + 0.1 * i, at_height(0.01 - 0.002 * i))
                (bag.vertices if i else bag.mesh)(2.0 + 0.1 * i, SHEET)

    def mutants(self):
        """64 bags in which one byte has changed: anywhere, or in one of the numbers by which the library finds its way."""
        for compression in 'none', 'bz2':
            self.record_scene(compression)
            with open(self.recorded, 'rb') as file:
                data = file.read()
            numbers = list(numbers_of_records(data, data.index(b'\n') + 1, len(data)))
            chance = random.Random(7)
            for number in range(32):
                place = chance.choice(numbers) if number % 4 else chance.randrange(len(data))
                yield data[:place] + bytes([data[place] ^ chance.randrange(1, 256)]) + data[place + 1:]

    def replay_mutant(self, number, mutant):
        bag, answers = 'in%d.bag' % number, 'out%d.bag' % number
        self.write(bag, mutant)
        return answers, self.run_program('--parameters', 'parameters.yaml', bag, answers, program=os.environ['REPLAY'])

    def test_a_changed_byte_gives_answers_or_one_line(self):
        self.write('parameters.yaml', PARAMETERS)
        with multiprocessing.pool.ThreadPool(2) as pool:
            done = pool.starmap(self.replay_mutant, enumerate(self.mutants()))
        self.assertEqual(len(done), 64)
        ended = []
        for number, (answers, result) in enumerate(done):
            with self.subTest(mutant=number):
                said = result.stderr
                self.assertIn(result.returncode, (0, 1, 2), said)
                self.assertEqual(os.path.exists(self.path(answers)), result.returncode == 0, said)
                self.assertFalse(os.path.exists(self.path(answers + '.incomplete')))
                lines = [line for line in said.splitlines() if 'WARN' not in line]
                if result.returncode:
                    self.assertEqual(len(lines), 1, said)
                self.assertEqual([line for line in lines if not re.match(r'in\d+\.bag: |replay: ', line)], [], said)
                ended.append(result.returncode)
        self.assertGreater(min(ended.count(0), ended.count(2)), 3, ended)
        self.assertLess(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss, 2**20)  # [KiB]

    def test_a_disk_that_is_full(self):
        """The limit of a file's size is reached when the bag is opened, written or closed. If the signal of the limit is not
        ignored, it ends the process."""
        self.record_scene()
        self.write('parameters.yaml', PARAMETERS)
        for trap, blocks, words in [("trap '' XFSZ", blocks, 'out.bag: cannot be written: File too large')
                                    for blocks in (0, 1, 9, 12)] + [('true', 1, 'ended by signal')]:
            done = self.run_program('-c', '%s; ulimit -f %d; exec "$REPLAY" --parameters parameters.yaml --with-input '
                                    'in.bag out.bag' % (trap, blocks), program='/bin/sh')
            self.assertEqual((done.returncode in (1, 2), done.stdout), (True, ''), done.stderr)
            self.assertRegex(done.stderr, r'\A.*%s.*\n\Z' % words)
            self.assertEqual(sorted(os.listdir(self.folder)), ['in.bag', 'parameters.yaml'])

    def test_a_full_stdout(self):
        """The answers are there all the same."""
        self.record_scene()
        self.write('parameters.yaml', PARAMETERS)
        with open('/dev/full', 'w') as full:
            done = subprocess.run([os.environ['REPLAY'], '--parameters', 'parameters.yaml', 'in.bag', 'out.bag'], cwd=self.folder,
                                  stdout=full, stderr=subprocess.PIPE, text=True)
        self.assertEqual((done.returncode, done.stderr), (1, 'replay: stdout cannot be written: No space left on device\n'))
        self.assertEqual(len(messages(self.answers)), 6)


if __name__ == '__main__':
    unittest.main(verbosity=2)
