#!/usr/bin/python3
"""Bad meshes and vertices. Each is refused with a reason and counted, and the last good state stays
as it was."""

import sys

from organ_collision.msg import ContactArray
import rospy
from rosgraph_msgs.msg import Log
import rostest

from support import oracle, scenes
from support.contact_case import ContactCase
from support.contract import KeepsContract
from support.node_client import NodeClient, shaft, wait_until

NAN, INFINITY = float('nan'), float('inf')
SHEET = scenes.sheet(0.1, 4)
AXIS = ((0.01, 0.02, 0.3), (0.011, 0.017, 0.002))
GOOD = rospy.Time(5)


class BadMeshesTest(KeepsContract, ContactCase):
    @classmethod
    def setUpClass(cls):
        cls.node = NodeClient()
        cls.seconds = 100
        cls.log = []
        cls.log_subscriber = rospy.Subscriber('/rosout', Log, cls.log.append)
        wait_until(lambda: cls.log_subscriber.get_num_connections() > 0, 'the log')
        cls.node.send_mesh('good', SHEET, GOOD)
        cls.node.wait_for_shape('good', GOOD)
        wait_until(cls.has_started, 'the end of the first moments')
        # Once this message is counted, /diagnostics shows the counts of all those before it.
        cls.node.send_vertices('good', SHEET, cls.next_stamp(), topology=9)
        wait_until(lambda: 'rejected, other topology' in cls.node.diagnostics, 'its count')

    @classmethod
    def has_started(cls):
        """In its first moments, the node does not warn of the vertices of unknown organs."""
        stamp = cls.next_stamp()
        cls.node.send_vertices('nobody', SHEET, stamp)
        cls.node.contacts.wait_for('nobody', 'grasper', stamp=stamp)
        return any('nobody' in m.msg for m in list(cls.log))

    @classmethod
    def next_stamp(cls):
        cls.seconds += 1
        return rospy.Time(cls.seconds)

    def assert_good_state(self):
        """Checks that queries about the good organ are answered as before."""
        result = self.node.query('good', shaft(*AXIS, 0.005))
        self.assertEqual((result.mesh_stamp, result.topology), (GOOD, 1))
        expected = oracle.static_contacts(SHEET, AXIS, 0.005)
        self.assertGreater(len(expected), 0)
        self.assert_contacts(result, expected)

    def rejected(self):
        """The number of refused messages in /diagnostics, for all reasons together."""
        return sum(
            int(value)
            for key, value in self.node.diagnostics.items()
            if key.lower().startswith('rejected') and value.isdigit()
        )

    def refuse(self, messages, *words, status=ContactArray.INVALID_REQUEST):
        """Sends each message and checks three things: `contacts` refuses it with this status and a
        text that contains `words` (the value and what is legal), /diagnostics counts it, and the
        good organ stays as it was."""
        wait_until(lambda: self.node.diagnostics, 'diagnostics')
        before = self.rejected()
        for publisher, message in messages:
            message.header.stamp = self.next_stamp()
            publisher.publish(message)
            answer = self.node.contacts.wait_for(
                message.organ, 'grasper', stamp=message.header.stamp
            )
            self.assertEqual((answer.status, answer.contacts), (status, []), answer.message)
            for word in words or ' ':
                self.assertIn(word, answer.message)
        wait_until(lambda: self.rejected() >= before + len(messages), 'counts of refusals')
        self.assertEqual(self.rejected(), before + len(messages))
        self.assert_good_state()

    def test_the_log_says_what_was_refused(self):
        self.refuse([self.vertices(topology=4444)], '4444')
        wait_until(
            lambda: [
                m
                for m in self.log
                if m.name == '/organ_collision' and m.level >= Log.WARN and '4444' in m.msg
            ],
            'a warning in the log',
        )

    def mesh(self, organ='good', topology=1, frame='liver_frame', **fields):
        message = self.node.mesh_message(organ, SHEET, topology=topology)
        message.header.frame_id = frame
        for name, value in fields.items():
            setattr(message, name, value)
        return (self.node.meshes, message)

    def vertices(self, organ='good', topology=1, frame='liver_frame', **fields):
        message = self.node.vertices_message(organ, SHEET, topology=topology)
        message.header.frame_id = frame
        for name, value in fields.items():
            setattr(message, name, value)
        return (self.node.shapes, message)

    def test_index_out_of_range(self):
        triangles = SHEET.flat_faces()
        triangles[7] = 25
        self.refuse([self.mesh(triangles=triangles, topology=2)], 'face 2 ', 'vertex 25')
        triangles[7] = 2**32 - 1
        self.refuse([self.mesh(triangles=triangles, topology=3)])
        self.refuse([self.mesh(vertices=[], topology=2)])

    def test_sizes_that_are_no_multiple_of_three(self):
        self.refuse([self.mesh(triangles=SHEET.flat_faces() + [1], topology=2)], '97')
        self.refuse([self.mesh(vertices=SHEET.flat_vertices() + [0.5], topology=2)], '76')
        self.refuse([self.vertices(vertices=SHEET.flat_vertices()[:-2])], '73')

    def test_other_number_of_vertices(self):
        self.refuse(
            [
                self.vertices(vertices=SHEET.flat_vertices()[:-3]),
                self.vertices(vertices=SHEET.flat_vertices() + [0.1, 0.2, 0.3]),
                self.vertices(vertices=[]),
            ]
        )

    def test_positions_that_are_not_finite(self):
        for value, word in ((NAN, 'nan'), (INFINITY, 'inf'), (-INFINITY, '-inf')):
            vertices = SHEET.flat_vertices()
            vertices[11] = value
            self.refuse([self.vertices(vertices=vertices)], word)
            self.refuse([self.mesh(vertices=vertices), self.mesh(vertices=vertices, topology=2)])

    def test_an_unknown_organ(self):
        self.refuse([self.vertices(organ='spleen')], 'spleen', status=ContactArray.UNKNOWN_ORGAN)
        self.assertEqual(
            self.node.query('spleen', shaft(*AXIS, 0.005)).status, ContactArray.UNKNOWN_ORGAN
        )

    def test_vertices_of_another_topology(self):
        self.refuse([self.vertices(topology=77)], '77', '1')

    def test_vertices_without_triangles_and_the_reverse(self):
        self.refuse([self.mesh(triangles=[], topology=2)])
        self.refuse([self.mesh(organ='bare', triangles=[])])

    def test_empty_names(self):
        self.refuse(
            [
                self.mesh(frame=''),
                self.mesh(organ=''),
                self.vertices(frame=''),
                self.vertices(organ=''),
                self.mesh(frame='', organ=''),
            ]
        )

    def test_vertices_in_another_frame(self):
        self.refuse([self.vertices(frame='table')], 'table', 'liver_frame')

    def test_more_faces_than_the_limit(self):
        big = scenes.sheet(0.1, 8)  # 128 faces; the limit is 100
        self.refuse(
            [self.mesh(vertices=big.flat_vertices(), triangles=big.flat_faces(), topology=2)],
            '128',
            '100',
        )

    def test_the_same_topology_with_other_triangles(self):
        triangles = SHEET.flat_faces()
        self.refuse([self.mesh(triangles=triangles[3:] + triangles[:3])])
        self.refuse([self.mesh(triangles=triangles[3:])])

    def test_diagnostics_say_how_the_node_is(self):
        self.node.query('good', shaft(*AXIS, 0.005))
        wait_until(lambda: 'good' in ' '.join(self.node.diagnostics), "the good organ's mesh")
        text = ' '.join('%s: %s' % pair for pair in self.node.diagnostics.items()).lower()
        for word in ('mesh', 'contact', 'median', '99', 'worst', 'age', 'reject', 'gl', 'mesa'):
            self.assertIn(word, text)


if __name__ == '__main__':
    rospy.init_node('bad_meshes_test')
    rostest.rosrun('organ_collision', 'bad_meshes', BadMeshesTest, sys.argv)
