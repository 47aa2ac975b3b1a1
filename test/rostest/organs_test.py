#!/usr/bin/python3
"""What the node says about the organs that it has: in the log, on /diagnostics and by list_organs. What it refuses, and
that the last good state stays. How an organ is removed, and when a mesh is a new organ."""

import sys

from diagnostic_msgs.msg import DiagnosticStatus
from organ_collision.msg import ContactArray
from organ_collision.srv import ListOrgans, RemoveOrgan
import rospy
from rosgraph_msgs.msg import Log as LogLine
import rostest

from support import oracle, scenes
from support.contact_case import ContactCase, KeepsContract, xyz
from support.node_client import (FAR_AWAY, Log, NodeClient, TfSender, mesh_message, shaft, vertices_message,
                                 wait_until)

STATIC, SWEPT, INVALID = ContactArray.STATIC, ContactArray.SWEPT, ContactArray.INVALID_REQUEST
NAN = float('nan')
SHEET = scenes.sheet(0.1, 4)
AXIS = ((0.013, 0.007, 0.3), (0.013, 0.007, 0.001))  # of the tool
GOOD = rospy.Time(5)
KIDNEY = scenes.box((0.12, 0.09, 0.06)).moved(lambda v: (v[0] + 0.3, v[1], v[2] - 0.2))
VOLUME = 0.12 * 0.09 * 0.06  # [m^3]


