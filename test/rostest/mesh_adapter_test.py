#!/usr/bin/python3
"""Meshes in each message type that organ_mesh_adapter accepts. The contacts are those of the same
mesh in an OrganMesh. Shapes and triangles may change, and organs may be removed."""

import sys

from organ_collision.msg import ContactArray, OrganVertices
import rospy
import rostest
from sensor_msgs.msg import PointField
from visualization_msgs.msg import Marker

from support import oracle, scenes
from support.contact_case import faces_of
from support.foreign_meshes import cloud, deletion, marker, polygon_mesh, shape_mesh
from support.mesh_adapter_case import (
    AXIS,
    RADIUS,
    AdapterDiagnostics,
    MeshAdapterCase,
    MessageLog,
)
from support.node_client import TfSender, shaft, wait_until

SHEET = scenes.sheet(0.1, 4).moved(lambda v: (v[0], v[1], v[2] + 0.1 * v[0]))
LOWER = SHEET.moved(lambda v: (v[0], v[1], v[2] + 0.03 * v[1] - 0.002))
LOWEST = SHEET.moved(lambda v: (1.1 * v[0], v[1], v[2] - 0.003))
FINE = scenes.sheet(0.1, 7)
POSE = scenes.Pose((0.1, 0.25, -0.15, 0.95), (0.3, -0.2, 0.1))
BIG_DOUBLES = {'order': 'zxy', 'datatype': PointField.FLOAT64, 'padding': 5, 'big_endian': True}


