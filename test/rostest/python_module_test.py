#!/usr/bin/python3
"""Organs and queries of the Python module reach a real node, and its answers come back as arrays. Its examples work."""

import signal
import subprocess
import sys
import threading
import unittest

import numpy as np
from organ_collision import CollisionError, clearance_record, crossing_table, near_table, Organ, Queries
from organ_collision.msg import ContactArray
import roslib.packages
import rospy
import rostest

from support import scenes
from support.node_client import wait_until
from support.processes import program

SHEET = scenes.sheet(0.1, 4)
VERTICES, FACES = np.array(SHEET.vertices), np.array(SHEET.faces)
RADIUS = 0.005
TROCAR, TIP = np.array([0.013, 0.007, 0.2]), np.array([0.013, 0.007, 0.002])
UP = np.array([0.0, 0.0, 1.0])
LIMIT = 20.0  # [s]


def depth_at(z):
    """How deep the tip at TIP is in a sheet at this height."""
    return RADIUS - (TIP[2] - z)


class PythonModuleTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.queries = Queries(timeout=LIMIT)

    def organ(self, name, *arguments):
        organ = Organ(name, VERTICES, FACES, *arguments)
        self.addCleanup(organ.remove)
        self.queries.wait_for(name, LIMIT, *arguments)
        return organ

    def test_contacts_are_tables(self):
        self.organ('sheet')
        contacts = self.queries.query('sheet', TROCAR, TIP, RADIUS)
        deepest = contacts[contacts.depth.argmax()]
        self.assertAlmostEqual(deepest.depth, depth_at(0), delta=1e-7)
        np.testing.assert_allclose(deepest.point, [*TIP[:2], 0.0], atol=1e-7)
        np.testing.assert_array_equal(contacts.vertices, FACES[contacts.face])
        np.testing.assert_allclose(np.einsum('ij,ijk->ik', contacts.barycentric, VERTICES[contacts.vertices]),
                                   contacts.point, atol=1e-7)
        swept = self.queries.query('sheet', TROCAR, TIP - 0.1 * UP, RADIUS, previous_tip=TIP + 0.1 * UP)
        self.assertGreater(len(swept), 0)
        self.assertTrue(((swept.fraction > 0) & (swept.fraction < 1)).all())
        near = self.queries.answer('sheet', TROCAR, TIP + 0.01 * UP, RADIUS, margin=0.05, max_near=3)
        self.assertAlmostEqual(clearance_record(near).distance, 0.01 - depth_at(0), delta=1e-7)
        self.assertAlmostEqual(-near_table(near).depth[0], clearance_record(near).distance, delta=1e-7)
        (crossing,) = crossing_table(self.queries.answer('sheet', TROCAR, TIP - 0.01 * UP, RADIUS, placement=True))
        self.assertEqual((abs(crossing.direction), crossing.point[2]), (1, 0.0))

    def test_many_motions_at_once(self):
        self.organ('sheet')
        tips = TIP + np.outer([0.0, 0.001, 1.0], UP)
        tables = self.queries.query_many('sheet', np.tile(TROCAR, (3, 1)), tips, RADIUS)
        self.assertEqual([len(table) > 0 for table in tables], [True, True, False])
        self.assertAlmostEqual(tables[1].depth.max(), depth_at(0) - 0.001, delta=1e-7)
        with self.assertRaisesRegex(ValueError, '1 trocars, 3 tips'):
            self.queries.query_many('sheet', [TROCAR], tips, RADIUS)

    def test_an_organ_moves_and_is_replaced(self):
        def wait_for_depth(depth):
            def is_so_deep():
                seen[:] = self.queries.query('sheet', TROCAR, TIP, RADIUS).depth.tolist()
                return seen and abs(max(seen) - depth) < 1e-7
            seen = []
            wait_until(is_so_deep, lambda: 'depth %g; there are %s' % (depth, seen))

        organ = self.organ('sheet')
        organ.move(VERTICES + 0.001 * UP)
        wait_for_depth(depth_at(0.001))
        organ.replace(VERTICES - 0.0005 * UP, FACES[::-1])
        wait_for_depth(depth_at(-0.0005))
        organ.move(VERTICES)
        wait_for_depth(depth_at(0))
        with self.assertRaisesRegex(ValueError, '24 vertices; sheet has 25'):
            organ.move(VERTICES[1:])

    def test_the_example_prints_contacts_with_a_file_and_with_the_kidney_that_ships(self):
        mesh = roslib.packages.get_pkg_dir('organ_collision') + '/urdf/meshes/jaw.stl'
        # The second organ is a kilometre large: each time, the probe begins far from where the last program left it.
        for arguments in ([mesh, '--scale', '5'], [mesh, '--scale', '50000'], []):
            process = subprocess.Popen([program('own_mesh.py'), *arguments], stdout=subprocess.PIPE, text=True)
            watchdog = threading.Timer(LIMIT, process.kill)
            watchdog.start()
            self.addCleanup(watchdog.cancel)
            printed = next((line for line in process.stdout if 'touches' in line), 'nothing')
            self.assertRegex(printed, r'^probe touches \d+ faces, deepest in face \d+: [0-4]\.\d mm$')
            process.send_signal(signal.SIGINT)
            process.communicate()
            self.assertEqual(process.returncode, 0)

    def test_the_example_asks_about_many_places(self):
        self.organ('tissue')
        printed = subprocess.check_output([program('ask_many.py')], timeout=LIMIT, text=True)
        places = [-0.08, -0.06, -0.04, -0.02, 0.0, 0.02, 0.04, 0.06, 0.08]
        expected = [self.queries.query('tissue', [x, 0.01, 0.1], [x, 0.01, 0], RADIUS).face for x in places]
        *places_lines, clearance_line = printed.splitlines()
        self.assertEqual([int(word) for line in places_lines for word in line.split('faces')[1].split()],
                         [face for faces in expected for face in faces])
        self.assertEqual([len(faces) > 0 for faces in expected], [abs(x) < 0.051 for x in places])
        self.assertEqual(clearance_line, 'x = -0.08 m: 25.0 mm away')

    def test_refusals_are_exceptions(self):
        self.organ('sheet', 'table')
        self.assertGreater(len(self.queries.query('sheet', TROCAR, TIP, RADIUS, frame='table')), 0)
        for error, ask in (
            ('^NO_TRANSFORM: ', lambda: self.queries.query('sheet', TROCAR, TIP, RADIUS)),
            ("^UNKNOWN_ORGAN: .*'sheeet'", lambda: self.queries.query('sheeet', TROCAR, TIP, RADIUS)),
            ('^UNKNOWN_ORGAN', lambda: self.queries.query_many('sheeet', [TROCAR], [TIP], RADIUS)),
            ('^UNKNOWN_ORGAN', lambda: self.queries.wait_for('sheeet', 0.1)),
            ('^INVALID_REQUEST: .*-1', lambda: self.queries.query('sheet', TROCAR, TIP, -1, frame='table')),
        ):
            with self.assertRaisesRegex(CollisionError, error) as raised:
                ask()
        self.assertEqual(raised.exception.status, ContactArray.INVALID_REQUEST)


if __name__ == '__main__':
    rospy.init_node('python_module_test')
    rostest.rosrun('organ_collision', 'python_module', PythonModuleTest, sys.argv)
