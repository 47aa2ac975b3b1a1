#!/usr/bin/python3
"""Meshes in each message type that organ_mesh_adapter accepts: shapes and triangles change, and organs are removed.
What it refuses. Adapters and collision nodes that start again, and illegal parameters."""

import sys

from organ_collision.msg import ContactArray, OrganMesh, OrganVertices
import rospy
from rosgraph_msgs.msg import Log as LogLine
import rostest
from sensor_msgs.msg import PointField
from std_msgs.msg import String
from visualization_msgs.msg import Marker

from support import oracle, scenes
from support.contact_case import ContactCase
from support.foreign_meshes import cloud, deletion, marker, polygon_mesh, shape_mesh
from support.node_client import FAR_AWAY, Diagnostics, Log, NodeClient, TfSender, is_heard, shaft, wait_until
from support.processes import NodeStarter

ADAPTER = '/organ_mesh_adapter'
AXIS, RADIUS = ((0.01, 0.02, 0.3), (0.011, 0.017, 0.002)), 0.005
SHEET = scenes.sheet(0.1, 4).moved(lambda v: (v[0], v[1], v[2] + 0.1 * v[0]))
LOWER = SHEET.moved(lambda v: (v[0], v[1], v[2] + 0.03 * v[1] - 0.002))
LOWEST = SHEET.moved(lambda v: (1.1 * v[0], v[1], v[2] - 0.003))
FINE = scenes.sheet(0.1, 7)
POSE = scenes.Pose((0.1, 0.25, -0.15, 0.95), (0.3, -0.2, 0.1))
LAYOUTS = {'shape': {}, 'polygons': {'order': 'yzx', 'padding': 16},
           'marker': {'order': 'zxy', 'datatype': PointField.FLOAT64, 'padding': 5, 'big_endian': True}}
ORGAN = {'name': 'liver', 'topic': '/restart/liver', 'frame': 'liver_frame'}
TOOL = {'name': 'probe', 'trocar_frame': 'trocar', 'tip_frame': 'tip', 'radius': RADIUS}


def changed(message, **fields):
    for name, value in fields.items():
        setattr(message, name, value)
    return message


def of(log, organ):
    return log.select(lambda message: message.organ == organ)


