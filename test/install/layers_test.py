#!/usr/bin/python3
"""geometry <- picking <- query <- ros: what each layer includes and links.

Usage: layers_test.py SOURCE_FOLDER GEOMETRY_LIBRARY PICKING_LIBRARY QUERY_LIBRARY ROS_LIBRARY
"""

import glob
import os
import re
import subprocess
import sys
import unittest

SOURCE = sys.argv[1]
LAYERS = ['geometry', 'picking', 'query', 'ros']
LIBRARIES = dict(zip(LAYERS, sys.argv[2:5]))
ROS_LIBRARY = sys.argv[5]
ROS = re.compile(r'\b(ros|roscpp|tf2|nodelet|pluginlib|diagnostic_updater|\w+_msgs|std_srvs)[_/]')
GL = re.compile(r'\b(GL|EGL)/')


def includes(layer):
    """All (file, included path) of a layer's headers and sources."""
    for folder in ('include/organ_collision', 'src'):
        for path in glob.glob(os.path.join(SOURCE, folder, layer, '**', '*.?pp'), recursive=True):
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

    def test_geometry_links_no_gl(self):
        self.assertNotRegex(linked(LIBRARIES['geometry']), r'lib(OSMesa|GL|EGL)\.so')

    def test_picking_links_osmesa_and_no_other_gl(self):
        self.assertIn('libOSMesa.so', linked(LIBRARIES['picking']))
        self.assertNotRegex(linked(LIBRARIES['picking']), r'lib(GL|EGL)\.so')

    def test_the_node_links_no_parser_of_robots_files(self):
        self.assertNotRegex(linked(ROS_LIBRARY), r'lib(assimp|urdfdom\w*|tinyxml2?)\.so')

    def test_no_layer_before_ros_links_it(self):
        for library in LIBRARIES.values():
            self.assertNotRegex(linked(library), r'lib(ros|tf2|nodelet|xmlrpc)')


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1], verbosity=2)
