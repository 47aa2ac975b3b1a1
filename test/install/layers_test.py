#!/usr/bin/python3
"""What each layer (geometry <- picking <- query <- ros) and each program includes and links.

Usage: layers_test.py SOURCE_FOLDER GEOMETRY_LIBRARY PICKING_LIBRARY QUERY_LIBRARY ROS_LIBRARY
                      CONTACT_ADAPTER MESH_ADAPTER LIVER_SIMULATOR ROBOT_READER SNAPSHOT
"""

import glob
import os
import re
import subprocess
import sys
import unittest

SOURCE = sys.argv[1]
LAYERS = ['geometry', 'picking', 'query', 'ros']
# The folders of a layer, in the order in which data flows through them.
ROOMS = {'geometry': ['organ', 'tool', 'distance', 'sides'],
         'picking': ['volumes', 'culling', 'gl', 'pickers'],
         'ros': ['messages', 'threads', 'parameters', 'organs', 'tools', 'motion', 'steps', 'publishing', 'queries',
                 'markers', 'node']}
LIBRARIES = dict(zip(LAYERS, sys.argv[2:5]))
ROS_LIBRARY = sys.argv[5]
CONTACT_ADAPTER, MESH_ADAPTER, LIVER_SIMULATOR, ROBOT_READER, SNAPSHOT = sys.argv[6:11]
ROS = re.compile(r'\b(ros|roscpp|tf2|nodelet|pluginlib|diagnostic_updater|\w+_msgs|std_srvs)[_/]')
GL = re.compile(r'\b(GL|EGL)/')
GL_LIBRARIES = r'lib(OSMesa|GL|EGL)\.so'
PARSERS = r'lib(assimp|urdfdom\w*|tinyxml2?)\.so'
# The layers that the adapters must not use, and the folders and files of the node. The names of the modes are
# allowed: that header links nothing.
NODE = re.compile(r'(organ_collision/)?(picking|query)/(?!query_mode\.hpp)'
                  r'|ros/(markers|motion|organs|publishing|queries|steps|tools)/'
                  r'|ros/node/(?!program)|ros/parameters/(node|tool)_parameters')


def includes(room, files='*'):
    """All (file, included path) of the headers and sources of a layer or another folder of src/."""
    for folder in ('include/organ_collision', 'src'):
        for path in glob.glob(os.path.join(SOURCE, folder, room, '**', files + '.?pp'), recursive=True):
            with open(path) as text:
                for included in re.findall(r'^\s*#\s*include\s*[<"]([^>"]+)', text.read(), re.M):
                    yield os.path.relpath(path, SOURCE), included


def linked(library):
    return subprocess.check_output(['ldd', library], text=True)


class LayersTest(unittest.TestCase):

    def test_a_layer_includes_only_itself_and_those_before_it(self):
        for rank, layer in enumerate(LAYERS):
            found = 0
            for path, included in includes(layer):
                found += 1
                other = re.match(r'(?:organ_collision/)?(\w+)/', included)
                if other and other.group(1) in LAYERS:
                    self.assertIn(other.group(1), LAYERS[:rank + 1], path)
            self.assertGreater(found, 0, layer)

    def test_a_folder_includes_only_itself_and_those_before_it(self):
        for layer, rooms in ROOMS.items():
            folders = sorted(name for name in os.listdir(os.path.join(SOURCE, 'src', layer))
                             if os.path.isdir(os.path.join(SOURCE, 'src', layer, name)))
            self.assertEqual(folders, sorted(rooms), layer)
            for rank, room in enumerate(rooms):
                for path, included in includes(os.path.join(layer, room)):
                    other = re.match(r'(?:organ_collision/)?%s/(\w+)/' % layer, included)
                    if other:
                        self.assertIn(other.group(1), rooms[:rank + 1], '%s: %s' % (path, included))

    def test_ros_is_included_only_in_the_last_layer(self):
        for layer in LAYERS[:-1]:
            for path, included in includes(layer):
                self.assertIsNone(ROS.match(included), '%s: %s' % (path, included))
                self.assertFalse(re.fullmatch(r'organ_collision/\w+\.h', included), path)

    def test_gl_is_included_only_in_picking(self):
        for layer in LAYERS:
            if layer != 'picking':
                for path, included in includes(layer):
                    self.assertIsNone(GL.match(included), '%s: %s' % (path, included))

    def test_snapshot_takes_gl_from_picking_and_nothing_from_query_and_the_node(self):
        allowed = re.compile(r'picking/(gl/|volumes/viewing_volume)')
        found = set()
        for path, included in includes('snapshot'):
            self.assertIsNone(GL.match(included), '%s: %s' % (path, included))
            if NODE.match(included):
                self.assertRegex(included, allowed, path)
                found.add(included)
        self.assertIn('picking/gl/gl_context.hpp', found)

    def test_the_adapters_include_nothing_of_picking_query_and_the_node(self):
        for room in ('ros/messages', 'ros/threads', 'forces', 'contact_adapter', 'mesh_adapter', 'check_contacts'):
            found = 0
            for path, included in includes(room):
                found += 1
                self.assertIsNone(NODE.match(included), '%s: %s' % (path, included))
            self.assertGreater(found, 0, room)

    def test_what_robot_reader_shares_with_the_node_includes_no_ros(self):
        for room, files in (('ros/messages', 'text'),):
            found = 0
            for path, included in includes(room, files):
                found += 1
                self.assertIsNone(ROS.match(included), '%s: %s' % (path, included))
            self.assertGreater(found, 0, files)

    def test_geometry_links_no_gl(self):
        self.assertNotRegex(linked(LIBRARIES['geometry']), GL_LIBRARIES)

    def test_picking_loads_gl_and_does_not_link_it(self):
        self.assertNotRegex(linked(LIBRARIES['picking']), GL_LIBRARIES)

    def test_the_node_links_no_parser_of_robot_files(self):
        self.assertNotRegex(linked(ROS_LIBRARY), PARSERS)

    def test_the_adapters_and_the_simulator_link_no_gl_no_parser_and_no_other_layer(self):
        for program in (CONTACT_ADAPTER, MESH_ADAPTER, LIVER_SIMULATOR):
            libraries = linked(program)
            self.assertIn('libroscpp.so', libraries)
            self.assertNotRegex(libraries, GL_LIBRARIES, program)
            self.assertNotRegex(libraries, PARSERS, program)
            self.assertNotRegex(libraries, r'liborgan_collision_(?!geometry)', program)

    def test_the_adapters_link_no_tf_buffer(self):
        for program in (CONTACT_ADAPTER, MESH_ADAPTER):
            self.assertNotRegex(linked(program), r'lib(tf2|nodelet)\w*\.so', program)

    def test_robot_reader_links_no_node(self):
        libraries = linked(ROBOT_READER)
        self.assertRegex(libraries, PARSERS)
        self.assertNotRegex(libraries, GL_LIBRARIES)
        self.assertNotRegex(libraries, r'lib(roscpp|rosconsole|tf2|nodelet|xmlrpc)')

    def test_snapshot_links_no_gl_and_no_node(self):
        libraries = linked(SNAPSHOT)
        self.assertNotRegex(libraries, GL_LIBRARIES)
        self.assertNotRegex(libraries, r'liborgan_collision_(?!geometry|picking)')

    def test_no_layer_before_ros_links_it(self):
        for library in LIBRARIES.values():
            self.assertNotRegex(linked(library), r'lib(ros|tf2|nodelet|xmlrpc)')


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1], verbosity=2)
