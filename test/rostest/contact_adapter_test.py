#!/usr/bin/python3
"""The forces and lists of faces that contact_adapter publishes behind the real collision node."""

import sys

import rospy
import rostest

from support import scenes
from support.contact_adapter_case import (
    CLEAR,
    PRESSED,
    RADIUS,
    SHEET,
    STIFFNESS,
    TOLERANCE,
    TROCAR,
    ContactAdapterCase,
    at_height,
)
from support.contact_case import faces_of, xyz
from support.node_client import wait_until
from support.vectors import cross


class ContactAdapterTest(ContactAdapterCase):
    def test_pressed_in_and_out_again(self):
        """The force is stiffness * depth along the outward normal, and zero once the tool has left.
        The faces are those of `contacts`."""
        outputs = self.connect()
        contacts = self.step(SHEET, PRESSED, vertices=True)['probe']
        self.assertGreater(len(contacts.contacts), 0)
        found = outputs.wait_for(self.stamp)
        self.assertEqual(found.header.frame_id, 'liver_frame')
        force = (0.0, 0.0, STIFFNESS * (RADIUS - 0.002))
        self.assert_near(xyz(found.wrench.force), force, TOLERANCE, 'force')
        faces = faces_of(contacts)
        wait_until(
            lambda: list(outputs.faces[-1].data) == faces,
            lambda: 'faces %s; there are %s' % (faces, outputs.faces[-1].data),
        )

        swept_out = self.step(SHEET, CLEAR, vertices=True)['probe']
        self.assertGreater(len(swept_out.contacts), 0)  # touched and left
        self.assert_wrench(outputs.wait_for(self.stamp), (0, 0, 0), (0, 0, 0))
        self.assertEqual(self.step(SHEET, CLEAR, vertices=True)['probe'].contacts, [])
        self.assert_wrench(outputs.wait_for(self.stamp), (0, 0, 0), (0, 0, 0))
        wait_until(lambda: not outputs.faces[-1].data, 'an empty list of faces')

    def test_torque_is_about_the_organ_frames_origin(self):
        outputs = self.connect(scenes.one_face())
        self.step(scenes.one_face(), PRESSED, vertices=True)
        force = (0.0, 0.0, STIFFNESS * (RADIUS - 0.002))
        place = (TROCAR[0], TROCAR[1], 0.0)
        self.assert_wrench(outputs.wait_for(self.stamp), force, cross(place, force))

    def test_vertex_forces_are_minus_the_wrench(self):
        """Also where the force is clipped, and when the tool leaves the tissue."""
        outputs = self.connect()
        lying = {'probe': ((-0.03, 0.007, 0.001), (0.03, 0.007, 0.0005))}
        count = 0
        for tools in (PRESSED, at_height(0.0007), lying, at_height(-0.01), CLEAR, CLEAR):
            contacts = self.step(SHEET, tools, vertices=True)['probe']
            wrench = outputs.wait_for(self.stamp).wrench
            found = outputs.wait_for_vertex_forces(self.stamp)
            self.assertEqual((found.organ, found.tool), (self.organ, 'probe'))
            self.assertEqual(found.header.frame_id, 'liver_frame')
            self.assertEqual(found.topology, contacts.topology)
            self.assertEqual(list(found.vertices), sorted(set(found.vertices)))
            forces = [xyz(force) for force in found.forces]
            places = [SHEET.vertices[vertex] for vertex in found.vertices]
            torques = [cross(*both) for both in zip(places, forces)]
            for vectors, minus in ((forces, wrench.force), (torques, wrench.torque)):
                total = [sum(axis) for axis in zip((0.0, 0.0, 0.0), *vectors)]
                self.assert_near(total, [-x for x in xyz(minus)], 1e-9, 'sum')
            count += len(forces)
        self.assertGreater(count, 10)
        self.assertEqual(list(found.vertices), [])  # clear of the tissue

    def test_a_finer_mesh_gives_the_same_force(self):
        """The tool presses, then rests in the tissue, straight or leaning; the sheet has 2 to 7200
        faces."""
        leaning = {'probe': ((0.1, 0.05, 0.3), (0.013, 0.007, 0.0015))}
        forces = []
        for cells in (1, 4, 17, 60):
            self.organ = 'sheet_of_%d' % cells
            shape = scenes.sheet(0.1, cells)
            outputs = self.connect(shape)
            found = []
            for tools in (PRESSED, PRESSED, leaning, leaning):
                self.step(shape, tools, vertices=True)
                found.append(xyz(outputs.wait_for(self.stamp).wrench.force))
            # found[2] is left out: the step into the lean begins inside the tissue, so its
            # normals are those of the straight tool.
            forces.append([found[0], found[1], found[3]])
        for found in forces:
            for force, height in zip(found, (0.002, 0.002, 0.0015)):
                expected = (0.0, 0.0, STIFFNESS * (RADIUS - height))
                self.assert_near(force, expected, TOLERANCE, 'force')

    def test_a_pierced_sheet_pushes_the_tip_back(self):
        """The force depends on the tip's depth below the sheet and on the radius, but not on how
        fine the sheet is."""
        for cells in (4, 60):
            self.organ = 'pierced_%d' % cells
            shape = scenes.sheet(0.1, cells)
            outputs = self.connect(shape)
            for _ in range(2):
                self.step(shape, at_height(-0.0005), vertices=True)
                force = xyz(outputs.wait_for(self.stamp).wrench.force)
                expected = (0.0, 0.0, STIFFNESS * (RADIUS + 0.0005))  # below the limit of the example
                self.assert_near(force, expected, TOLERANCE, 'force')

    def test_a_shaft_that_sinks_past_its_radius_is_pushed_on(self):
        """Even when the axis lies below the sheet, the force keeps its direction and grows."""
        outputs = self.connect()
        for height in (0.002, 0.0005, -0.0005, -0.0009):
            lying = {'probe': ((-0.03, 0.007, height), (0.03, 0.007, height))}
            self.step(SHEET, lying, vertices=True)
            force = xyz(outputs.wait_for(self.stamp).wrench.force)
            expected = (0.0, 0.0, STIFFNESS * (RADIUS - height))
            self.assert_near(force, expected, STIFFNESS * 0.001, 'force')


if __name__ == '__main__':
    rospy.init_node('contact_adapter_test')
    rostest.rosrun('organ_collision', 'forces', ContactAdapterTest, sys.argv)
