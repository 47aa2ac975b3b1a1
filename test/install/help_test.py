#!/usr/bin/python3
"""--help of every program, without a ROS master. The pages of doc/reference are made from it.

Usage: help_test.py SOURCE_FOLDER DEVEL_SPACE
"""

import glob
import os
import subprocess
import sys
import tempfile
import unittest

SOURCE, DEVEL = sys.argv[1:3]
# Modules that programs import are not executable.
SCRIPTS = [path for path in glob.glob(os.path.join(SOURCE, 'examples', '*.py')) if os.access(path, os.X_OK)] + [
    os.path.join(SOURCE, 'scripts', name) for name in ('view.py', 'demo_report.py', 'organ_mesh_adapter', 'plot.py', 'pose_adapter.py', 'trial_report.py')]
# The programs of tests and benchmarks, besides the unit tests.
NOT_SHIPPED = ('exactness_proof', 'proxy_proof', 'collision_benchmark', 'end_to_end', 'pose_to_wrench',
               'echo_node', 'fuzz')
NODES = ('organ_collision_node', 'haptic_proxy', 'tool_guard')


def program(name):
    return os.path.join(DEVEL, 'lib/organ_collision', name)


def run(path, *arguments):
    """Runs a program, with a ROS master that does not exist."""
    return subprocess.run([path, *arguments], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, timeout=300,
                          env={**os.environ, 'ROS_MASTER_URI': 'http://localhost:1'})


class HelpTest(unittest.TestCase):
    maxDiff = None

    def test_every_program_has_help(self):
        programs = [path for path in glob.glob(program('*'))
                    if os.path.isfile(path) and os.access(path, os.X_OK) and not path.endswith(('_test', '.py') + NOT_SHIPPED)]
        self.assertIn(program('organ_collision_node'), programs)
        for path in programs + SCRIPTS:
            with self.subTest(program=path):
                # argparse takes both.
                for asked in ('--help',) if path.endswith('.py') else ('--help', '-h'):
                    done = run(path, asked)
                    self.assertEqual((done.returncode, done.stderr), (0, ''))
                    self.assertRegex(done.stdout.lower(), r'\A\s*usage')

    def test_an_unknown_option_is_refused(self):
        for name in [*NODES, 'liver_simulator', 'robot_reader']:
            done = run(program(name), '--no-such-option')
            with self.subTest(program=name):
                self.assertEqual((done.returncode, done.stdout), (2, ''))
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                self.assertIn('--no-such-option', done.stderr)

    def test_the_reference_is_what_make_reference_makes(self):
        with tempfile.TemporaryDirectory() as folder:
            made = run(os.path.join(SOURCE, 'scripts/make_reference'), DEVEL, folder)
            self.assertEqual((made.returncode, made.stderr), (0, ''))
            for name in ('nodes.md', 'messages.md', 'programs.md'):
                with open(os.path.join(folder, name)) as new, open(os.path.join(SOURCE, 'doc/reference', name)) as old:
                    self.assertEqual(old.read(), new.read(), 'run scripts/make_reference')


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1], verbosity=2)
