#!/usr/bin/python3
"""contact_adapter and messages without forces: failures, malformed contacts, the paper's modes,
names that ROS does not allow."""

import math
import sys

from organ_collision.msg import Clearance, Contact, ContactArray, ToolPlacement
import rospy
import rostest

from support.contact_adapter_case import (
    CLEAR,
    PRESSED,
    SHEET,
    TOLERANCE,
    ContactAdapterCase,
    Diagnostics,
)
from support.contact_case import xyz
from support.node_client import wait_until


class ContactAdapterInputTest(ContactAdapterCase):
    def test_nothing_comes_while_a_transform_is_missing(self):
        """Nothing is published about the gap. Outputs before and after it are waited for, so that
        nothing can arrive later."""
        outputs, diagnostics = self.connect(), Diagnostics()
        self.step(SHEET, PRESSED, vertices=True)
        outputs.wait_for(self.stamp)
        wait_until(lambda: outputs.faces[-1].data, 'the faces before the gap')
        counts = len(outputs.wrenches), len(outputs.faces)
        missing = self.next_stamp()
        self.node.send_vertices(self.organ, SHEET, missing)
        failed = self.node.contacts.wait_for(self.organ, 'probe', mesh_stamp=missing)
        self.assertEqual(failed.status, ContactArray.NO_TRANSFORM)
        for _ in range(2):  # the first step leaves the sheet, the second stays clear of it
            self.step(SHEET, CLEAR, vertices=True)
        outputs.wait_for(self.stamp)
        wait_until(lambda: not outputs.faces[-1].data, 'an empty list of faces')
        self.assertEqual(outputs.of(missing), [])
        self.assertEqual((len(outputs.wrenches), len(outputs.faces)), tuple(n + 2 for n in counts))
        diagnostics.wait_for_count('unpublished, no transform', 1)

    def test_malformed_contacts_publish_nothing(self):
        """Another sender publishes malformed contacts on the same topic. The adapter continues to
        work."""
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

    def inside(self, state, distance=0.002):
        """An answer about a tool that is wholly inside. The nearest way out is along (0.6, 0, 0.8)."""
        answer = ContactArray(organ=self.organ, tool='probe', mode=ContactArray.SWEPT, links=[''])
        answer.header.frame_id, answer.header.stamp = 'liver_frame', self.next_stamp()
        answer.placement.tip = answer.placement.trocar = ToolPlacement.INSIDE
        clearance = answer.clearance
        clearance.state, clearance.distance, clearance.normal_defined = state, distance, True
        clearance.normal.x, clearance.normal.z = 0.6, 0.8
        clearance.face, clearance.vertices, clearance.barycentric = 7, [9, 2, 5], [0.5, 0.3, 0.2]
        clearance.on_organ.y = 0.25
        return answer

    def test_a_tool_wholly_inside_is_pushed_out(self):
        """The force ends at max_force. Beyond the margin, the way out is unknown, and nothing is
        published."""
        outputs, diagnostics = self.connect(), Diagnostics()
        sender = rospy.Publisher('/organ_collision/contacts', ContactArray, queue_size=10)
        wait_until(
            lambda: '/contact_adapter' in [info[1] for info in sender.impl.get_stats_info()],
            'the adapter to listen',
        )
        lost = self.inside(Clearance.BEYOND_MARGIN)
        sender.publish(lost)
        diagnostics.wait_for_count('unpublished, way out unknown', 1)
        self.assertEqual(outputs.of(lost.header.stamp), [])

        def whole_force_comes():
            """The force rises by stiffness * 0.05 m/s, up to the limit of the example."""
            answer = self.inside(Clearance.KNOWN)
            sender.publish(answer)
            found = outputs.wait_for(answer.header.stamp)
            return found if found.wrench.force.z > 2.4 - 1e-9 else None

        found = wait_until(whole_force_comes, 'the whole force')
        self.assert_wrench(found, (1.8, 0.0, 2.4), (0.6, 0.0, -0.45))
        forces = outputs.wait_for_vertex_forces(found.header.stamp)
        self.assertEqual(list(forces.vertices), [2, 5, 9])
        for share, force in zip((0.3, 0.2, 0.5), forces.forces):
            self.assert_near(xyz(force), (-1.8 * share, 0.0, -2.4 * share), TOLERANCE, 'force')
        sender.unregister()

    def test_contacts_without_barycentric_coordinates_have_no_vertex_forces(self):
        outputs, diagnostics = self.connect(), Diagnostics()
        sender = rospy.Publisher('/organ_collision/contacts', ContactArray, queue_size=10)
        wait_until(
            lambda: '/contact_adapter' in [info[1] for info in sender.impl.get_stats_info()],
            'the adapter to listen',
        )
        answer = ContactArray(organ=self.organ, tool='probe', contacts=[Contact(depth=0.001)])
        answer.header.frame_id, answer.header.stamp = 'liver_frame', self.next_stamp()
        answer.contacts[0].normal.z = -1.0
        sender.publish(answer)
        self.assert_wrench(outputs.wait_for(answer.header.stamp), (0.0, 0.0, 0.5), (0.0, 0.0, 0.0))
        diagnostics.wait_for_count('unpublished, no barycentric coordinates', 1)
        stamps = [forces.header.stamp for forces in outputs.vertex_forces]
        self.assertNotIn(answer.header.stamp, stamps)
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
        """Illegal characters become `_`. A second organ that would get the same topics is
        refused."""
        self.organ, diagnostics = 'left lobe', Diagnostics()
        outputs = self.connect(pair='left_lobe/probe')
        self.organ = 'left_lobe'
        self.step(SHEET, CLEAR)
        diagnostics.wait_for_count('unpublished, name taken', 1)
        self.assertEqual(outputs.of(self.stamp), [])


if __name__ == '__main__':
    rospy.init_node('contact_adapter_input_test')
    rostest.rosrun('organ_collision', 'forces_input', ContactAdapterInputTest, sys.argv)
