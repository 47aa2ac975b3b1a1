#!/usr/bin/python3
"""--help of every program, without a ROS master. The names, types and defaults that the nodes' help
shows are those of the tables in the pages.

Usage: help_test.py SOURCE_FOLDER DEVEL_SPACE
"""

import glob
import os
import re
import subprocess
import sys
import unittest

SOURCE, DEVEL = sys.argv[1:3]
# Modules that programs import are not executable.
SCRIPTS = [path for path in glob.glob(os.path.join(SOURCE, 'examples', '*.py')) if os.access(path, os.X_OK)] + [
    os.path.join(SOURCE, 'scripts', 'view.py')]
# The programs of tests and benchmarks, besides the unit tests.
NOT_SHIPPED = ('exactness_proof', 'proxy_proof', 'stab_forces', 'collision_benchmark', 'force_benchmark',
               'end_to_end', 'pose_to_wrench', 'echo_node', 'ask_batches', 'motions_benchmark',
               'soak', 'fuzz')
# The page of each node. Its tables, in this order, are of topics, services and parameters.
PAGES = {'organ_collision_node': 'doc/interface.md', 'contact_adapter': 'doc/forces.md',
         'organ_mesh_adapter': 'doc/meshes.md', 'haptic_proxy': 'doc/haptic_interface.md'}
TABLES = ('topic', 'service', 'parameter')
# The page of the keys of a tool, which two nodes have.
KEYS_PAGE, NODES_WITH_TOOLS = 'doc/tools.md', ('organ_collision_node', 'haptic_proxy')


def program(name):
    return os.path.join(DEVEL, 'lib/organ_collision', name)


def run(path, *arguments):
    """Runs a program, with a ROS master that does not exist."""
    return subprocess.run([path, *arguments], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, timeout=60,
                          env={**os.environ, 'ROS_MASTER_URI': 'http://localhost:1'})


def rows_of_help(text):
    """{(name, kind)} of all entries: 'NAME (KIND)'."""
    return set(re.findall(r'^  (\S.*) \((.+)\)$', text, re.M))


def rows_of_page(page, tables=TABLES):
    """{(name, kind)} of the tables of topics, services and parameters in a page."""
    rows, table, name = set(), None, None
    with open(os.path.join(SOURCE, page)) as lines:
        for line in lines:
            cells = [cell.strip() for cell in re.split(r'(?<!\\)\|', line)[1:-1]]
            if not cells:
                table = None
            elif table is None:
                table = cells[0]
            elif table in tables and not cells[1].startswith('---'):
                name = cells[0].replace('`', '') or name  # an empty cell repeats the one above
                if table != 'topic':
                    name = name.lstrip('~')
                rows.add((name, cells[1].replace('`', '')))
    return rows


class HelpTest(unittest.TestCase):

    def test_every_program_has_help(self):
        programs = [path for path in glob.glob(program('*'))
                    if os.path.isfile(path) and os.access(path, os.X_OK) and not path.endswith(('_test', '.py') + NOT_SHIPPED)]
        self.assertIn(program('organ_collision_node'), programs)
        for path in programs + SCRIPTS:
            with self.subTest(program=path):
                for asked in ('--help', '-h'):
                    done = run(path, asked)
                    self.assertEqual((done.returncode, done.stderr), (0, ''))
                    self.assertRegex(done.stdout.lower(), r'\A\s*usage')

    def test_an_unknown_option_is_refused(self):
        for name in [*PAGES, 'liver_simulator', 'demo_report', 'robot_reader']:
            done = run(program(name), '--no-such-option')
            with self.subTest(program=name):
                self.assertEqual((done.returncode, done.stdout), (2, ''))
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                self.assertIn('--no-such-option', done.stderr)

    def test_the_page_says_of_each_key_of_a_tool_what_the_help_says(self):
        shown = run(program('organ_collision_node'), '--help').stdout.split('Keys of an entry of ~tools')[1]
        with open(os.path.join(SOURCE, KEYS_PAGE)) as page:
            rows = re.findall(r'^\| `(\w+)` \| (.*) \| (.*) \|$', page.read().split('## Shafts')[0], re.M)
        self.assertGreater(len(rows), 10)
        for key, kind, meaning in rows:
            self.assertIn('%s (%s) %s' % (key, kind, meaning.replace('`', '')), ' '.join(shown.split()))

    def test_help_and_pages_name_the_same(self):
        for name, page in PAGES.items():
            with self.subTest(program=name):
                shown, written = rows_of_help(run(program(name), '--help').stdout), rows_of_page(page)
                if name in NODES_WITH_TOOLS:
                    written |= rows_of_page(KEYS_PAGE, ('key',))
                self.assertGreater(len(shown), 5)
                self.assertEqual(shown ^ written, set())


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1], verbosity=2)
