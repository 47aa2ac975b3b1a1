#!/usr/bin/python3
"""Installs the build into an empty folder, and uses the installed files as another package would. rosrun finds every
program of the package, as built and as installed.

Usage: install_test.py BUILD_FOLDER DEVEL_SPACE INSTALL_PREFIX CXX_COMPILER
"""

import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

BUILD, DEVEL, PREFIX, COMPILER = sys.argv[1:5]
HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.dirname(os.path.dirname(HERE))
PYTHON_OF_ROS = glob.glob('/opt/ros/*/lib/python3*/*-packages')  # Debian has it in the system's folders.
PLAIN_ENVIRONMENT = {'PATH': '/usr/bin:/bin', 'HOME': os.environ.get('HOME', '/')}
# The programs in Python: the examples that can be executed, and what the launch files start.
SCRIPTS = {'demo_report.py', 'organ_mesh_adapter', 'pose_adapter.py', 'view.py'} | {
    name for name in os.listdir(os.path.join(SOURCE, 'examples'))
    if name.endswith('.py') and os.access(os.path.join(SOURCE, 'examples', name), os.X_OK)}
PROGRAMS = {'organ_collision_node', 'robot_reader', 'haptic_proxy', 'tool_guard', 'query_offline', 'replay',
            'liver_simulator', 'fem_tissue', 'stylus_driver'}
SHIPPED = [folder + '/' + name for folder in ('launch', 'config', 'urdf', 'msg', 'srv')
           for name in os.listdir(os.path.join(SOURCE, folder)) if os.path.isfile(os.path.join(SOURCE, folder, name))]


def files(folder, pattern):
    return {os.path.relpath(path, folder) for path in glob.glob(os.path.join(folder, pattern), recursive=True)}


