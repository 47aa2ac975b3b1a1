#!/usr/bin/python3
"""organ_mesh_adapter between a simulator and a node: meshes of each type, refusals, and whoever starts again."""

import math
import sys

from organ_collision.msg import ContactArray, OrganVertices
import rospy
from rosgraph_msgs.msg import Log as LogLine
import rostest
from std_msgs.msg import String

from support import scenes
from support.contact_case import ContactCase
from support.foreign_meshes import cloud, marker, polygon_mesh, shape_mesh
from support.node_client import FAR_AWAY, Diagnostics, Log, NodeClient, is_heard, shaft, wait_until
from support.processes import NodeStarter
from support.tool_over_sheet import RADIUS, SHEET, at_height, depth_at

ADAPTER = '/organ_mesh_adapter'
AXIS = at_height(0.002)
LOWER, LOWEST = (SHEET.moved(lambda v: (v[0], v[1], v[2] - down)) for down in (0.001, 0.002))
FINE, FINE_LOWER = scenes.sheet(0.1, 7), scenes.sheet(0.1, 7, -0.001)
ORGAN = {'name': 'liver', 'topic': '/restart/liver', 'frame': 'liver_frame'}


def of(log, organ):
    return log.select(lambda message: message.organ == organ)


class MeshAdapterTest(ContactCase, NodeStarter):
    @classmethod
    def setUpClass(cls):
        cls.node = NodeClient()
        cls.publishers = {}
        cls.log = Log('/rosout', LogLine).wait_for_publisher()
        cls.vertices = Log('/organ_collision/organ_vertices', OrganVertices)

    @classmethod
    def publish(cls, topic, message, adapter=ADAPTER):
        """Publishes once the adapter listens to the topic."""
        if topic not in cls.publishers:
            cls.publishers[topic] = rospy.Publisher(topic, type(message), queue_size=100)
        publisher = cls.publishers[topic]
        wait_until(lambda: is_heard(publisher, adapter), '%s to listen to %s' % (adapter, topic))
        publisher.publish(message)

    @classmethod
    def send(cls, organ, mesh):
        """Publishes a mesh in the organ's message type."""
        make = {'shape': shape_mesh, 'marker': marker, 'polygons': polygon_mesh}[organ]
        cls.publish('/sim/' + organ, make(mesh))

    def wait_for_contacts(self, organ, mesh, node=None, send=lambda: None):
        """Waits until the node's answer about the organ is that about `mesh`, a level sheet, and sends it meanwhile."""
        depth = depth_at(AXIS[1][2] - mesh.vertices[0][2])

        def same():
            send()
            result = (node or self.node).query(organ, shaft(*AXIS, RADIUS))
            seen[:] = [result.status, result.message, max((c.depth for c in result.contacts), default=math.inf)]
            return result if abs(seen[2] - depth) < 1e-6 else None

        seen = []
        return wait_until(same, lambda: 'a depth of %g in %s; there is %s' % (depth, organ, seen))

    def test_meshes_of_each_type(self):
        """They move with the same topology, and get the next one with other triangles, or from a sender that has begun
        anew. An empty one, or the end of a marker's lifetime, removes the organ."""
        for organ in ('shape', 'polygons', 'marker'):
            self.send(organ, SHEET)
            topology = self.wait_for_contacts(organ, SHEET).topology
            self.send(organ, LOWER)
            self.assertEqual(self.wait_for_contacts(organ, LOWER).topology, topology)
            wait_until(lambda: [m for m in of(self.vertices, organ) if m.topology == topology], 'vertices of ' + organ)
            corners = [LOWEST.vertices[i] for i in LOWEST.flat_faces()] if organ == 'marker' else LOWEST.vertices
            stamp = rospy.Time.now()
            self.publish('/sim/%s_points' % organ, cloud(corners, stamp=stamp))
            answer = self.wait_for_contacts(organ, LOWEST)
            self.assertEqual((answer.topology, answer.mesh_stamp), (topology, stamp))
            self.send(organ, FINE)
            self.assertEqual(self.wait_for_contacts(organ, FINE).topology, (topology + 1) % 2**32)
            self.publishers.pop('/sim/' + organ).unregister()
            self.send(organ, FINE_LOWER)
            self.assertEqual(self.wait_for_contacts(organ, FINE_LOWER).topology, (topology + 2) % 2**32)
            if organ == 'marker':
                message = marker(FINE)
                message.lifetime = rospy.Duration(0.3)
                self.publish('/sim/marker', message)
            else:
                self.send(organ, scenes.Mesh([], []))
            wait_until(lambda: self.node.query(organ, FAR_AWAY).status == ContactArray.NO_MESH, 'removal of ' + organ)

    def test_refusals(self):
        """The log names topic and reason, and the organ stays as it was. /diagnostics counts messages by organ and
        reason."""
        said = Diagnostics(ADAPTER)
        self.send('shape', SHEET)
        before = self.wait_for_contacts('shape', SHEET)
        for topic, message, *words in (
            ('/sim/shape_points', cloud(SHEET.vertices[1:]), '24 vertices', "'shape'", '25'),
            ('/sim/odd', String('solid liver'), 'std_msgs/String', 'shape_msgs/Mesh', 'pcl_msgs/PolygonMesh'),
        ):
            self.publish(topic, message)
            wait_until(lambda: self.log.select(lambda m: m.name == ADAPTER and m.level >= LogLine.WARN
                                               and all(word in m.msg for word in [topic] + words)),
                       lambda: '%s in %s' % (words, [m.msg for m in self.log.messages]))
        now = self.node.query('shape', shaft(*AXIS, RADIUS))
        self.assertEqual((now.status, now.topology, now.contacts), (0, before.topology, before.contacts))
        self.assertEqual(self.node.query('odd', FAR_AWAY).status, ContactArray.UNKNOWN_ORGAN)
        said.wait_for_count('refused, /sim/shape_points: wrong number of vertices')
        self.assertGreaterEqual(said.count('shape, messages received'), said.count('shape, messages converted'))
        process = self.start('/wrong', {'organs': [dict(ORGAN, scale=0)]}, 'organ_mesh_adapter')
        self.assert_refused(process, ('~organs[0]/scale is 0', 'above 0'))


if __name__ == '__main__':
    rospy.init_node('mesh_adapter_test')
    rostest.rosrun('organ_collision', 'mesh_adapter', MeshAdapterTest, sys.argv)
