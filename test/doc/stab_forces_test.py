#!/usr/bin/python3
"""The figure stab_forces of doc/haptics.md shows what the package computes, and the page says what the figure shows.

Usage: stab_forces_test.py SOURCE_FOLDER PROGRAM
"""

import csv
import os
import subprocess
import sys
import unittest

SOURCE, PROGRAM = sys.argv[1:3]
STIFFNESS = 0.3  # [N/mm]
NOTICEABLE = 0.05  # [N]


def rows_of(lines):
    return [{name: value if name == 'tissue' else float(value) for name, value in row.items()}
            for row in csv.DictReader(lines)]


class StabForcesTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.computed = rows_of(subprocess.check_output([PROGRAM], text=True).splitlines())

    def of(self, tissue):
        return [row for row in self.computed if row['tissue'] == tissue]

    def test_the_figure_shows_what_is_computed(self):
        with open(os.path.join(SOURCE, 'doc/figures/stab_forces.csv'), encoding='utf-8') as lines:
            shown = rows_of(lines)
        self.assertEqual(len(shown), len(self.computed))
        for row, other in zip(shown, self.computed):
            self.assertEqual((row['tissue'], row['time_ms']), (other['tissue'], other['time_ms']))
            for name in ('way_mm', 'penalty_n', 'proxy_n'):
                self.assertAlmostEqual(row[name], other[name], delta=NOTICEABLE, msg=str((row, other)))

    def test_a_proxy_pulls_back_in_proportion_to_the_depth(self):
        rows = self.of('sheet')
        surface = next(row['way_mm'] for row in rows if row['proxy_n'] > 0)
        for row in rows:
            depth = max(0.0, row['way_mm'] - surface)
            self.assertAlmostEqual(row['proxy_n'], STIFFNESS * depth, delta=0.3, msg=str(row))

    def test_the_penalty_law_lets_go_and_then_pushes_to_the_wrong_side(self):
        for tissue in ('sheet', 'lobe'):
            rows = self.of(tissue)
            deepest = max(rows, key=lambda row: row['way_mm'])
            self.assertGreater(max(row['penalty_n'] for row in rows), 2.0)
            self.assertEqual(deepest['penalty_n'], 0.0)
            self.assertGreater(deepest['proxy_n'], 9.0)
            self.assertLess(min(row['penalty_n'] for row in rows), -1.0)
            self.assertGreaterEqual(min(row['proxy_n'] for row in rows), 0.0)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1], verbosity=2)
