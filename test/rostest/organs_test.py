#!/usr/bin/python3
"""What the node says about the organs that it has: in the log, on /diagnostics and by list_organs.
How an organ is removed."""

import sys

from diagnostic_msgs.msg import DiagnosticStatus
from organ_collision.msg import ContactArray
from organ_collision.srv import ListOrgans, RemoveOrgan
import rospy
from rosgraph_msgs.msg import Log
import rostest

from support import scenes
from support.contact_case import ContactCase, xyz
from support.contract import KeepsContract
from support.node_client import FAR_AWAY, LIMIT, NodeClient, shaft, wait_until

KIDNEY = scenes.box((0.12, 0.09, 0.06)).moved(lambda v: (v[0] + 0.3, v[1], v[2] - 0.2))
VOLUME = 0.12 * 0.09 * 0.06  # [m^3]
IN_MILLIMETRES = KIDNEY.moved(lambda v: tuple(1000.0 * c for c in v))
INWARD = scenes.Mesh(KIDNEY.vertices, [(a, c, b) for a, b, c in KIDNEY.faces])
OPEN = scenes.Mesh(KIDNEY.vertices, KIDNEY.faces[1:])
SOUP = scenes.Mesh(
    [v for face in range(12) for v in KIDNEY.face(face)],
    [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(12)],
)
REFUSED = scenes.Mesh(KIDNEY.vertices, KIDNEY.faces + [(0, 1, 77)])
NOT_FINITE = KIDNEY.moved(lambda v: (v[0], v[1], float('nan')))


