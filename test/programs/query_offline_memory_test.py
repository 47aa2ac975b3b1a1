#!/usr/bin/python3
"""Memory does not grow with the answers, and with motions only if they are in a file."""

import os
import subprocess
import unittest

from program import PROGRAM, ProgramCase, motion_line, obj_text
from support import scenes

FEW, MANY = 2000, 100000  # motions
MIB = 1 << 20
ANSWERS = 70 * MIB  # The answers to many motions are at least as large.
GROWTH = {'-': 16 * MIB, 'motions.csv': 32 * MIB}  # less than the answers; a motion of a file takes some 150 bytes


class MemoryTest(ProgramCase):
    def setUp(self):
        super().setUp()
        self.write('organ.obj', obj_text(scenes.sheet(0.1, 5)))

    def write_motions(self, count):
        motion = motion_line('', 'swept', (0.01, 0.02, 0.2), (0.0, 0.03, 0.01), (0.02, 0.01, -0.01), 0.005)
        self.write('motions.csv', ''.join(str(query) + motion + '\n' for query in range(count)))

    def run_and_measure(self, motions):
        """The size of the answers, and the most memory that the program had [bytes]."""
        with open(self.folder / 'motions.csv') as file, open(self.folder / 'answers.csv', 'w') as answers:
            process = subprocess.Popen([PROGRAM, '--mesh', 'organ.obj', '--motions', motions, '--jobs', '2'],
                                       cwd=self.folder, stdin=file, stdout=answers, stderr=subprocess.DEVNULL)
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = status  # It was waited for.
        self.assertEqual(status, 0)
        return os.path.getsize(self.folder / 'answers.csv'), usage.ru_maxrss * 1024

    def test_memory_of_many_motions(self):
        for motions, growth in GROWTH.items():
            self.write_motions(FEW)
            _, with_few = self.run_and_measure(motions)
            self.write_motions(MANY)
            answers, with_many = self.run_and_measure(motions)
            self.assertGreater(answers, ANSWERS)
            self.assertLess(with_many - with_few, growth, motions)


if __name__ == '__main__':
    unittest.main()
