#!/usr/bin/python3
"""Bad messages to organ_mesh_adapter. The log or the collision node's status says what is wrong
with each, and the organ stays as it was."""

import sys

from organ_collision.msg import ContactArray
import rospy
from rosgraph_msgs.msg import Log
import rostest
from sensor_msgs.msg import PointField
from std_msgs.msg import String
from visualization_msgs.msg import Marker

from support import scenes
from support.foreign_meshes import cloud, deletion, marker, polygon_mesh, shape_mesh
from support.mesh_adapter_case import AXIS, RADIUS, MeshAdapterCase
from support.node_client import FAR_AWAY, shaft, wait_until

NAN = float('nan')
SHEET = scenes.sheet(0.1, 4).moved(lambda v: (v[0], v[1], v[2] + 0.1 * v[0]))
LOWER = SHEET.moved(lambda v: (v[0], v[1], v[2] + 0.03 * v[1] - 0.002))
LEGAL_TYPES = ['shape_msgs/Mesh', 'pcl_msgs/PolygonMesh', 'visualization_msgs/Marker']


def changed(message, **fields):
    for name, value in fields.items():
        setattr(message, name, value)
    return message


def changed_cloud(layout=(), **fields):
    message = polygon_mesh(SHEET, **dict(layout))
    changed(message.cloud, **fields)
    return message


