#!/usr/bin/python3
"""What the node says about the organs that it has: in the log, on /diagnostics and by list_organs. How an organ is
removed, and when a mesh is a new organ. Refusals are in test/ros/organs."""

import itertools
import re
import sys

from organ_collision.msg import ContactArray
from organ_collision.srv import ListOrgans, RemoveOrgan
import rospy
from rosgraph_msgs.msg import Log as LogLine
import rostest

from support import scenes
from support.contact_case import ContactCase, KeepsContract, xyz
from support.node_client import FAR_AWAY, Log, NodeClient, TfSender, wait_until
from support.tool_over_sheet import at_height

STATIC, SWEPT, INVALID = ContactArray.STATIC, ContactArray.SWEPT, ContactArray.INVALID_REQUEST
KIDNEY = scenes.box((0.12, 0.09, 0.06)).moved(lambda v: (v[0] + 0.3, v[1], v[2] - 0.2))
VOLUME = 0.12 * 0.09 * 0.06  # [m^3]


class OrgansTest(KeepsContract, ContactCase):
    @classmethod
    def setUpClass(cls):
        cls.node = NodeClient()
        cls.list_service = rospy.ServiceProxy('/organ_collision/list_organs', ListOrgans)
        cls.remove_service = rospy.ServiceProxy('/organ_collision/remove_organ', RemoveOrgan)
        tf = TfSender()
        tf.wait_for(cls.node)
        tf.send_resting(*[('liver_frame', 'grasper' + end, point)
                          for end, point in zip(('_trocar', '_tip'), at_height(0.001))])
        cls.seconds = 100

    @classmethod
    def next_stamp(cls):
        cls.seconds += 1
        return rospy.Time(cls.seconds)

    def setUp(self):
        self.organ = self.id().split('.')[-1]

    def tearDown(self):
        super().tearDown()
        self.remove_service(self.organ)

    def listed(self):
        """What list_organs says about this test's organ; None if it is not there."""
        return {organ.name: organ for organ in self.list_service().organs}.get(self.organ)

    def test_says_what_came(self):
        log, names = Log('/rosout', LogLine), ('heard_%d' % i for i in itertools.count())

        def is_logged():
            """The node logs each new organ."""
            self.node.bring(next(names), KIDNEY)
            return log.select(lambda line: line.level == LogLine.INFO and re.fullmatch(
                r"organ 'heard_\d+': 12 faces, closed, 0.12 x 0.09 x 0.06 m", line.msg))

        wait_until(is_logged, lambda: [line.msg for line in log.messages])
        self.node.bring(self.organ, KIDNEY, rospy.Time(7), topology=3)
        expected = {'faces': '12', 'surface': 'closed', 'orientation': 'outward'}
        shown = lambda: {key: self.node.diagnostics.values.get('%s, %s' % (self.organ, key)) for key in expected}
        wait_until(lambda: shown() == expected, shown)
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
        self.node.bring(self.organ, KIDNEY)  # The organ may come back.

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
