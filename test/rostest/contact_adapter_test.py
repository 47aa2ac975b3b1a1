#!/usr/bin/python3
"""Forces and lists of faces behind the real collision node: what they are worth, that failures
publish nothing, and how the adapter starts."""

import math
import sys

import diagnostic_msgs.msg
from geometry_msgs.msg import WrenchStamped
from organ_collision.msg import Contact, ContactArray
import rospy
import rostest
from std_msgs.msg import UInt32MultiArray

from contact_case import faces_of, xyz
from node_client import wait_until
from node_starter import NodeStarter
import scenes
from tool_case import ToolCase
from vectors import cross

STIFFNESS = 500.0  # [N/m], of examples/forces.launch
RADIUS = 0.005  # [m], of examples/tools.yaml
TOLERANCE = 1e-6  # [N], [N m]: vertices are 32-bit floats, depths exact to 1e-9 m
SHEET = scenes.sheet(0.1, 4)
TROCAR = (0.013, 0.007, 0.4)


def at_height(height):
    """The tool straight above (0.013, 0.007), its tip at this height."""
    return {'probe': (TROCAR, (TROCAR[0], TROCAR[1], height))}


CLEAR = at_height(0.05)
PRESSED = at_height(0.002)  # 3 mm deep


class Outputs:
    """All that the adapter published of one organ and tool, in order."""

    def __init__(self, pair, node='/contact_adapter'):
        self.wrenches, self.faces = [], []
        self.subscribers = [
            rospy.Subscriber('%s/%s/wrench' % (node, pair), WrenchStamped, self.wrenches.append),
            rospy.Subscriber('%s/%s/faces' % (node, pair), UInt32MultiArray, self.faces.append),
        ]

    def of(self, stamp):
        return [wrench for wrench in self.wrenches if wrench.header.stamp == stamp]

    def wait_for(self, stamp):
        """The wrench of this time."""
        return wait_until(lambda: self.of(stamp), 'the wrench of %s' % stamp)[0]


class Diagnostics:
    """The latest of the adapter's own: its summary's words, and its values."""

    def __init__(self, node='contact_adapter'):
        self.node, self.message, self.values = node, '', {}
        self.subscriber = rospy.Subscriber(
            '/diagnostics', diagnostic_msgs.msg.DiagnosticArray, self._keep
        )

    def _keep(self, array):
        for status in array.status:
            if status.name.lstrip('/') == self.node + ': contacts':
                self.message = status.message
                self.values = {pair.key: pair.value for pair in status.values}

    def wait_for_count(self, key, count):
        wait_until(
            lambda: int(self.values.get(key, 0)) >= count, lambda: '%s: %s' % (key, self.values)
        )


