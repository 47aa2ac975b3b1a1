#!/usr/bin/python3
"""What stands in for the dVRK is consistent: its kinematics, the URDF of the instrument, and the organ's surface. The
grasper's files are up to date: jaw.stl with its script and, if xacro is installed, grasper.urdf with
grasper.urdf.xacro. The surface of the jaw is closed.

Usage: example_files_test.py SOURCE_FOLDER XACRO
"""

import importlib.util
import os
import struct
import subprocess
import sys
import unittest
from xml.etree import ElementTree

import numpy as np
from PyKDL import Frame, Rotation, Vector

SOURCE, XACRO = sys.argv[1:3]
RANDOM = np.random.default_rng(5)
JAW_BOX = ((0.0001, 0.0026), (-0.002, 0.002), (0.0, 0.02))  # [m]


def example(name):
    """The module in examples/NAME.py."""
    spec = importlib.util.spec_from_file_location(name, os.path.join(SOURCE, 'examples', name + '.py'))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def read(*path):
    with open(os.path.join(SOURCE, 'urdf', *path), 'rb') as file:
        return file.read()


def elements(urdf):
    """The XML elements of a file, without comments and layout."""
    return ElementTree.canonicalize(urdf, strip_text=True)


ROBOT, ORGAN = example('dvrk_robot'), example('dvrk_organ')
URDF = ElementTree.parse(os.path.join(SOURCE, 'urdf', 'psm.urdf'))


def vector(text):
    return Vector(*[float(word) for word in text.split()])


def link_in_tip(link, positions):
    """The pose of a link in the frame of the tip, if the joints have these positions."""
    if link == 'PSM_tip':
        return Frame()
    joint = next(joint for joint in URDF.iter('joint') if joint.find('child').get('link') == link)
    return link_in_tip(joint.find('parent').get('link'), positions) * origin(joint) * motion(joint, positions)


def origin(joint):
    element = joint.find('origin')
    if element is None:
        return Frame()
    return Frame(Rotation.RPY(*vector(element.get('rpy', '0 0 0'))), vector(element.get('xyz', '0 0 0')))


def motion(joint, positions):
    if joint.get('type') == 'fixed':
        return Frame()
    axis, mimic = vector(joint.find('axis').get('xyz')), joint.find('mimic')
    position = positions[joint.get('name')] if mimic is None \
        else positions[mimic.get('joint')] * float(mimic.get('multiplier'))
    return Frame(axis * position) if joint.get('type') == 'prismatic' else Frame(Rotation.Rot(axis, position))


def random_joints():
    joints = RANDOM.uniform(-0.7, 0.7, 6)
    joints[2] = RANDOM.uniform(0.05, 0.24)
    return dict(zip(ROBOT.JOINTS, joints.tolist()))


class ExampleFilesTest(unittest.TestCase):
    def test_the_shaft_passes_through_the_remote_centre(self):
        for _ in range(100):
            joints = random_joints()
            shaft = ROBOT.forward_kinematics(**joints) * link_in_tip('PSM_shaft', joints)
            centre = shaft.Inverse().p  # The remote centre in the frame of the shaft.
            self.assertAlmostEqual(centre.x(), 0, delta=1e-9)
            self.assertAlmostEqual(centre.y(), 0, delta=1e-9)
            self.assertAlmostEqual(centre.z(), -(joints['insertion'] - 0.4318 + 0.4162), delta=1e-9)

    def test_the_urdf_leads_back_to_the_remote_centre(self):
        for _ in range(100):
            joints = random_joints()
            centre = ROBOT.forward_kinematics(**joints) * link_in_tip('PSM_remote_centre', joints)
            np.testing.assert_allclose(list(centre.p), [0, 0, 0], atol=1e-9)
            np.testing.assert_allclose(list(centre.M.GetRot()), [0, 0, 0], atol=1e-9)

    def test_the_shaft_turns_with_the_roll_alone(self):
        joints = random_joints()
        x = [(ROBOT.forward_kinematics(**joints) * link_in_tip('PSM_shaft', joints)).M.UnitX()]
        for joint, turn in (('wrist_pitch', 0), ('wrist_yaw', 0), ('insertion', 0), ('roll', 0.3)):
            joints[joint] += 0.3
            x.append((ROBOT.forward_kinematics(**joints) * link_in_tip('PSM_shaft', joints)).M.UnitX())
            self.assertAlmostEqual(np.dot(list(x[-2]), list(x[-1])), np.cos(turn), delta=1e-9, msg=joint)

    def assert_closed(self, corners, volume, tolerance):
        """Checks that the faces of corners, m x 3 x 3 [m], are a closed surface, outward, around this volume."""
        _, places = np.unique(corners.reshape(-1, 3).round(9), axis=0, return_inverse=True)
        edges = [(f[i - 1], f[i]) for f in places.reshape(-1, 3).tolist() for i in range(3)]
        self.assertEqual(len(set(edges)), len(edges))
        self.assertEqual({(b, a) for a, b in edges}, set(edges))
        a, b, c = corners.swapaxes(0, 1)
        self.assertAlmostEqual(np.einsum('ij,ij->', a, np.cross(b, c)) / 6, volume, delta=tolerance * volume)

    def test_the_organ_is_closed_and_outward(self):
        vertices, faces = ORGAN.ellipsoid(ORGAN.RADII)
        self.assert_closed(vertices[faces], 4 / 3 * np.pi * np.prod(ORGAN.RADII), 0.02)

    def test_the_jaw_is_what_its_script_makes_closed_and_outward(self):
        stl = read('meshes', 'jaw.stl')
        self.assertEqual(subprocess.check_output([os.path.join(SOURCE, 'urdf', 'meshes', 'make_jaw.py')]), stl)
        self.assertFalse(stl.startswith(b'solid'))  # that would be the start of an ASCII file
        self.assertEqual(struct.unpack_from('<I', stl, 80)[0], 500)
        corners = np.array([struct.unpack_from('<9f', stl, 84 + 50 * i + 12) for i in range(500)]).reshape(-1, 3, 3)
        self.assert_closed(corners, 0.75 * 0.02 * 0.003 * 0.0015, 0.34)
        for axis, (low, high) in enumerate(JAW_BOX):
            self.assertAlmostEqual(corners[..., axis].min(), low, delta=1e-4)
            self.assertAlmostEqual(corners[..., axis].max(), high, delta=1e-4)

    @unittest.skipUnless(XACRO, 'xacro is not installed')
    def test_urdf_is_the_expanded_xacro(self):
        expanded = subprocess.check_output([XACRO, os.path.join(SOURCE, 'urdf', 'grasper.urdf.xacro')])
        self.assertEqual(elements(expanded), elements(read('grasper.urdf')))


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1], verbosity=2)