class MeshAdapterTest(ContactCase, NodeStarter):
    @classmethod
    def setUpClass(cls):
        cls.node = NodeClient()
        cls.publishers = {}
        cls.log = Log('/rosout', LogLine).wait_for_publisher()
        cls.vertices = Log('/organ_collision/organ_vertices', OrganVertices)
        cls.tf = TfSender()
        cls.tf.wait_for(cls.node)
        cls.tf.send_resting(*[('liver_frame', 'probe' + end, point) for end, point in zip(('_trocar', '_tip'), AXIS)])

    @classmethod
    def publish(cls, topic, message, adapter=ADAPTER):
        """Publishes once the adapter listens to the topic."""
        publisher = cls.publishers.setdefault(topic, rospy.Publisher(topic, type(message), queue_size=100))
        wait_until(lambda: is_heard(publisher, adapter), '%s to listen to %s' % (adapter, topic))
        publisher.publish(message)

    @classmethod
    def send(cls, organ, mesh, stamp=rospy.Time()):
        """Publishes a mesh in the organ's message type. A shape has no stamp."""
        make = {'shape': lambda: shape_mesh(mesh), 'marker': lambda: marker(mesh, stamp=stamp),
                'polygons': lambda: polygon_mesh(mesh, stamp=stamp, padding=4)}
        cls.publish('/sim/' + organ, make[organ]())

    def wait_for_contacts(self, organ, mesh, node=None):
        """Waits until the node's answer about the organ has the contacts of `mesh`, at least one."""
        expected = oracle.static_contacts(mesh, AXIS, RADIUS)
        self.assertGreater(len(expected), 0)

        def same():
            result = (node or self.node).query(organ, shaft(*AXIS, RADIUS))
            seen[:] = [result.status, result.message]
            try:
                self.assert_contacts(result, expected, 1e-6)
            except AssertionError as error:
                seen.append(str(error))
                return None
            return result

        seen = []
        return wait_until(same, lambda: 'contacts of %s; there are %s' % (organ, seen))

    def wait_until_removed(self, organ):
        wait_until(lambda: self.node.query(organ, FAR_AWAY).status == ContactArray.NO_MESH, 'removal of ' + organ)

    def test_meshes_of_each_type(self):
        """They are published with their stamps, move with the same topology, and get the next one with other triangles.
        An empty one removes the organ."""
        for organ in LAYOUTS:
            begin = rospy.Time.now()
            self.send(organ, SHEET, begin)
            answer = wait_until(lambda: self.node.contacts.select(
                lambda a: a.organ == organ and a.mesh_stamp >= begin), 'contacts of ' + organ)[0]
            self.assert_contacts(answer, oracle.static_contacts(SHEET, AXIS, RADIUS), 1e-6)
            self.assertEqual(answer.mesh_stamp > begin, organ == 'shape')  # Its stamp is the time of arrival.
            topology = answer.topology
            self.send(organ, LOWER)
            self.assertEqual(self.wait_for_contacts(organ, LOWER).topology, topology)
            wait_until(lambda: [m for m in of(self.vertices, organ) if m.topology == topology], 'vertices of ' + organ)
            corners = [LOWEST.vertices[i] for i in LOWEST.flat_faces()] if organ == 'marker' else LOWEST.vertices
            stamp = rospy.Time.now()
            self.publish('/sim/%s_points' % organ, cloud(corners, stamp=stamp, **LAYOUTS[organ]))
            answer = self.wait_for_contacts(organ, LOWEST)
            self.assertEqual((answer.topology, answer.mesh_stamp), (topology, stamp))
            self.send(organ, FINE)
            self.assertEqual(self.wait_for_contacts(organ, FINE).topology, (topology + 1) % 2**32)
            self.send(organ, scenes.Mesh([], []))
            self.wait_until_removed(organ)
            self.send(organ, SHEET)
            self.wait_for_contacts(organ, SHEET)

    def test_what_only_some_types_have(self):
        """Pose, scale and deletion of a marker, polygons with more corners, and a frame that a parameter overrides."""
        self.publish('/sim/marker', marker(LOWER, pose=POSE, scale=(2.0, 0.5, 1.25)))
        self.wait_for_contacts('marker', LOWER)
        for name, action in ((('organs', 7), Marker.DELETE), (('', 0), Marker.DELETEALL)):
            self.publish('/sim/marker', marker(SHEET))
            self.wait_for_contacts('marker', SHEET)
            self.publish('/sim/marker', deletion(action, name))
            self.wait_until_removed('marker')
        fan = polygon_mesh(scenes.sheet(0.1, 1))
        fan.polygons = fan.polygons[:1]
        fan.polygons[0].vertices = [0, 1, 3, 2]
        self.publish('/sim/polygons', fan)
        self.wait_for_contacts('polygons', scenes.sheet(0.1, 1))
        for mesh, frame in ((SHEET, 'world'), (LOWER, '')):
            self.publish('/sim/framed', polygon_mesh(mesh, frame=frame))
            self.assertEqual(self.wait_for_contacts('framed', mesh).header.frame_id, 'liver_frame')

    def test_refusals(self):
        """The log names topic and reason, and the organ stays as it was. /diagnostics counts messages by organ and
        reason."""
        said = Diagnostics(ADAPTER)
        short, flat, text = polygon_mesh(SHEET), marker(SHEET), String('solid liver')
        short.polygons[5].vertices = [1, 2]
        flat.scale.z = 0.0
        unreadable = polygon_mesh(SHEET)
        changed(unreadable.cloud, width=2**32 - 1)
        for organ in LAYOUTS:
            self.send(organ, SHEET)
        good = {organ: self.wait_for_contacts(organ, SHEET) for organ in LAYOUTS}
        for topic, message, *words in (
            ('/sim/polygons', unreadable, '300 bytes', '4294967295 x 1'),
            ('/sim/polygons', short, 'polygon 5 has 2 corners', 'at least 3'),
            ('/sim/polygons', polygon_mesh(SHEET, frame=''), "'polygons'", "'frame'"),
            ('/sim/marker', flat, 'scale is 1 1 0', 'more than 0'),
            ('/sim/marker', marker(SHEET, name=('tools', 7)), "'tools/7'", "'organs/7'"),
            ('/sim/shape_points', cloud(SHEET.vertices[1:]), '24 vertices', "'shape'", '25'),
            ('/sim/odd', text, 'std_msgs/String', 'shape_msgs/Mesh', 'pcl_msgs/PolygonMesh',
             'visualization_msgs/Marker'),
            ('/sim/odd_points', text, 'std_msgs/String', 'sensor_msgs/PointCloud2'),
            ('/sim/unframed', shape_mesh(SHEET), "'unframed'", "'frame'"),
            ('/sim/unmeshed_points', cloud(SHEET.vertices), "'unmeshed'", 'no mesh'),
        ):
            def logged():
                """Sends it again and again, because a reason is logged at most once a second."""
                self.publish(topic, message)
                rospy.sleep(0.05)
                return self.log.select(lambda m: m.name == ADAPTER and m.level >= LogLine.WARN
                                       and all(word in m.msg for word in [topic] + words))

            wait_until(logged, lambda: '%s in %s' % (words, [m.msg for m in self.log.messages]))
            for organ, before in good.items():
                now = self.node.query(organ, shaft(*AXIS, RADIUS))
                self.assertEqual((now.status, now.topology, now.contacts), (0, before.topology, before.contacts))
        for organ in ('odd', 'unframed', 'unmeshed'):
            self.assertEqual(self.node.query(organ, FAR_AWAY).status, ContactArray.UNKNOWN_ORGAN)
        said.wait_for_count('refused, /sim/unmeshed_points: no mesh')
        self.assertEqual(said.values['organs'], '7')
        self.assertGreaterEqual(said.count('polygons, messages received'), said.count('polygons, messages converted'))
        # Illegal arrays are for the collision node to refuse.
        broken = changed(polygon_mesh(SHEET.moved(lambda v: (v[0], float('nan'), v[2]))))
        broken.header.stamp = rospy.Time.now()
        self.publish('/sim/polygons', broken)
        answer = self.node.contacts.wait_for('polygons', 'probe', stamp=broken.header.stamp,
                                             status=ContactArray.INVALID_REQUEST)
        self.assertIn('nan', answer.message)

    def test_a_late_node_gets_every_organ_as_it_is(self):
        meshes, shapes = Log('/late/organ_mesh', OrganMesh), Log('/late/organ_vertices', OrganVertices)
        for log in (meshes, shapes):
            log.wait_for_publisher()
        stamp, adapter = rospy.Time.now(), '/early_adapter'
        for topic, message in (('first', shape_mesh(FINE)), ('second', polygon_mesh(SHEET)), ('third', marker(SHEET)),
                               ('gone', marker(SHEET))):
            self.publish('/early/' + topic, message, adapter)
            wait_until(lambda: of(meshes, topic), 'mesh of ' + topic)
        self.publish('/early/second_points', cloud(LOWER.vertices, stamp=stamp), adapter)
        self.publish('/early/third', marker(LOWEST), adapter)
        self.publish('/early/gone', deletion(Marker.DELETE), adapter)
        for organ in ('second', 'third'):
            wait_until(lambda: of(shapes, organ), 'vertices of ' + organ)
        wait_until(lambda: not of(meshes, 'gone')[-1].triangles, 'the removal')
        meshes.subscriber.unregister()
        for mesh in (FINE, FINE.moved(lambda v: (v[0], v[1], v[2] + 0.1 * v[1]))):
            process = self.start('/late', {'tools': [TOOL]})
            node = NodeClient('/late')
            self.assertEqual(self.wait_for_contacts('second', LOWER, node).mesh_stamp, stamp)
            self.wait_for_contacts('third', LOWEST, node)
            self.assertEqual(node.query('gone', FAR_AWAY).status, ContactArray.UNKNOWN_ORGAN)
            self.publish('/early/first', shape_mesh(mesh), adapter)
            self.wait_for_contacts('first', mesh, node)
            node.close()
            self.stop(process)
        # The numbers of the meshes go on behind those with which a new subscriber is greeted.
        late = Log('/late/organ_mesh', OrganMesh)
        wait_until(lambda: of(late, 'third'), 'the greeting')
        greeting = of(late, 'third')[-1].header.seq
        self.publish('/early/third', marker(FINE), adapter)
        wait_until(lambda: of(late, 'third')[-1].header.seq == greeting + 1, 'the next mesh')

    def test_a_restarted_adapter_is_not_taken_for_the_old_one(self):
        """The collision node still has the old adapter's triangles and topology number. Misspelt names are reported."""
        for name, mesh in (('/first', SHEET), ('/second', FINE), ('/third', SHEET)):
            process = self.start(name, {'organs': [dict(ORGAN, frame_id='x')], 'collision': '/x'}, 'organ_mesh_adapter')
            self.publish('/restart/liver', shape_mesh(mesh), name)
            self.wait_for_contacts('liver', mesh)
            printed = self.stop(process)
        for words in ("~collision is no parameter; nearest is 'collision_node'", '/frame_id is no'):
            self.assertIn(words, printed)

    def test_illegal_parameters(self):
        started = [(self.start('/illegal_%d' % i, parameters, 'organ_mesh_adapter'), words)
                   for i, (parameters, *words) in enumerate((
                       ({'organ': [ORGAN]}, 'organs', 'missing', "'organs'"),
                       ({'organs': [dict(ORGAN, topic='a b')]}, 'organs[0]/topic', 'a b'),
                       ({'organs': [ORGAN, dict(ORGAN, topic='/other')]}, 'organs[1]/name', 'liver', 'unique'),
                   ))]
        for process, words in started:
            self.assert_refused(process, words)


if __name__ == '__main__':
    rospy.init_node('mesh_adapter_test')
    rostest.rosrun('organ_collision', 'mesh_adapter', MeshAdapterTest, sys.argv)