class MeshAdapterInputTest(MeshAdapterCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.log = []
        cls.log_subscriber = rospy.Subscriber('/rosout', Log, cls.log.append)
        wait_until(lambda: cls.log_subscriber.get_num_connections() > 0, 'the log')

    def publish_until_logged(self, topic, message, words):
        """Sends the message until the log names its reason, which it does at most once a second."""

        def logged():
            if rospy.get_time() - sent[0] > 0.1:
                self.publish(topic, message)
                sent[0] = rospy.get_time()
            return [
                m
                for m in self.log[before:]
                if m.name == self.adapter
                and m.level >= Log.WARN
                and all(word in m.msg for word in [topic] + words)
            ]

        before, sent = len(self.log), [0.0]
        wait_until(
            logged,
            lambda: 'a warning with %s; there are %s' % (words, [m.msg for m in self.log[before:]]),
        )

    def assert_same(self, organ, good):
        now = self.node.query(organ, shaft(*AXIS, RADIUS))
        self.assertEqual(
            (now.status, now.mesh_stamp, now.topology, now.contacts),
            (good.status, good.mesh_stamp, good.topology, good.contacts),
        )

    def refuse(self, organ, topic, *cases, send_good):
        """Sends each of the cases (message, words that the log must contain). Checks that the organ
        stays as send_good made it, and that it can still be moved after all of them."""
        before = self.node.query(organ, FAR_AWAY).mesh_stamp
        send_good(SHEET)
        wait_until(
            lambda: self.node.query(organ, FAR_AWAY).mesh_stamp != before, 'a new shape of ' + organ
        )
        good = self.wait_for_contacts(organ, SHEET)
        for message, words in cases:
            self.publish_until_logged(topic, message, words)
            self.assert_same(organ, good)
        send_good(LOWER)
        self.assertEqual(self.wait_for_contacts(organ, LOWER).topology, good.topology)

    def test_polygon_meshes(self):
        fields = cloud(SHEET.vertices).fields
        integers = [PointField(f.name, f.offset, PointField.INT32, 1) for f in fields]
        short = polygon_mesh(SHEET)
        short.polygons[5].vertices = [1, 2]
        self.refuse(
            'polygons',
            '/sim/polygons',
            (changed_cloud(fields=fields[:2]), ['x, y', 'x, y and z']),
            (changed_cloud(fields=integers), ['field x', 'datatype 5', '7 (float32)']),
            (changed_cloud(data=b'\x01' * 299), ['299 bytes', '25 x 1']),
            (changed_cloud(width=2**32 - 1), ['300 bytes', '4294967295 x 1']),
            (changed_cloud(point_step=11), ['point_step is 11', '12']),
            (changed_cloud(height=2, row_step=7), ['row_step is 7', '300']),
            (short, ['polygon 5 has 2 corners', 'at least 3']),
            (polygon_mesh(SHEET, frame=''), ["'polygons'", "'frame'"]),
            send_good=lambda mesh: self.publish('/sim/polygons', polygon_mesh(mesh, padding=3)),
        )

    def test_markers(self):
        flat = marker(SHEET)
        flat.scale.z = 0.0
        turned = marker(SHEET)
        turned.pose.orientation.w = 3.0
        cut = marker(SHEET)
        cut.points = cut.points[:-1]
        self.refuse(
            'marker',
            '/sim/marker',
            (changed(marker(SHEET), type=Marker.CUBE_LIST), ['CUBE_LIST', 'TRIANGLE_LIST']),
            (marker(SHEET, name=('tools', 7)), ["'tools/7'", "'organs/7'"]),
            (deletion(Marker.DELETE, ('organs', 8)), ["'organs/8'", "'organs/7'"]),
            (deletion(9), ['action 9', 'ADD', 'DELETE']),
            (flat, ['scale is 1 1 0', 'more than 0']),
            (turned, ['orientation', 'length 3', 'must be 1']),
            (cut, ['95 points', 'multiple of three']),
            (marker(SHEET, frame=''), ["'marker'", "'frame'"]),
            send_good=lambda mesh: self.publish('/sim/marker', marker(mesh)),
        )

    def test_vertices(self):
        self.refuse(
            'shape',
            '/sim/shape_points',
            (cloud(SHEET.vertices[1:]), ['24 vertices', "'shape'", '25']),
            (cloud([]), ['0 vertices', '25']),
            (changed(cloud(SHEET.vertices), data=b''), ['0 bytes', '25 x 1']),
            (changed(cloud(SHEET.vertices), fields=[]), ['x, y and z']),
            send_good=lambda mesh: self.publish('/sim/shape', shape_mesh(mesh)),
        )

    def test_other_types(self):
        """Messages of another type have no effect, and the other organs still work."""
        text = String('solid liver')
        self.publish_until_logged('/sim/odd', text, ['std_msgs/String'] + LEGAL_TYPES)
        self.publish_until_logged(
            '/sim/odd_points', text, ['std_msgs/String', 'sensor_msgs/PointCloud2']
        )
        self.assertEqual(self.node.query('odd', FAR_AWAY).status, ContactArray.UNKNOWN_ORGAN)
        self.publish('/sim/shape', shape_mesh(SHEET))
        self.wait_for_contacts('shape', SHEET)

    def test_a_mesh_without_any_frame(self):
        words = ["'unframed'", "'frame'"]
        self.publish_until_logged('/sim/unframed', shape_mesh(SHEET), words)
        self.assertEqual(self.node.query('unframed', FAR_AWAY).status, ContactArray.UNKNOWN_ORGAN)

    def test_vertices_before_any_mesh(self):
        words = ["'unmeshed'", 'no mesh']
        self.publish_until_logged('/sim/unmeshed_points', cloud(SHEET.vertices), words)
        self.assertEqual(self.node.query('unmeshed', FAR_AWAY).status, ContactArray.UNKNOWN_ORGAN)

    def test_illegal_arrays_are_for_the_collision_node_to_refuse(self):
        """The status in `contacts` says so. The organ stays as it was, and later messages still
        work."""
        self.publish('/sim/polygons', polygon_mesh(SHEET))
        good = self.wait_for_contacts('polygons', SHEET)
        broken = polygon_mesh(scenes.sheet(0.1, 3))
        broken.polygons[4].vertices = [0, 1, 25]
        for message, word in (
            (polygon_mesh(SHEET.moved(lambda v: (v[0], NAN, v[2]))), 'nan'),
            (broken, '25'),
            (changed(polygon_mesh(SHEET), polygons=[]), 'no triangles'),
        ):
            message.header.stamp = rospy.Time.now()
            self.publish('/sim/polygons', message)
            answer = self.node.contacts.wait_for(
                'polygons', 'grasper', stamp=message.header.stamp, status=ContactArray.INVALID_REQUEST
            )
            self.assertIn(word, answer.message)
            self.assert_same('polygons', good)
        self.publish('/sim/polygons', polygon_mesh(LOWER))
        self.assertEqual(self.wait_for_contacts('polygons', LOWER).topology, good.topology)


if __name__ == '__main__':
    rospy.init_node('mesh_adapter_input_test')
    rostest.rosrun('organ_collision', 'mesh_adapter_input', MeshAdapterInputTest, sys.argv)
