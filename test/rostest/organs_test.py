#!/usr/bin/python3
"""What the node says about the organs that it has: in the log, on /diagnostics and by list_organs. What it refuses, and
that the last good state stays. How an organ is removed, and when a mesh is a new organ."""

import os
import subprocess
import sys

from diagnostic_msgs.msg import DiagnosticStatus
from organ_collision.msg import ContactArray
from organ_collision.srv import ListOrgans, RemoveOrgan
import rospy
from rosgraph_msgs.msg import Log as LogLine
import rostest

from support import oracle, scenes
from support.contact_case import ContactCase, KeepsContract, xyz
from support.node_client import FAR_AWAY, LIMIT, Log, NodeClient, TfSender, shaft, wait_until

STATIC, SWEPT, INVALID = ContactArray.STATIC, ContactArray.SWEPT, ContactArray.INVALID_REQUEST
NAN, INFINITY = float('nan'), float('inf')
SIMULATOR = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'organ_simulator.py')
SHEET = scenes.sheet(0.1, 4)
AXIS = ((0.013, 0.007, 0.3), (0.013, 0.007, 0.001))  # of the tool `grasper`
GOOD = rospy.Time(5)
KIDNEY = scenes.box((0.12, 0.09, 0.06)).moved(lambda v: (v[0] + 0.3, v[1], v[2] - 0.2))
VOLUME = 0.12 * 0.09 * 0.06  # [m^3]
IN_MILLIMETRES = KIDNEY.moved(lambda v: tuple(1000.0 * c for c in v))
INWARD = scenes.Mesh(KIDNEY.vertices, [(a, c, b) for a, b, c in KIDNEY.faces])
OPEN = scenes.Mesh(KIDNEY.vertices, KIDNEY.faces[1:])


