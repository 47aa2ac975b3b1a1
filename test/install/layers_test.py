#!/usr/bin/python3
"""What each layer (geometry <- picking <- query <- ros) and each program includes and links.

Usage: layers_test.py SOURCE_FOLDER GEOMETRY_LIBRARY PICKING_LIBRARY QUERY_LIBRARY ROS_LIBRARY
                      CONTACT_ADAPTER MESH_ADAPTER LIVER_SIMULATOR ROBOT_READER
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


def matching(room, pattern, files='*'):
    """All 'file: included path' of a folder that match."""
    found = list(includes(room, files))
    assert found, room
    return ['%s: %s' % (path, included) for path, included in found if pattern.match(included)]


class LayersTest(unittest.TestCase):

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

    def test_a_layer_and_a_folder_include_only_themselves_and_those_before_them(self):
        for layer, rooms in ROOMS.items():
            folders = [name for name in os.listdir(os.path.join(SOURCE, 'src', layer))
                       if os.path.isdir(os.path.join(SOURCE, 'src', layer, name))]
            self.assertEqual(sorted(folders), sorted(rooms), layer)
        orders = [('', LAYERS)] + [(layer + '/', rooms) for layer, rooms in ROOMS.items()]
        for prefix, order in orders:
            for rank, room in enumerate(order[:-1]):
                later = re.compile(r'(?:organ_collision/)?%s(?:%s)/' % (prefix, '|'.join(order[rank + 1:])))
                self.assertEqual(matching(prefix + room, later), [])

    def test_what_is_included_only_in_some_folders(self):
        message = re.compile(r'organ_collision/\w+\.h$')
        adapters = ('ros/messages', 'forces', 'contact_adapter', 'mesh_adapter')
        for pattern, rooms in ((ROS, LAYERS[:-1]), (message, LAYERS[:-1]),
                               (GL, ['geometry', 'query', 'ros']),
                               (NODE, adapters)):
            for room in rooms:
                self.assertEqual(matching(room, pattern), [])
        # robot_reader shares this with the node.
        self.assertEqual(matching('ros/messages', ROS, 'text'), [])

    def test_what_is_not_linked(self):
        """GL is loaded, and not linked."""
        geometry, picking, query, ros, contact_adapter, mesh_adapter, simulator, robot_reader = sys.argv[2:10]
        of_ros, other_layers = r'lib(ros|tf2|nodelet|xmlrpc)', r'liborgan_collision_(?!geometry)'
        for library, *patterns in (
            (geometry, of_ros, GL_LIBRARIES), (picking, of_ros, GL_LIBRARIES), (query, of_ros), (ros, PARSERS),
            (contact_adapter, GL_LIBRARIES, PARSERS, other_layers, r'lib(tf2|nodelet)\w*\.so'),
            (mesh_adapter, GL_LIBRARIES, PARSERS, other_layers, r'lib(tf2|nodelet)\w*\.so'),
            (simulator, GL_LIBRARIES, PARSERS, other_layers),
            (robot_reader, GL_LIBRARIES, r'lib(roscpp|rosconsole|tf2|nodelet|xmlrpc)\.so'),
        ):
            linked = subprocess.check_output(['ldd', library], text=True)
            for pattern in patterns:
                self.assertNotRegex(linked, pattern, library)
            if library == robot_reader:
                self.assertRegex(linked, PARSERS)


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1], verbosity=2)