class OrgansTest(KeepsContract, ContactCase):
    @classmethod
    def setUpClass(cls):
        cls.node = NodeClient()
        cls.list_service = rospy.ServiceProxy('/organ_collision/list_organs', ListOrgans)
        cls.remove_service = rospy.ServiceProxy('/organ_collision/remove_organ', RemoveOrgan)
        cls.list_service.wait_for_service(LIMIT)
        cls.remove_service.wait_for_service(LIMIT)
        cls.log = []
        cls.log_subscriber = rospy.Subscriber('/rosout', Log, cls.keep_log)
        cls.wait_for_log()

    @classmethod
    def keep_log(cls, message):
        if message.name == '/organ_collision':
            cls.log.append((message.level, message.msg))

    @classmethod
    def wait_for_log(cls):
        """Waits until the node's log reaches this test: the node tells about each new organ."""
        names = iter(range(10**6))

        def is_heard():
            name = 'unheard_%d' % next(names)
            cls.node.send_mesh(name, KIDNEY)
            cls.node.wait_for_shape(name, rospy.Time())
            cls.remove_service(name)
            return cls.log

        wait_until(is_heard, "the node's log")

    def setUp(self):
        self.organ = self.id().split('.')[-1]

    def tearDown(self):
        super().tearDown()
        self.remove_service(self.organ)

    def send(self, mesh, **named):
        self.node.send_mesh(self.organ, mesh, **named)

    def logged(self, level, *words, meanwhile=lambda: None):
        """Waits for a line of the log about this test's organ with all of these words. Calls
        `meanwhile` again and again: the node logs failures of one kind at most once a second."""

        def found():
            meanwhile()
            return [
                text
                for of_level, text in self.log
                if of_level == level and all(word in text for word in ("'%s'" % self.organ,) + words)
            ]

        return wait_until(found, lambda: '%s in %s' % (words, self.log))[0]

    def diagnosed(self, key, value):
        key = '%s, %s' % (self.organ, key)
        wait_until(
            lambda: self.node.diagnostics.get(key) == value,
            lambda: '%s: %s instead of %s' % (key, self.node.diagnostics.get(key), value),
        )

    def diagnosed_summary(self, level, *words):
        def is_there():
            return self.node.levels.get('organs') == level and all(
                word in self.node.summaries['organs'] for word in words
            )

        wait_until(
            is_there,
            lambda: '%s in %s %s' % (words, self.node.levels, self.node.summaries),
        )

    def listed(self):
        """What list_organs says about this test's organ; None if it is not there."""
        return {organ.name: organ for organ in self.list_service().organs}.get(self.organ)

    def wait_until_listed(self, **fields):
        def is_listed():
            organ = self.listed()
            return organ and all(getattr(organ, k) == v for k, v in fields.items()) and organ

        return wait_until(is_listed, lambda: '%s in %s' % (fields, self.list_service()))

    def test_says_what_came(self):
        self.send(KIDNEY, stamp=rospy.Time(7), topology=3)
        self.assertEqual(
            self.logged(Log.INFO),
            "organ '%s': 12 faces, closed, 0.12 x 0.09 x 0.06 m" % self.organ,
        )
        self.diagnosed('faces', '12')
        self.diagnosed('extent [m]', '0.12 x 0.09 x 0.06')
        self.diagnosed('surface', 'closed')
        self.diagnosed('orientation', 'outward')
        self.diagnosed_summary(DiagnosticStatus.OK, '1 organ')
        organ = self.listed()
        self.assertEqual((organ.frame, organ.topology), ('liver_frame', 3))
        self.assertEqual((organ.faces, organ.vertices), (12, 8))
        self.assertEqual(organ.stamp, rospy.Time(7))
        self.assertTrue(organ.closed)
        self.assertAlmostEqual(organ.volume, VOLUME, delta=1e-8)
        self.assert_near(xyz(organ.low), (0.24, -0.045, -0.23), 1e-7, 'low')
        self.assert_near(xyz(organ.high), (0.36, 0.045, -0.17), 1e-7, 'high')

    def test_the_volume_is_of_the_latest_shape(self):
        self.send(SOUP, stamp=rospy.Time(7))
        self.wait_until_listed(stamp=rospy.Time(7))
        twice = SOUP.moved(lambda v: tuple(2.0 * c for c in v))
        self.node.send_vertices(self.organ, twice, rospy.Time(8))
        organ = self.wait_until_listed(stamp=rospy.Time(8))
        self.assertTrue(organ.closed)
        self.assertAlmostEqual(organ.volume, 8 * VOLUME, delta=1e-7)
        self.assert_near(xyz(organ.high), (0.72, 0.09, -0.34), 1e-6, 'high')

    def test_an_organ_in_millimetres(self):
        self.send(IN_MILLIMETRES)
        self.logged(Log.INFO, '120 x 90 x 60 m')
        self.logged(Log.WARN, '120 x 90 x 60 m', 'are these millimetres?')
        self.diagnosed_summary(DiagnosticStatus.WARN, self.organ, 'are these millimetres?')
        self.assert_ok(self.node.query(self.organ, FAR_AWAY))

    def test_faces_that_point_inward(self):
        self.send(INWARD)
        self.logged(Log.INFO, 'closed')
        self.logged(Log.WARN, 'point inward', 'swap two vertices of each triangle')
        self.diagnosed('orientation', 'inward')
        self.diagnosed_summary(DiagnosticStatus.WARN, self.organ, 'point inward')
        self.assertAlmostEqual(self.listed().volume, -VOLUME, delta=1e-8)
        self.assert_ok(self.node.query(self.organ, FAR_AWAY))

    def test_an_open_surface(self):
        self.send(OPEN)
        self.logged(Log.INFO, '11 faces, open (3 edges)')
        self.diagnosed('surface', 'open (3 edges)')
        self.diagnosed('orientation', 'none')
        self.diagnosed_summary(DiagnosticStatus.OK, '1 organ')
        organ = self.listed()
        self.assertFalse(organ.closed)
        self.assertEqual(organ.volume, 0.0)

    def test_after_a_refused_mesh_answers_say_why(self):
        self.send(REFUSED)
        why = 'face 12 refers to vertex 77 of 8'
        refused = self.node.contacts.wait_for(self.organ, 'grasper')
        self.assertIn(why, refused.message)
        line = self.logged(Log.WARN, why)
        self.assertTrue(line.startswith("mesh of organ '%s': " % self.organ), line)
        answer = self.node.query(self.organ, FAR_AWAY)
        self.assertEqual(answer.status, ContactArray.NO_MESH)
        self.assertIn(why, answer.message)
        self.assertIsNone(self.listed())

    def test_a_good_organ_whose_newer_mesh_is_refused(self):
        self.send(KIDNEY)
        self.node.wait_for_shape(self.organ, rospy.Time())
        self.send(NOT_FINITE, topology=2)
        key = self.organ + ', newer mesh refused'
        wait_until(lambda: key in self.node.diagnostics, lambda: self.node.diagnostics)
        self.assertIn('z of vertex 0 is nan', self.node.diagnostics[key])
        self.assert_ok(self.node.query(self.organ, FAR_AWAY))

    def test_an_unknown_organ_is_called_so_once(self):
        def ask():
            answer = self.node.query(self.organ, FAR_AWAY)
            self.assertEqual(answer.status, ContactArray.UNKNOWN_ORGAN)

        line = self.logged(Log.WARN, meanwhile=ask)
        self.assertTrue(line.startswith("organ '%s' is unknown; " % self.organ), line)

    def test_remove_organ(self):
        self.send(KIDNEY)
        self.node.wait_for_shape(self.organ, rospy.Time())
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
        # The organ may come back.
        self.send(OPEN, topology=1)
        self.node.wait_for_shape(self.organ, rospy.Time())

    def test_remove_organ_that_nobody_sent(self):
        answer = self.remove_service(self.organ)
        self.assertFalse(answer.success)
        self.assertIn("'%s' is unknown" % self.organ, answer.message)

    def test_a_tool_of_an_implausible_size(self):
        wait_until(lambda: 'tools' in self.node.summaries, '/diagnostics')
        self.assertEqual(self.node.levels['tools'], DiagnosticStatus.WARN)
        self.assertIn("tool 'log' has a radius of 5 m", self.node.summaries['tools'])
        self.assertEqual(self.node.diagnostics['grasper, radius of the shaft [m]'], '0.005')
        self.send(KIDNEY)
        self.node.wait_for_shape(self.organ, rospy.Time())
        self.assert_ok(self.node.query(self.organ, shaft((0, 0, 1), (0, 0, 2), 5.0)))


if __name__ == '__main__':
    rospy.init_node('organs_test')
    rostest.rosrun('organ_collision', 'organs', OrgansTest, sys.argv)