class OrgansTest(KeepsContract, ContactCase):
    @classmethod
    def setUpClass(cls):
        cls.node = NodeClient()
        cls.said = cls.node.diagnostics
        cls.list_service = rospy.ServiceProxy('/organ_collision/list_organs', ListOrgans)
        cls.remove_service = rospy.ServiceProxy('/organ_collision/remove_organ', RemoveOrgan)
        cls.log = Log('/rosout', LogLine)
        tf = TfSender()
        tf.wait_for(cls.node)
        tf.send_resting(*[('liver_frame', tool + end, point) for tool in ('grasper', 'log')
                          for end, point in zip(('_trocar', '_tip'), AXIS)])
        cls.seconds = 100
        cls.node.bring('good', SHEET, GOOD)
        names = iter(range(10**6))

        def is_heard():
            """The node logs each new organ. In its first moments, it does not warn of the vertices of unknown ones."""
            name = 'unheard_%d' % next(names)
            cls.node.bring(name, KIDNEY)
            cls.remove_service(name)
            cls.node.send_vertices('nobody', SHEET, cls.next_stamp())
            return cls.log.select(lambda line: 'nobody' in line.msg)

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

    def logged(self, level, *words, meanwhile=lambda: None):
        """Waits for a line of the log about this test's organ with all of these words. Calls `meanwhile` again and
        again: the node logs failures of one kind at most once a second."""

        def found():
            meanwhile()
            return self.log.select(lambda line: line.name == '/organ_collision' and line.level == level
                                   and all(word in line.msg for word in ("'%s'" % self.organ,) + words))

        return wait_until(found, lambda: '%s in %s' % (words, [m.msg for m in self.log.messages]))[0].msg

    def diagnosed(self, key, value):
        key = '%s, %s' % (self.organ, key)
        wait_until(lambda: self.said.values.get(key) == value,
                   lambda: '%s: %s instead of %s' % (key, self.said.values.get(key), value))

    def listed(self):
        """What list_organs says about this test's organ; None if it is not there."""
        return {organ.name: organ for organ in self.list_service().organs}.get(self.organ)

    def test_says_what_came(self):
        self.node.bring(self.organ, KIDNEY, rospy.Time(7), topology=3)
        self.assertEqual(self.logged(LogLine.INFO),
                         "organ '%s': 12 faces, closed, 0.12 x 0.09 x 0.06 m" % self.organ)
        for key, value in (('faces', '12'), ('extent [m]', '0.12 x 0.09 x 0.06'), ('surface', 'closed'),
                           ('orientation', 'outward')):
            self.diagnosed(key, value)
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

    def test_doubtful_organs(self):
        """They are answered, and named in the log and on /diagnostics."""
        for name, mesh, level, said, orientation, volume in (
            ('in_millimetres', IN_MILLIMETRES, LogLine.WARN, ('120 x 90 x 60 m', 'are these millimetres?'), 'outward',
             1e9),
            ('inward', INWARD, LogLine.WARN, ('point inward', 'swap two vertices of each triangle'), 'inward', -1),
            ('open', OPEN, LogLine.INFO, ('11 faces, open (3 edges)',), 'none', 0),
        ):
            self.organ = name
            self.node.bring(name, mesh)
            self.logged(level, *said)
            if level == LogLine.WARN:
                self.said.wait_for_summary('organs', name, said[0], level=DiagnosticStatus.WARN)
            self.diagnosed('orientation', orientation)
            organ = self.listed()
            self.assertEqual(organ.closed, name != 'open')
            self.assertAlmostEqual(organ.volume, volume * VOLUME, delta=1e-5 * abs(volume * VOLUME))
            self.remove_service(name)

    def test_a_tool_of_an_implausible_size(self):
        self.said.wait_for_summary('tools', "tool 'log' has a radius of 5 m", level=DiagnosticStatus.WARN)
        self.assertEqual(self.said.values['grasper, radius of the shaft [m]'], '0.005')

    def test_diagnostics_say_how_the_node_is(self):
        self.node.query('good', shaft(*AXIS, 0.005))
        wait_until(lambda: 'good' in ' '.join(self.said.values), "the good organ's mesh")
        text = ' '.join('%s: %s' % pair for pair in self.said.values.items()).lower()
        for word in ('mesh', 'contact', 'median', '99', 'worst', 'age', 'reject', 'gl', 'mesa'):
            self.assertIn(word, text)

    def rejected(self):
        """The number of refused messages in /diagnostics, for all reasons together."""
        return sum(int(value) for key, value in self.said.values.items()
                   if key.lower().startswith('rejected') and value.isdigit())

    def message(self, moved=False, organ='good', topology=1, frame='liver_frame', **fields):
        """A message about the good organ with other values of these fields."""
        make = self.node.vertices_message if moved else self.node.mesh_message
        message = make(organ, SHEET, topology=topology)
        message.header.frame_id = frame
        for name, value in fields.items():
            setattr(message, name, value)
        return (self.node.shapes if moved else self.node.meshes), message

    def test_refusals(self):
        """`contacts` refuses each message with a text that names the value and what is legal, /diagnostics counts it,
        and the good organ stays as it was."""
        vertices, triangles, big = SHEET.flat_vertices(), SHEET.flat_faces(), scenes.sheet(0.1, 8)
        changed = lambda values, at, value: values[:at] + [value] + values[at + 1:]
        cases = (
            (dict(triangles=changed(triangles, 7, 25), topology=2), 'face 2 ', 'vertex 25'),
            (dict(vertices=[], topology=2),),
            (dict(triangles=triangles + [1], topology=2), '97'),
            (dict(vertices=vertices + [0.5], topology=2), '76'),
            (dict(vertices=vertices[:-2], moved=True), '73'),
            (dict(vertices=vertices[:-3], moved=True), '72', '75'),
            (dict(vertices=changed(vertices, 11, NAN), moved=True), 'nan'),
            (dict(vertices=changed(vertices, 11, -INFINITY), topology=2), '-inf'),
            (dict(topology=77, moved=True), '77', '1'),
            (dict(triangles=[], topology=2),),
            (dict(frame=''), 'frame'),
            (dict(organ='', moved=True), 'organ'),
            (dict(organ='a\nb'), 'organ', '256'),
            (dict(frame='table', moved=True), 'table', 'liver_frame'),
            (dict(vertices=big.flat_vertices(), triangles=big.flat_faces(), topology=2), '128', '100'),
            (dict(triangles=triangles[3:] + triangles[:3]), 'topology', 'reset'),
        )
        self.node.bring('good', SHEET, GOOD)  # After a reset, other triangles would be a new organ.
        self.node.send_vertices('good', SHEET, self.next_stamp(), topology=9)
        self.said.wait_for_count('rejected, other topology')
        before = self.rejected()
        expected = oracle.static_contacts(SHEET, AXIS, 0.005)
        self.assertGreater(len(expected), 0)
        for fields, *words in cases:
            publisher, message = self.message(**fields)
            message.header.stamp = self.next_stamp()
            publisher.publish(message)
            answer = wait_until(lambda: self.node.contacts.select(
                lambda a: a.header.stamp == message.header.stamp and a.tool == 'grasper'), fields)[0]
            self.assertEqual((answer.status, answer.contacts), (INVALID, []), answer.message)
            for word in words:
                self.assertIn(word, answer.message)
            result = self.node.query('good', shaft(*AXIS, 0.005))
            self.assertEqual((result.mesh_stamp, result.topology), (GOOD, 1))
            self.assert_contacts(result, expected)
        wait_until(lambda: self.rejected() >= before + len(cases), 'counts of refusals')
        self.assertEqual(self.rejected(), before + len(cases))

    def test_a_name_of_ten_megabytes(self):
        """Answer, log and /diagnostics stay small."""
        publisher, message = self.message(organ='x' * 10**7)
        message.header.stamp = self.next_stamp()
        publisher.publish(message)
        answer = wait_until(lambda: self.node.contacts.select(lambda a: a.header.stamp == message.header.stamp),
                            'refusal')[0]
        self.assertIn('organ', answer.message)
        texts = [answer.organ, answer.message, *[line.msg for line in self.log.messages], *self.said.values.values()]
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
        # A good organ stays, and /diagnostics tells of the newer mesh.
        self.node.bring(self.organ, KIDNEY)
        self.node.send_mesh(self.organ, KIDNEY.moved(lambda v: (v[0], v[1], NAN)), topology=2)
        key = self.organ + ', newer mesh refused'
        wait_until(lambda: 'z of vertex 0 is nan' in self.said.values.get(key, ''), lambda: self.said.values)
        self.assert_ok(self.node.query(self.organ, FAR_AWAY))

    def test_an_unknown_organ_is_called_so_once(self):
        def ask():
            self.assertEqual(self.node.query(self.organ, FAR_AWAY).status, ContactArray.UNKNOWN_ORGAN)

        line = self.logged(LogLine.WARN, meanwhile=ask)
        self.assertTrue(line.startswith("organ '%s' is unknown; " % self.organ), line)
        removed = self.remove_service(self.organ)
        self.assertFalse(removed.success)
        self.assertIn("'%s' is unknown" % self.organ, removed.message)

    def test_remove_organ(self):
        self.node.bring(self.organ, KIDNEY)
        answer = self.remove_service(self.organ)
        self.assertTrue(answer.success, answer.message)
        for tool in ('grasper', 'log'):
            removed = self.node.contacts.wait_for(self.organ, tool, status=ContactArray.NO_MESH)
            self.assertIn('was removed', removed.message)
        self.assertIsNone(self.listed())
        self.assertEqual(self.node.query(self.organ, FAR_AWAY).status, ContactArray.NO_MESH)
        again = self.remove_service(self.organ)
        self.assertFalse(again.success)
        self.assertIn('was removed', again.message)
        self.node.bring(self.organ, OPEN, topology=1)  # The organ may come back.

    def assert_step(self, answer, mode):
        self.assert_ok(answer)
        self.assertEqual(answer.mode, mode)
        self.assertGreater(len(answer.contacts), 0)

    def simulate(self, cells, mode):
        """Runs a simulator, always with the same name, until the node has answered. Checks the answer's mode."""
        stamp = self.next_stamp()
        process = subprocess.Popen([SIMULATOR, str(cells), str(self.seconds), '__name:=simulator'],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            self.assert_step(self.node.contacts.wait_for('tissue', 'grasper', stamp=stamp), mode)
        finally:
            process.terminate()
            process.wait()

    def test_a_restarted_simulator_brings_a_new_organ(self):
        """Other triangles with the present topology number from a new connection are a new organ. The same mesh again
        is a new shape, whose step begins at the last one."""
        self.simulate(3, STATIC)
        self.simulate(5, STATIC)
        self.simulate(5, SWEPT)

    def test_one_simulator_must_raise_the_number_or_reset(self):
        def send(cells):
            stamp = self.next_stamp()
            self.node.send_mesh(self.organ, scenes.sheet(0.1, cells), stamp)
            return self.node.contacts.wait_for(self.organ, 'grasper', stamp=stamp)

        self.assert_step(send(3), STATIC)
        self.assert_step(send(3), SWEPT)
        self.assertEqual(send(5).status, INVALID)
        self.assert_step(send(3), SWEPT)
        self.node.reset()
        self.assert_step(send(5), STATIC)
        self.assertEqual(send(3).status, INVALID)


if __name__ == '__main__':
    rospy.init_node('organs_test')
    rostest.rosrun('organ_collision', 'organs', OrgansTest, sys.argv)