class ContactAdapterTest(ToolCase, NodeStarter):
    def connect(self, shape=SHEET, pair=None):
        """The outputs of this test's organ, from the first that is sure to come: topics appear with
        an organ's first step."""
        outputs = Outputs(pair or self.organ + '/probe')

        def both_come():
            self.step(shape, CLEAR)
            return outputs.wrenches and outputs.faces

        wait_until(both_come, 'outputs of ' + self.organ)
        outputs.wait_for(self.stamp)  # No wrench is on its way any more.
        return outputs

    def assert_wrench(self, found, force, torque):
        self.assert_near(xyz(found.wrench.force), force, TOLERANCE, 'force')
        self.assert_near(xyz(found.wrench.torque), torque, TOLERANCE, 'torque')

    def test_pressed_in_and_out_again(self):
        """Along the outward normal, stiffness * depth; faces as in `contacts`; zero when it left."""
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

    def test_a_finer_mesh_gives_the_same_force(self):
        """Swept, resting in the tissue, and resting with a lean; from 2 faces to 7200."""
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
            # The step into the lean begins inside the tissue: its normals are those of its start.
            forces.append([found[0], found[1], found[3]])
        for found in forces:
            for force, height in zip(found, (0.002, 0.002, 0.0015)):
                expected = (0.0, 0.0, STIFFNESS * (RADIUS - height))
                self.assert_near(force, expected, TOLERANCE, 'force')

    def test_a_pierced_sheet_pushes_the_tip_back(self):
        """By its depth below the sheet and the radius, however fine the sheet around the hole."""
        for cells in (4, 60):
            self.organ = 'pierced_%d' % cells
            shape = scenes.sheet(0.1, cells)
            outputs = self.connect(shape)
            for _ in range(2):
                self.step(shape, at_height(-0.006), vertices=True)
                force = xyz(outputs.wait_for(self.stamp).wrench.force)
                expected = (0.0, 0.0, STIFFNESS * (RADIUS + 0.006))
                self.assert_near(force, expected, TOLERANCE, 'force')

    def test_nothing_comes_while_a_transform_is_missing(self):
        """Before the gap and after it, faces show that all that came until then is there."""
        outputs, diagnostics = self.connect(), Diagnostics()
        self.step(SHEET, PRESSED, vertices=True)
        outputs.wait_for(self.stamp)
        wait_until(lambda: outputs.faces[-1].data, 'the faces before the gap')
        counts = len(outputs.wrenches), len(outputs.faces)
        missing = self.next_stamp()
        self.node.send_vertices(self.organ, SHEET, missing)
        failed = self.node.contacts.wait_for(self.organ, 'probe', mesh_stamp=missing)
        self.assertEqual(failed.status, ContactArray.NO_TRANSFORM)
        for _ in range(2):  # out, and clear
            self.step(SHEET, CLEAR, vertices=True)
        outputs.wait_for(self.stamp)
        wait_until(lambda: not outputs.faces[-1].data, 'an empty list of faces')
        self.assertEqual(outputs.of(missing), [])
        self.assertEqual((len(outputs.wrenches), len(outputs.faces)), tuple(n + 2 for n in counts))
        diagnostics.wait_for_count('unpublished, no transform', 1)

    def test_malformed_contacts_publish_nothing(self):
        """From another sender on the same topic; the adapter goes on."""
        outputs, diagnostics = self.connect(), Diagnostics()
        sender = rospy.Publisher('/organ_collision/contacts', ContactArray, queue_size=10)
        wait_until(
            lambda: '/contact_adapter' in [info[1] for info in sender.impl.get_stats_info()],
            'the adapter to listen',
        )
        good = self.node.contacts.of(self.organ, 'probe')[-1]
        stamp = rospy.Time(7)
        for depth, normal_z, mode in (
            (float('nan'), 1.0, ContactArray.STATIC),
            (0.001, float('nan'), ContactArray.SWEPT),
            (float('inf'), 1.0, ContactArray.STATIC),
            (0.001, 0.0, ContactArray.STATIC),
            (0.001, 1.0, 9),
        ):
            bad = ContactArray(organ=self.organ, tool='probe', mode=mode, links=[''])
            bad.header.frame_id, bad.header.stamp = good.header.frame_id, stamp
            bad.contacts = [Contact(depth=depth)]
            bad.contacts[0].normal.z = normal_z
            sender.publish(bad)
        diagnostics.wait_for_count('unpublished, malformed contacts', 5)
        self.step(SHEET, PRESSED, vertices=True)
        found = outputs.wait_for(self.stamp)
        self.assertGreater(found.wrench.force.z, 0.0)
        self.assertEqual(outputs.of(stamp), [])
        self.assertTrue(all(math.isfinite(w.wrench.force.z) for w in outputs.wrenches))
        sender.unregister()

    def test_the_papers_modes_have_faces_alone(self):
        outputs = self.connect()
        sender = rospy.Publisher('/organ_collision/contacts', ContactArray, queue_size=10)
        wait_until(
            lambda: '/contact_adapter' in [info[1] for info in sender.impl.get_stats_info()],
            'the adapter to listen',
        )
        count = len(outputs.wrenches)
        unrefined = ContactArray(organ=self.organ, tool='probe', mode=ContactArray.PAPER_SWEPT)
        unrefined.header.frame_id = 'liver_frame'
        unrefined.contacts = [Contact(face=3), Contact(face=17)]
        sender.publish(unrefined)
        wait_until(lambda: list(outputs.faces[-1].data) == [3, 17], 'the faces')
        self.step(SHEET, CLEAR, vertices=True)
        outputs.wait_for(self.stamp)
        self.assertEqual(len(outputs.wrenches), count + 1)
        sender.unregister()

    def test_names_that_ros_does_not_allow(self):
        """Other characters become `_`; a second organ of the same topics is refused."""
        self.organ, diagnostics = 'left lobe', Diagnostics()
        outputs = self.connect(pair='left_lobe/probe')
        self.organ = 'left_lobe'
        self.step(SHEET, CLEAR)
        diagnostics.wait_for_count('unpublished, name taken', 1)
        self.assertEqual(outputs.of(self.stamp), [])

    def start_adapter(self, parameters):
        return self.start('/' + self.organ, parameters, 'contact_adapter')

    def test_larger_forces_are_clipped(self):
        """1.5 N to 1 N, at the same place; smaller ones stay. The log and /diagnostics say so."""
        name, diagnostics = self.organ, Diagnostics(self.organ)
        process = self.start_adapter({'stiffness': STIFFNESS, 'max_force': 1.0})
        outputs = Outputs(self.organ + '/probe', '/' + name)

        def both_come():
            self.step(scenes.one_face(), CLEAR)
            return outputs.wrenches

        wait_until(both_come, 'the wrenches of ' + name)
        self.step(scenes.one_face(), at_height(0.004), vertices=True)
        place = (TROCAR[0], TROCAR[1], 0.0)
        force = (0.0, 0.0, STIFFNESS * 0.001)
        self.assert_wrench(outputs.wait_for(self.stamp), force, cross(place, force))
        self.step(scenes.one_face(), PRESSED, vertices=True)
        self.assert_wrench(
            outputs.wait_for(self.stamp), (0.0, 0.0, 1.0), cross(place, (0.0, 0.0, 1.0))
        )
        diagnostics.wait_for_count('clipped, max_force', 1)
        self.assertIn('the force is clipped to 1.000000 N', self.stop(process))

    def test_a_shaft_that_sinks_past_its_radius_is_pushed_on(self):
        """The axis comes to lie below the sheet: the force keeps its direction and grows."""
        outputs = self.connect()
        for height in (0.002, 0.0005, -0.0005, -0.002):
            lying = {'probe': ((-0.03, 0.007, height), (0.03, 0.007, height))}
            self.step(SHEET, lying, vertices=True)
            force = xyz(outputs.wait_for(self.stamp).wrench.force)
            expected = (0.0, 0.0, STIFFNESS * (RADIUS - height))
            self.assert_near(force, expected, STIFFNESS * 0.001, 'force')

    def test_illegal_stiffness_stops_the_node(self):
        for stiffness, shown in (
            (0, "'0'"),
            (-12.5, "'-12.5'"),
            ('soft', "'soft'"),
            (float('nan'), "'nan'"),
            (float('inf'), "'inf'"),
        ):
            self.assert_refused(
                self.start_adapter({'stiffness': stiffness}),
                ['~stiffness is %s; must be a number, more than 0' % shown],
            )

    def test_misspelt_names_are_reported(self):
        diagnostics = Diagnostics(self.organ)
        process = self.start_adapter({'stifness': 500})
        wait_until(lambda: 'stifness' in diagnostics.message, lambda: diagnostics.message)
        self.assertIn("stifness is no parameter; nearest is 'stiffness'", self.stop(process))


if __name__ == '__main__':
    rospy.init_node('contact_adapter_test')
    rostest.rosrun('organ_collision', 'forces', ContactAdapterTest, sys.argv)
