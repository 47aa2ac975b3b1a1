#!/usr/bin/python3
"""The grasper's files are up to date: jaw.stl with its script and, if xacro is installed, grasper.urdf with
grasper.urdf.xacro. The surface of the jaw is closed.

Usage: grasper_files_test.py SOURCE_FOLDER XACRO
"""

import os
import struct
import subprocess
import sys
import unittest
from xml.etree import ElementTree

URDF = os.path.join(sys.argv[1], 'urdf')
XACRO = sys.argv[2]
JAW_BOX = ((0.0001, 0.0026), (-0.002, 0.002), (0.0, 0.02))  # [m]


def read(*path):
    with open(os.path.join(URDF, *path), 'rb') as file:
        return file.read()


def elements(urdf):
    """The XML elements of a file, without comments and layout."""
    return ElementTree.canonicalize(urdf, strip_text=True)


class GrasperFilesTest(unittest.TestCase):

    def test_jaw_is_what_its_script_makes(self):
        made = subprocess.check_output([os.path.join(URDF, 'meshes', 'make_jaw.py')])
        self.assertEqual(made, read('meshes', 'jaw.stl'))

    def test_jaw_is_closed_and_outward(self):
        stl = read('meshes', 'jaw.stl')
        self.assertFalse(stl.startswith(b'solid'))  # that would be the start of an ASCII file
        self.assertEqual(struct.unpack_from('<I', stl, 80)[0], 500)
        faces = [struct.unpack_from('<9f', stl, 84 + 50 * i + 12) for i in range(500)]
        faces = [(f[0:3], f[3:6], f[6:9]) for f in faces]
        edges = [(f[i - 1], f[i]) for f in faces for i in range(3)]
        self.assertEqual(len(set(edges)), len(edges))
        self.assertEqual({(b, a) for a, b in edges}, set(edges))
        volume = sum(a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
                     + a[2] * (b[0] * c[1] - b[1] * c[0]) for a, b, c in faces) / 6
        self.assertGreater(volume, 0.5 * 0.02 * 0.003 * 0.0015)
        for axis, (low, high) in enumerate(JAW_BOX):
            places = [corner[axis] for face in faces for corner in face]
            self.assertAlmostEqual(min(places), low, delta=1e-4)
            self.assertAlmostEqual(max(places), high, delta=1e-4)

    @unittest.skipUnless(XACRO, 'xacro is not installed')
    def test_urdf_is_the_expanded_xacro(self):
        expanded = subprocess.check_output([XACRO, os.path.join(URDF, 'grasper.urdf.xacro')])
        self.assertEqual(elements(expanded), elements(read('grasper.urdf')))


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1], verbosity=2)
