#!/usr/bin/python3
"""Bad requests. Each is answered with a status and a message that names the value, and the last
good state stays as it was."""

import sys

from geometry_msgs.msg import Point
from organ_collision.msg import ContactArray
import rospy
import rostest

from support import oracle, scenes
from support.contact_case import ContactCase
from support.contract import KeepsContract
from support.node_client import NodeClient, shaft

NAN, INFINITY = float('nan'), float('inf')
SHEET = scenes.sheet(0.1, 4)
AXIS = ((0.01, 0.02, 0.3), (0.011, 0.017, 0.002))
SWEPT = ContactArray.SWEPT


class BadRequestsTest(KeepsContract, ContactCase):
    @classmethod
    def setUpClass(cls):
        cls.node = NodeClient()
        cls.node.send_mesh('good', SHEET, rospy.Time(5))
        cls.node.wait_for_shape('good', rospy.Time(5))

    def assert_good_state(self):
        """Checks that queries about the good organ are answered as before."""
        expected = oracle.static_contacts(SHEET, AXIS, 0.005)
        self.assertGreater(len(expected), 0)
        self.assert_contacts(self.node.query('good', shaft(*AXIS, 0.005)), expected)

    def assert_invalid(self, result, status=ContactArray.INVALID_REQUEST, *words):
        self.assertEqual(
            (result.status, result.contacts, result.regions), (status, [], []), result.message
        )
        self.assertNotEqual(result.message, '')
        for word in words:
            self.assertIn(word, result.message)
        self.assert_good_state()

    def assert_invalid_batch(self, answer, status, *words):
        self.assertEqual((answer.status, answer.results), (status, []), answer.message)
        for word in words:
            self.assertIn(word, answer.message)
        self.assert_good_state()

    def test_radius(self):
        for radius, word in ((0.0, '0'), (-0.25, '-0.25'), (NAN, 'nan'), (INFINITY, 'inf')):
            for mode in range(5):
                self.assert_invalid(
                    self.node.query('good', shaft(*AXIS, radius, AXIS), mode),
                    ContactArray.INVALID_REQUEST,
                    'radius',
                    word,
                )

    def test_points_that_are_not_finite(self):
        for field in ('trocar', 'tip', 'previous_trocar', 'previous_tip'):
            for value, word in ((NAN, 'nan'), (-INFINITY, '-inf')):
                motion = shaft(*AXIS, 0.005, previous=AXIS)
                setattr(motion, field, Point(0.1, value, 0.2))
                self.assert_invalid(
                    self.node.query('good', motion, SWEPT), ContactArray.INVALID_REQUEST, word
                )
                (result,) = self.node.query_batch('good', [motion], SWEPT)
                self.assert_invalid(result, ContactArray.INVALID_REQUEST, word)

    def test_previous_points_are_unused_when_static(self):
        bad = (NAN, NAN, NAN)
        result = self.node.query('good', shaft(*AXIS, 0.005, previous=(bad, bad)))
        self.assert_contacts(result, oracle.static_contacts(SHEET, AXIS, 0.005))

    def test_values_at_the_edge_of_a_double(self):
        """Huge motions may be refused or answered, but must not hang or crash."""
        for size in (1e10, 1e38, 1e154, 1e300, 1e308):
            for axis, previous in (
                ((AXIS[0], (0.0, 0.0, -size)), AXIS),
                (AXIS, ((size, 0.0, 0.0), AXIS[1])),
                (((size, size, size), (-size, -size, -size)), AXIS),
            ):
                for mode in range(5):
                    result = self.node.query('good', shaft(*axis, 0.005, previous=previous), mode)
                    if result.status == ContactArray.OK:
                        self.assertEqual(result.message, '')
                    else:
                        self.assertNotEqual(result.message, '')
        for radius in (5e-324, 1e-300, 1e10, 1e300):
            self.node.query('good', shaft(*AXIS, radius, AXIS), SWEPT)
        self.assert_good_state()

    def test_unknown_names(self):
        motion = shaft(*AXIS, 0.005)
        self.assert_invalid(
            self.node.query('kidney', motion), ContactArray.UNKNOWN_ORGAN, 'kidney', 'good'
        )
        self.assert_invalid_batch(
            self.node.answer_batch('kidney', [motion]), ContactArray.UNKNOWN_ORGAN, 'kidney', 'good'
        )
        self.assert_invalid(
            self.node.query('good', tool='scalpel'), ContactArray.UNKNOWN_TOOL, 'scalpel', 'grasper'
        )
        self.assertIn(
            self.node.query('', motion).status,
            (ContactArray.UNKNOWN_ORGAN, ContactArray.INVALID_REQUEST),
        )

    def test_mode_out_of_range(self):
        for mode in (5, 9, 255):
            self.assert_invalid(
                self.node.query('good', shaft(*AXIS, 0.005, AXIS), mode),
                ContactArray.INVALID_REQUEST,
                str(mode),
                '4',
            )
            self.assert_invalid_batch(
                self.node.answer_batch('good', [shaft(*AXIS, 0.005, AXIS)], mode),
                ContactArray.INVALID_REQUEST,
                str(mode),
            )

    def test_frames(self):
        motion = shaft(*AXIS, 0.005)
        self.assert_invalid(
            self.node.query('good', motion, frame='nowhere'), ContactArray.NO_TRANSFORM, 'nowhere'
        )
        self.assert_invalid(self.node.query('good', motion, frame=''), ContactArray.INVALID_REQUEST)
        self.assert_invalid_batch(
            self.node.answer_batch('good', [motion], frame='nowhere'),
            ContactArray.NO_TRANSFORM,
            'nowhere',
        )

    def test_a_tool_without_transforms(self):
        self.assert_invalid(self.node.query('good', tool='grasper'), ContactArray.NO_TRANSFORM)
        self.node.send_mesh('seen_by_no_tool', SHEET, rospy.Time(6))
        result = self.node.contacts.wait_for('seen_by_no_tool', 'grasper')
        self.assert_invalid(result, ContactArray.NO_TRANSFORM, 'grasper_t')
        self.assert_invalid(
            self.node.query('good', mode=SWEPT, tool='grasper'), ContactArray.NO_TRANSFORM
        )


if __name__ == '__main__':
    rospy.init_node('bad_requests_test')
    rostest.rosrun('organ_collision', 'bad_requests', BadRequestsTest, sys.argv)