class MeshAdapterTest(MeshAdapterCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.vertices = MessageLog('/organ_collision/organ_vertices', OrganVertices)
        cls.tf = TfSender()
        cls.tf.wait_for(cls.node)
        cls.tf.send_resting(
            *[
                ('liver_frame', 'grasper' + end, scenes.Pose((0, 0, 0, 1), point))
                for end, point in zip(('_trocar', '_tip'), AXIS)
            ]
        )

    def kinds(self):
        """{organ: function that publishes a mesh in the organ's message type}. It takes a stamp if
        the type has one."""
        return {
            'shape': lambda mesh, stamp=None: self.publish('/sim/shape', shape_mesh(mesh)),
            'marker': lambda mesh, stamp=rospy.Time(): self.publish(
                '/sim/marker', marker(mesh, stamp=stamp)
            ),
            'polygons': lambda mesh, stamp=rospy.Time(): self.publish(
                '/sim/polygons', polygon_mesh(mesh, stamp=stamp, padding=4)
            ),
        }

    def test_contacts_are_those_of_the_same_mesh_sent_as_it_is_wanted(self):
        self.node.send_mesh('native', SHEET)
        self.wait_for_contacts('native', SHEET)
        sweep = shaft(*AXIS, RADIUS, previous=((0.3, 0.2, 0.1), (-0.04, 0.01, -0.02)))
        native = self.node.query('native', sweep, ContactArray.SWEPT)
        self.assertGreater(len(native.contacts), 2)
        for organ, send in self.kinds().items():
            send(SHEET)
            self.wait_for_contacts(organ, SHEET)
            answer = self.node.query(organ, sweep, ContactArray.SWEPT)
            self.assertEqual(faces_of(answer), faces_of(native), organ)

    def test_contacts_are_published(self):
        expected = oracle.static_contacts(SHEET, AXIS, RADIUS)
        for organ, send in self.kinds().items():
            self.node.reset()
            begin = rospy.Time.now()
            send(SHEET, begin)
            answer = wait_until(
                lambda: [
                    message
                    for message in self.node.contacts.of(organ, 'grasper')
                    if message.mesh_stamp >= begin
                ],
                'contacts of ' + organ,
            )[0]
            if organ == 'shape':  # The stamp is the time of arrival.
                self.assertLess(answer.mesh_stamp, rospy.Time.now())
            else:
                self.assertEqual(answer.mesh_stamp, begin)
            self.assertEqual(answer.header.frame_id, 'liver_frame')
            self.assert_contacts(answer, expected, 1e-6)

    def test_the_same_triangles_are_vertices(self):
        for organ, send in self.kinds().items():
            send(FINE)
            send(SHEET)
            topology = self.wait_for_contacts(organ, SHEET).topology
            send(LOWER)
            self.assertEqual(self.wait_for_contacts(organ, LOWER).topology, topology)
            wait_until(
                lambda: [m for m in self.vertices.of(organ) if m.topology == topology],
                'vertices of ' + organ,
            )

    def test_vertices_alone(self):
        layouts = {'shape': {}, 'marker': BIG_DOUBLES, 'polygons': {'order': 'yzx', 'padding': 16}}
        for organ, send in self.kinds().items():
            send(SHEET)
            topology = self.wait_for_contacts(organ, SHEET).topology
            vertices = LOWEST.vertices
            if organ == 'marker':
                vertices = [LOWEST.vertices[i] for i in LOWEST.flat_faces()]
            stamp = rospy.Time.now()
            topic = '/sim/%s_points' % organ.replace('polygons', 'polygon')
            self.publish(topic, cloud(vertices, stamp=stamp, **layouts[organ]))
            answer = self.wait_for_contacts(organ, LOWEST)
            self.assertEqual((answer.topology, answer.mesh_stamp), (topology, stamp))

    def test_other_triangles_are_a_mesh_of_the_next_topology(self):
        for organ, send in self.kinds().items():
            send(SHEET)
            topology = self.wait_for_contacts(organ, SHEET).topology
            send(FINE)
            answer = self.wait_for_contacts(organ, FINE)
            self.assertEqual(answer.topology, (topology + 1) % 2**32)

    def test_an_empty_mesh_removes_the_organ(self):
        for organ, send in self.kinds().items():
            send(SHEET)
            self.wait_for_contacts(organ, SHEET)
            send(scenes.Mesh([], []))
            self.wait_until_removed(organ)
            send(SHEET)
            self.wait_for_contacts(organ, SHEET)

    def test_a_deleted_marker_removes_the_organ(self):
        for name, action in ((('organs', 7), Marker.DELETE), (('', 0), Marker.DELETEALL)):
            self.publish('/sim/marker', marker(SHEET))
            self.wait_for_contacts('marker', SHEET)
            self.publish('/sim/marker', deletion(action, name))
            self.wait_until_removed('marker')

    def test_pose_and_scale_of_a_marker(self):
        self.publish('/sim/marker', marker(LOWER, pose=POSE, scale=(2.0, 0.5, 1.25)))
        self.wait_for_contacts('marker', LOWER)

    def test_polygons_are_fans(self):
        message = polygon_mesh(scenes.sheet(0.1, 1))
        message.polygons = message.polygons[:1]
        message.polygons[0].vertices = [0, 1, 3, 2]
        self.publish('/sim/polygons', message)
        self.wait_for_contacts('polygons', scenes.sheet(0.1, 1))

    def test_the_parameter_overrides_the_frame_of_the_messages(self):
        self.publish('/sim/framed', polygon_mesh(SHEET, frame='world'))
        self.assertEqual(self.wait_for_contacts('framed', SHEET).header.frame_id, 'liver_frame')
        self.publish('/sim/framed', polygon_mesh(LOWER, frame=''))
        self.wait_for_contacts('framed', LOWER)

    def test_diagnostics_count_messages(self):
        """Each organ's messages are counted, those that are refused by reason."""
        adapter = AdapterDiagnostics(self.adapter)

        def wait_for(key, count):
            wait_until(lambda: int(adapter.values.get(key, 0)) >= count, lambda: adapter.values)

        for count in (1, 2):  # One after the other: of points that wait, only the newest count.
            self.publish('/sim/unmeshed_points', cloud(SHEET.vertices, frame='liver_frame'))
            wait_for('refused, /sim/unmeshed_points: no mesh', count)
        self.publish('/sim/framed', polygon_mesh(SHEET))
        wait_for('framed, messages converted', 1)
        self.assertEqual(adapter.values['organs'], '7')
        self.assertGreaterEqual(int(adapter.values['framed, messages received']), 1)
        self.assertGreaterEqual(float(adapter.values['framed, age of last [s]']), 0.0)
        self.assertIn("organ 'odd': nothing came yet on /sim/odd", adapter.summary)


if __name__ == '__main__':
    rospy.init_node('mesh_adapter_test')
    rostest.rosrun('organ_collision', 'mesh_adapter', MeshAdapterTest, sys.argv)