def run(*command, **environment):
    done = subprocess.run(command, env={**PLAIN_ENVIRONMENT, **environment}, errors='replace', stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode != 0:
        raise AssertionError('%s: exit code %d\n%s' % (command, done.returncode, done.stdout[-2000:]))
    return done.stdout


class InstallTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix='organ_collision_install_')
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        run('cmake', '--install', BUILD, DESTDIR=cls.folder)
        cls.prefix = cls.folder + PREFIX
        cls.programs = os.path.join(cls.prefix, 'lib/organ_collision')

    def test_each_public_header_compiles_alone_and_a_program_without_ros_links_the_core(self):
        build = os.path.join(self.folder, 'consumer')
        run('cmake', '-S', os.path.join(HERE, 'consumer'), '-B', build, '-DCMAKE_PREFIX_PATH=' + self.prefix,
            '-DCMAKE_CXX_COMPILER=' + COMPILER)
        run('cmake', '--build', build, '--parallel', '2')
        said = {name: run(os.path.join(build, name)).splitlines() for name in ('consumer', 'placement', 'proxy')}
        self.assertEqual(said['consumer'], ['0', '1'])
        self.assertEqual(said['placement'], ['clearance 0.015 m', 'inside', '3 near faces'])
        # The axis stops 3.1 mm above the sheet.
        self.assertEqual([round(float(pull), 3) for pull in said['proxy']], [0.0, 0.0, 3.1, 13.1])
        linked = run('ldd', os.path.join(build, 'consumer'))
        self.assertIn(self.prefix + '/lib/liborgan_collision_query', linked)
        self.assertNotRegex(linked, r'lib(ros|tf2|nodelet|xmlrpc)')

    def test_another_prefix_than_the_configured_one_is_refused(self):
        other = os.path.join(self.folder, 'other')
        with self.assertRaisesRegex(AssertionError, '-DCMAKE_INSTALL_PREFIX=' + other):
            run('cmake', '--install', BUILD, '--prefix', other)
        self.assertFalse(os.path.exists(other))

    def test_everything_that_the_package_ships_is_there(self):
        include = os.path.join(self.prefix, 'include', 'organ_collision')
        headers = files(include, '**/*.hpp')
        self.assertEqual(headers, files(os.path.join(SOURCE, 'include', 'organ_collision'), '**/*.hpp'))
        self.assertLessEqual({'ContactArray.h', 'QueryCollision.h'}, set(os.listdir(include)))
        examples = {'examples/' + name for pattern in ('*.launch', '*.yaml', '*.obj')
                    for name in files(os.path.join(SOURCE, 'examples'), pattern)}
        share = files(os.path.join(self.prefix, 'share/organ_collision'), '**/*')
        more = {'package.xml', 'nodelet_plugins.xml', 'urdf/meshes/jaw.stl', 'cmake/organ_collisionConfig.cmake'}
        self.assertEqual(({*SHIPPED} | examples | more) - share, set())

    def test_installed_programs_and_nodelet_find_their_libraries(self):
        programs = set(os.listdir(self.programs))
        self.assertLessEqual(PROGRAMS | SCRIPTS | {'rrt_connect.py', 'grasper_kinematics.py'}, programs)
        for path in SHIPPED + glob.glob(os.path.join(SOURCE, 'examples', '*.launch')):
            if path.endswith('.launch'):
                with open(os.path.join(SOURCE, path), encoding='utf-8') as text:
                    started = set(re.findall(r'pkg="organ_collision" type="([\w.]+)"', text.read()))
                self.assertLessEqual(started, programs, path)
        paths = [os.path.join(self.programs, name) for name in programs - SCRIPTS if not name.endswith('.py')]
        for path in paths + [os.path.join(self.prefix, 'lib', 'liborgan_collision_nodelet.so')]:
            self.assertNotIn('not found', run('ldd', path), path)
        # The program that reads robots is where the node looks for it.
        urdf = os.path.join(self.prefix, 'share/organ_collision/urdf/grasper.urdf')
        reader = os.path.join(self.programs, 'robot_reader')
        with self.assertRaisesRegex(AssertionError, "link 'no_such_link' is unknown"):
            run(reader, urdf, 'no_such_link')

    def test_the_python_module_and_the_messages_share_a_package(self):
        modules = glob.glob(os.path.join(self.prefix, 'lib/python3*/*-packages'))
        said = run('/usr/bin/python3', '-c', 'from organ_collision import organ_mesh, Queries, read_mesh\n'
                   'print(organ_mesh("organ", [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])._type)',
                   PYTHONPATH=':'.join(modules + PYTHON_OF_ROS))
        self.assertEqual(said.strip(), 'organ_collision/OrganMesh')

    @unittest.skipUnless(shutil.which('rosrun'), 'rosbash is not installed')
    def test_rosrun_finds_each_program(self):
        """In a shell that has loaded only one space. Modules that a script imports from its own folder are no programs:
        they may not be executed."""
        own = ('demo_report.py', 'organ_mesh_adapter', 'pose_adapter.py', 'view.py')
        sources = [os.path.join(SOURCE, 'scripts' if name in own else 'examples', name) for name in SCRIPTS]
        built = [os.path.join(DEVEL, 'lib/organ_collision', name) for name in PROGRAMS]
        installed = [path for path in glob.glob(os.path.join(self.prefix, 'lib/organ_collision/*'))
                     if os.access(path, os.X_OK)]
        for space, paths in ((DEVEL, sources + built), (self.prefix, installed)):
            # In a function without arguments, because setup.bash would take ours as its own.
            script = ('load() { . "$0/setup.bash"; }; load; for name in "$@"; do rosrun --prefix echo organ_collision $name; '
                      'done; rosrun organ_collision query_offline --help')
            said = run('bash', '-c', script, space, *map(os.path.basename, paths), HOME=self.folder).splitlines()
            found = [os.path.realpath(line.strip()) for line in said[:len(paths)]]
            self.assertEqual(found, [os.path.realpath(path) for path in paths])
            self.assertIn('--motions', ' '.join(said[len(paths):]))


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1], verbosity=2)