class OrgansTest(KeepsContract, ContactCase):
    @classmethod
    def setUpClass(cls):
        cls.node = NodeClient()
        cls.list_service = rospy.ServiceProxy('/organ_collision/list_organs', ListOrgans)
        cls.remove_service = rospy.ServiceProxy('/organ_collision/remove_organ', RemoveOrgan)
        cls.log = Log('/rosout', LogLine)
        tf = TfSender()
        tf.wait_for(cls.node)
        tf.send_resting(*[('liver_frame', 'grasper' + end, point) for end, point in zip(('_trocar', '_tip'), AXIS)])
        cls.seconds = 100
        cls.node.bring('good', SHEET, GOOD)
        names = iter(range(10**6))

        def is_heard():
            """The node logs each new organ."""
            cls.node.bring('unheard_%d' % next(names), KIDNEY)
            return cls.log.select(lambda line: 'unheard' in line.msg)

        wait_until(is_heard, "the node's log")

    @classmethod
    def next_stamp(cls):
        cls.seconds += 1
        return rospy.Time(cls.seconds)

    def setUp(self):
        self.organ = self.id().split('.')[-1]

    def tearDown(self):
        super().tearDown()
        self.remove_service(self.organ)

    def logged(self, level, *words):
        """Waits for a line of the log about this test's organ with all of these words."""

        def found():
            return self.log.select(lambda line: line.name == '/organ_collision' and line.level == level
                                   and all(word in line.msg for word in ("'%s'" % self.organ,) + words))

        return wait_until(found, lambda: '%s in %s' % (words, [m.msg for m in self.log.messages]))[0].msg

    def diagnosed(self, **values):
        """Waits until /diagnostics has these values of this test's organ."""
        said = self.node.diagnostics.values
        found = lambda: {key: said.get('%s, %s' % (self.organ, key)) for key in values}
        wait_until(lambda: found() == values, lambda: '%s; there is %s' % (values, found()))

    def listed(self):
        """What list_organs says about this test's organ; None if it is not there."""
        return {organ.name: organ for organ in self.list_service().organs}.get(self.organ)

    def test_says_what_came(self):
        self.node.bring(self.organ, KIDNEY, rospy.Time(7), topology=3)
        self.assertEqual(self.logged(LogLine.INFO),
                         "organ '%s': 12 faces, closed, 0.12 x 0.09 x 0.06 m" % self.organ)
        self.diagnosed(faces='12', surface='closed', orientation='outward')
        organ = self.listed()
        self.assertEqual((organ.frame, organ.topology, organ.faces, organ.vertices, organ.stamp, organ.closed),
                         ('liver_frame', 3, 12, 8, rospy.Time(7), True))
        self.assertAlmostEqual(organ.volume, VOLUME, delta=1e-8)
        self.assert_near(xyz(organ.low), (0.24, -0.045, -0.23), 1e-7, 'low')
        self.assert_near(xyz(organ.high), (0.36, 0.045, -0.17), 1e-7, 'high')
        # The volume is that of the latest shape.
        self.node.send_vertices(self.organ, KIDNEY.moved(lambda v: tuple(2.0 * c for c in v)), rospy.Time(8),
                                topology=3)
        self.node.wait_for_shape(self.organ, rospy.Time(8), topology=3)
        self.assertAlmostEqual(self.listed().volume, 8 * VOLUME, delta=1e-7)

    def test_a_doubtful_organ_is_named(self):
        """And answered."""
        self.node.bring(self.organ, KIDNEY.moved(lambda v: tuple(1000.0 * c for c in v)))
        said = '120 x 90 x 60 m'
        self.logged(LogLine.WARN, said, 'are these millimetres?')
        self.node.diagnostics.wait_for_summary('organs', self.organ, said, level=DiagnosticStatus.WARN)

    def rejected(self):
        """The number of refused messages in /diagnostics, for all reasons together."""
        return sum(int(value) for key, value in self.node.diagnostics.values.items()
                   if key.lower().startswith('rejected') and value.isdigit())

    def message(self, moved=False, organ='good', topology=1, **fields):
        """A message about the good organ with other values of these fields."""
        message = (vertices_message if moved else mesh_message)(organ, SHEET, self.next_stamp(), topology)
        for name, value in fields.items():
            setattr(message, name, value)
        return (self.node.shapes if moved else self.node.meshes), message

    def test_refusals(self):
        """`contacts` refuses each message with a text that names the value and what is legal, /diagnostics counts it,
        and the good organ stays as it was. Also if its name has ten megabytes, all texts stay small."""
        vertices, triangles, big = SHEET.flat_vertices(), SHEET.flat_faces(), scenes.sheet(0.1, 8)
        cases = (
            (dict(triangles=triangles[:-1] + [25], topology=2), 'face 31 ', 'vertex 25'),
            (dict(vertices=vertices[:-3], moved=True), '72', '75'),
            (dict(vertices=vertices[:-1] + [NAN], moved=True), 'nan'),
            (dict(topology=77, moved=True), '77', '1'),
            (dict(organ='x' * 10**7), 'organ', '256'),
            (dict(vertices=big.flat_vertices(), triangles=big.flat_faces(), topology=2), '128', '100'),
            (dict(triangles=triangles[3:] + triangles[:3]), 'topology', 'reset'),
        )
        self.node.bring('good', SHEET, GOOD)  # After a reset, other triangles would be a new organ.
        self.node.send_vertices('good', SHEET, self.next_stamp(), topology=9)
        self.node.diagnostics.wait_for_count('rejected, other topology')
        before = self.rejected()
        expected = oracle.static_contacts(SHEET, AXIS, 0.005)
        self.assertGreater(len(expected), 0)
        for fields, *words in cases:
            publisher, message = self.message(**fields)
            publisher.publish(message)
            answer = wait_until(lambda: self.node.contacts.select(
                lambda answer: answer.header.stamp == message.header.stamp), words)[0]
            self.assertEqual((answer.status, answer.contacts), (INVALID, []), answer.message)
            for word in words:
                self.assertIn(word, answer.message)
            result = self.node.query('good', shaft(*AXIS, 0.005))
            self.assertEqual((result.mesh_stamp, result.topology), (GOOD, 1))
            self.assert_contacts(result, expected)
        wait_until(lambda: self.rejected() >= before + len(cases), 'counts of refusals')
        self.assertEqual(self.rejected(), before + len(cases))
        texts = [text for answer in self.node.contacts.messages for text in (answer.organ, answer.message)]
        texts += [line.msg for line in self.log.messages] + list(self.node.diagnostics.values.values())
        self.assertLess(max(map(len, texts)), 4000)

    def test_after_a_refused_mesh_answers_say_why(self):
        self.node.send_mesh(self.organ, scenes.Mesh(KIDNEY.vertices, KIDNEY.faces + [(0, 1, 77)]))
        why = 'face 12 refers to vertex 77 of 8'
        line = self.logged(LogLine.WARN, why)
        self.assertTrue(line.startswith("mesh of organ '%s': " % self.organ), line)
        answer = self.node.query(self.organ, FAR_AWAY)
        self.assertEqual(answer.status, ContactArray.NO_MESH)
        self.assertIn(why, answer.message)
        self.assertIsNone(self.listed())

    def test_remove_organ(self):
        unknown = self.remove_service(self.organ)
        self.assertFalse(unknown.success)
        self.assertIn("'%s' is unknown" % self.organ, unknown.message)
        self.node.bring(self.organ, KIDNEY)
        answer = self.remove_service(self.organ)
        self.assertTrue(answer.success, answer.message)
        removed = self.node.contacts.wait_for(self.organ, 'grasper', status=ContactArray.NO_MESH)
        self.assertIn('was removed', removed.message)
        self.assertIsNone(self.listed())
        self.assertEqual(self.node.query(self.organ, FAR_AWAY).status, ContactArray.NO_MESH)
        again = self.remove_service(self.organ)
        self.assertFalse(again.success)
        self.assertIn('was removed', again.message)
        self.node.bring(self.organ, SHEET, topology=1)  # The organ may come back.

    def send(self, cells):
        """Sends a sheet of so many squares a side, always with the same number. Returns the answer."""
        stamp = self.next_stamp()
        self.node.send_mesh(self.organ, scenes.sheet(0.1, cells), stamp)
        return self.node.contacts.wait_for(self.organ, 'grasper', stamp=stamp)

    def assert_step(self, answer, mode):
        self.assert_ok(answer)
        self.assertEqual(answer.mode, mode)
        self.assertGreater(len(answer.contacts), 0)

    def test_other_triangles_with_the_same_number(self):
        """One simulator must raise the number or reset. Over a new connection they are a new organ, while the same
        triangles are a new shape, whose step begins at the last one."""
        self.assert_step(self.send(3), STATIC)
        self.assertEqual(self.send(5).status, INVALID)
        self.assert_step(self.send(3), SWEPT)
        self.node.reset()
        self.assert_step(self.send(5), STATIC)
        for cells, mode in ((3, STATIC), (3, SWEPT)):
            self.node.close()
            type(self).node = NodeClient()
            self.assert_step(self.send(cells), mode)


if __name__ == '__main__':
    rospy.init_node('organs_test')
    rostest.rosrun('organ_collision', 'organs', OrgansTest, sys.argv)
