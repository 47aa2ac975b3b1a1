#!/usr/bin/python3
"""Installs the build into an empty folder, and uses the installed files as another package would.

Usage: install_test.py BUILD_FOLDER INSTALL_PREFIX CXX_COMPILER
"""

import glob
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

BUILD, PREFIX, COMPILER = sys.argv[1:4]
HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.dirname(os.path.dirname(HERE))
CONSUMER = os.path.join(HERE, 'consumer')
PYTHON_OF_ROS = glob.glob('/opt/ros/*/lib/python3*/*-packages')  # Debian has it in the system's folders.
PLAIN_ENVIRONMENT = {'PATH': '/usr/bin:/bin', 'HOME': os.environ.get('HOME', '/')}


def headers(folder):
    paths = glob.glob(os.path.join(folder, '**', '*.hpp'), recursive=True)
    return sorted(os.path.relpath(path, folder) for path in paths)


def run(*command, **environment):
    done = subprocess.run(command, env={**PLAIN_ENVIRONMENT, **environment}, errors='replace',
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode != 0:
        raise AssertionError('%s: exit code %d\n%s' % (command, done.returncode, done.stdout[-2000:]))
    return done.stdout


class InstallTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix='organ_collision_install_')
        run('cmake', '--install', BUILD, DESTDIR=cls.folder)
        cls.prefix = cls.folder + PREFIX

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def test_each_public_header_compiles_alone_and_a_program_without_ros_links_the_core(self):
        build = os.path.join(self.folder, 'consumer')
        run('cmake', '-S', CONSUMER, '-B', build, '-DCMAKE_PREFIX_PATH=' + self.prefix,
            '-DCMAKE_CXX_COMPILER=' + COMPILER)
        run('cmake', '--build', build)
        program = os.path.join(build, 'consumer')

        self.assertEqual(run(program).split(), ['0', '1'])
        self.assertEqual(run(os.path.join(build, 'placement')).splitlines(),
                         ['clearance 0.015 m', 'inside', '3 near faces'])
        # The axis stops 3.1 mm above the sheet.
        pulls = [float(line) for line in run(os.path.join(build, 'proxy')).splitlines()]
        self.assertEqual([round(pull, 3) for pull in pulls], [0.0, 0.0, 3.1, 13.1])

        linked = run('ldd', program)
        self.assertIn(self.prefix + '/lib/liborgan_collision_query', linked)
        self.assertNotRegex(linked, r'lib(ros|tf2|nodelet|xmlrpc)')

    def test_another_prefix_than_the_configured_one_is_refused(self):
        other = os.path.join(self.folder, 'other')
        done = subprocess.run(['cmake', '--install', BUILD, '--prefix', other], env=PLAIN_ENVIRONMENT,
                              text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn('-DCMAKE_INSTALL_PREFIX=' + other, done.stdout)
        self.assertFalse(os.path.exists(other))

    def test_all_public_headers_are_installed_and_no_others(self):
        installed = headers(os.path.join(self.prefix, 'include', 'organ_collision'))
        self.assertEqual(installed, headers(os.path.join(SOURCE, 'include', 'organ_collision')))
        self.assertIn('query/collision_query.hpp', installed)

    def test_installed_programs_and_nodelet_find_their_libraries(self):
        folder = os.path.join(self.prefix, 'lib', 'organ_collision')
        programs = os.listdir(folder)
        self.assertTrue({'organ_collision_node', 'robot_reader', 'contact_adapter', 'organ_mesh_adapter',
                         'query_offline', 'snapshot', 'liver_simulator', 'demo_report', 'simulator.py', 'ask.py',
                         'grasper.py', 'view.py', 'own_mesh.py', 'dvrk_hand.py', 'stylus_driver', 'plan_grasper.py',
                         'plan_grasper', 'rrt_connect.py', 'grasper_kinematics.py'}
                        <= set(programs), programs)
        programs = [program for program in programs if not program.endswith('.py')]
        nodelet = os.path.join(self.prefix, 'lib', 'liborgan_collision_nodelet.so')
        for path in [os.path.join(folder, program) for program in programs] + [nodelet]:
            self.assertNotIn('not found', run('ldd', path), path)

    def test_the_program_that_reads_robots_runs_where_the_node_looks_for_it(self):
        lib = os.path.join(self.prefix, 'lib')
        self.assertTrue(os.path.exists(os.path.join(lib, 'liborgan_collision_ros.so')))
        urdf = os.path.join(self.prefix, 'share/organ_collision/urdf/grasper.urdf')
        said = run(os.path.join(lib, 'organ_collision', 'robot_reader'), urdf, 'no_such_link')
        self.assertIn("link 'no_such_link' is unknown", said)

    def test_the_python_module_and_the_messages_share_a_package(self):
        modules = glob.glob(os.path.join(self.prefix, 'lib/python3*/*-packages'))
        said = run('/usr/bin/python3', '-c', 'from organ_collision import organ_mesh, Queries, read_mesh\n'
                   'print(organ_mesh("organ", [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])._type)',
                   PYTHONPATH=':'.join(modules + PYTHON_OF_ROS))
        self.assertEqual(said.strip(), 'organ_collision/OrganMesh')

    def test_everything_that_the_package_ships_is_there(self):
        for path in ('package.xml', 'nodelet_plugins.xml', 'launch/organ_collision.launch',
                     'launch/demo.launch', 'launch/contact_adapter.launch',
                     'launch/organ_mesh_adapter.launch', 'config/tools.yaml', 'config/organs.yaml',
                     'examples/start.launch', 'examples/tools.yaml', 'examples/grasper.launch',
                     'examples/dvrk.launch', 'examples/plan.launch', 'examples/two_hosts.launch', 'urdf/psm.urdf', 'urdf/grasper.urdf', 'urdf/grasper.urdf.xacro', 'urdf/meshes/jaw.stl',
                     'msg/ContactArray.msg', 'srv/QueryCollision.srv', 'cmake/organ_collisionConfig.cmake'):
            self.assertTrue(os.path.exists(os.path.join(self.prefix, 'share/organ_collision', path)),
                            path)
        include = os.path.join(self.prefix, 'include', 'organ_collision')
        for path in ('query/collision_query.hpp', 'ContactArray.h', 'QueryCollision.h'):
            self.assertTrue(os.path.exists(os.path.join(include, path)), path)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1], verbosity=2)
