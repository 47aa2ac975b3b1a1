#!/usr/bin/python3
"""A folder of src is a library, which includes and links only what stands before it.

Usage: layers_test.py SOURCE_FOLDER NAME=FILE...: the libraries and programs to look into
"""

import glob
import os
import re
import subprocess
import sys
import unittest

SOURCE = sys.argv[1]
FILES = dict(argument.split('=', 1) for argument in sys.argv[2:])
# What each folder of src may include beside itself.
CORE = ['geometry', 'picking', 'query']
MAY_INCLUDE = {
    'geometry': [], 'picking': CORE[:1], 'query': CORE[:2], 'common': ['geometry'], 'node': CORE + ['common'],
    'haptics': CORE + ['common', 'node'], 'guard': ['geometry', 'common'], 'demo': ['geometry', 'common'],
    'programs/mesh_reader': ['geometry', 'common'], 'programs/robot_reader': ['geometry', 'common', 'programs/mesh_reader'],
    'programs/query_offline': CORE + ['common', 'programs/mesh_reader'], 'programs/replay': CORE + ['common', 'node'],
}
# The folders of a library, in the order in which data flows through them: each uses only those before it.
ROOMS = {'geometry': ['organ', 'tool', 'distance', 'sides'],
         'picking': ['volumes', 'culling', 'gl', 'pickers'],
         'common': ['messages', 'threads', 'parameters', 'program'],
         'node': ['parameters', 'organs', 'tools', 'motion', 'steps', 'publishing', 'queries', 'markers']}
ROS = re.compile(r'((ros|roscpp|tf2\w*|nodelet|pluginlib|diagnostic_updater|\w+_msgs|std_srvs)/|organ_collision/\w+\.h$)')
GL = re.compile(r'(GL|EGL)/')
GL_LIBRARIES = r'lib(OSMesa|GL|EGL)\.so'
ROS_LIBRARIES = r'lib(roscpp|rosconsole|tf2\w*|nodelet\w*|xmlrpcpp)\.so'
PARSERS = r'lib(assimp|urdfdom\w*|tinyxml2?|vtk\w*)[-.\d]*\.so'


def includes(room):
    """All (file, included path) of the headers and sources of a folder of src/ and of include/organ_collision/."""
    for folder in ('include/organ_collision', 'src'):
        for path in glob.glob(os.path.join(SOURCE, folder, room, '**', '*.?pp'), recursive=True):
            with open(path) as text:
                for included in re.findall(r'^\s*#\s*include\s*[<"]([^>"]+)', text.read(), re.M):
                    yield os.path.relpath(path, SOURCE), re.sub('^organ_collision/(?=.*hpp$)', '', included)


class LayersTest(unittest.TestCase):

    def matching(self, room, pattern):
        found = list(includes(room))
        self.assertTrue(found, room)
        return ['%s: %s' % (path, included) for path, included in found if re.match(pattern, included)]

    def test_each_nodelet_that_is_loaded_by_its_name_is_a_plugin(self):
        with open(os.path.join(SOURCE, 'nodelet_plugins.xml')) as text:
            plugins = set(re.findall(r'class name="([^"]+)"', text.read()))
        load = re.compile(r'(?:load |load\(\w+, ")(organ_collision/\w+)')
        loaded = set()
        for path in (path for folder in ('benchmark', 'examples', 'launch', 'src', 'test')
                     for path in glob.glob(os.path.join(SOURCE, folder, '**', '*.*'), recursive=True)):
            if path.endswith(('.cpp', '.launch', '.test')):
                with open(path) as text:
                    loaded.update((os.path.relpath(path, SOURCE), name) for name in load.findall(text.read()))
        self.assertGreater(len(loaded), 5)
        self.assertEqual([found for found in sorted(loaded) if found[1] not in plugins], [])

    def test_a_folder_includes_only_itself_and_what_it_may_include(self):
        folders = set(os.path.relpath(path, os.path.join(SOURCE, 'src')) for path in
                      glob.glob(os.path.join(SOURCE, 'src', '*')) + glob.glob(os.path.join(SOURCE, 'src/programs/*'))
                      if os.path.isdir(path))
        self.assertEqual(folders, set(MAY_INCLUDE) | {'programs'})
        for room, allowed in MAY_INCLUDE.items():
            others = '|'.join(other for other in MAY_INCLUDE if other != room and other not in allowed)
            self.assertEqual(self.matching(room, r'(%s)/' % others), [])

    def test_a_room_of_a_library_includes_only_those_before_it(self):
        for library, rooms in ROOMS.items():
            folders = [name for name in os.listdir(os.path.join(SOURCE, 'src', library))
                       if os.path.isdir(os.path.join(SOURCE, 'src', library, name))]
            self.assertEqual(sorted(folders), sorted(rooms), library)
            for rank, room in enumerate(rooms[:-1]):
                later = r'%s/(%s)/' % (library, '|'.join(rooms[rank + 1:]))
                self.assertEqual(self.matching(library + '/' + room, later), [])

    def test_ros_is_included_after_the_core_and_gl_only_in_picking(self):
        for room in CORE + ['programs/query_offline']:
            self.assertEqual(self.matching(room, ROS), [])
        for room in set(MAY_INCLUDE) - {'picking'}:
            self.assertEqual(self.matching(room, GL), [])

    def test_what_is_not_linked(self):
        """GL is loaded, and not linked. The parsers of robots' files are only in robot_reader."""
        core = ['geometry', 'picking', 'query']
        for name, *patterns in (
                [[name, ROS_LIBRARIES, PARSERS] for name in core] +
                [['node', PARSERS], ['tool_guard', PARSERS, 'liborgan_collision_(?!geometry)'],
                 ['liver_simulator', PARSERS, 'liborgan_collision_(?!geometry)'],
                 ['robot_reader', ROS_LIBRARIES], ['query_offline', ROS_LIBRARIES]]):
            linked = subprocess.check_output(['ldd', FILES[name]], text=True)
            for pattern in [GL_LIBRARIES] + patterns:
                self.assertNotRegex(re.sub(r' => .*', '', linked), pattern, name)
        self.assertRegex(subprocess.check_output(['ldd', FILES['robot_reader']], text=True), PARSERS)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1], verbosity=2)
