#!/usr/bin/python3
"""rosrun finds every program of the package, as built and as installed.

Usage: rosrun_test.py SOURCE_FOLDER BUILD_FOLDER DEVEL_SPACE INSTALL_PREFIX
"""

import glob
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE, BUILD, DEVEL, PREFIX = sys.argv[1:5]
SCRIPTS = ('ask.py', 'ask_many.py', 'dvrk_hand.py', 'dvrk_organ.py', 'dvrk_robot.py', 'grasper.py',
           'lower_until_touch.py', 'own_mesh.py', 'plan_grasper.py', 'simulator.py')


def programs(space):
    """All programs of a space except the unit tests, which ctest runs.

    The modules that a script imports from its own folder are no programs: they may not be executed.
    """
    paths = glob.glob(os.path.join(space, 'lib/organ_collision/*'))
    return sorted(p for p in paths if os.path.isfile(p) and os.access(p, os.X_OK)
                  and not p.endswith('_test'))


class RosrunTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix='organ_collision_rosrun_')

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def rosrun(self, space, *arguments):
        """Returns the output of rosrun, in a shell that has loaded only this space."""
        done = subprocess.run(
            # In a function without arguments, because setup.bash would take ours as its own.
            ['bash', '-c', 'load() { . "$0/setup.bash"; }; load && rosrun "$@"', space, *arguments],
            env={'PATH': '/usr/bin:/bin', 'HOME': self.folder}, stdin=subprocess.DEVNULL,
            text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertEqual(done.returncode, 0, '%s: %s' % (arguments, done.stdout))
        return done.stdout

    def assert_runs(self, space, paths):
        for path in paths:
            found = self.rosrun(space, '--prefix', 'echo', 'organ_collision', os.path.basename(path))
            self.assertEqual(os.path.realpath(found.strip()), os.path.realpath(path))
        self.assertIn('--motions', self.rosrun(space, 'organ_collision', 'query_offline', '--help'))

    def test_as_built(self):
        paths = programs(DEVEL)
        self.assertIn('organ_collision_node', [os.path.basename(path) for path in paths])
        self.assert_runs(DEVEL, paths + [os.path.join(SOURCE, 'examples', name) for name in SCRIPTS])

    def test_as_installed(self):
        subprocess.run(['cmake', '--install', BUILD], env={**os.environ, 'DESTDIR': self.folder},
                       check=True, stdout=subprocess.DEVNULL)
        space = self.folder + PREFIX
        paths = programs(space)
        self.assertLessEqual({'organ_collision_node', *SCRIPTS},
                             {os.path.basename(path) for path in paths})
        self.assert_runs(space, paths)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1], verbosity=2)
