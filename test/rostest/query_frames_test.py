#!/usr/bin/python3
"""Queries in other frames and at other times, about moving tissue, and about the node's own
tools."""

import sys

from organ_collision.msg import ContactArray
import rospy
import rostest

from support import oracle, scenes
from support.contact_case import ContactCase
from support.node_client import NodeClient, TfSender, shaft, wait_until

STATIC, SWEPT = ContactArray.STATIC, ContactArray.SWEPT
CAMERA_IN_LIVER = scenes.Pose((0.3, -0.2, 0.5, 0.8), (0.4, -0.3, 0.9))
SHEET = scenes.sheet(0.1, 5).moved(lambda v: (v[0], v[1], v[2] + 0.1 * v[0] - 0.05 * v[1]))


def at(position):
    return scenes.Pose((0, 0, 0, 1), position)


class QueryFramesTest(ContactCase):
    @classmethod
    def setUpClass(cls):
        cls.node = NodeClient()
        cls.tf = TfSender()
        cls.tf.wait_for(cls.node)
        cls.tf.send_resting(('liver_frame', 'camera', CAMERA_IN_LIVER))
        cls.node.send_mesh('framed', SHEET, rospy.Time(7, 5))
        cls.node.wait_for_shape('framed', rospy.Time(7, 5))

    def test_another_frame(self):
        """The same motions, given in the frame of a camera that is rotated and far away."""
        to_camera = CAMERA_IN_LIVER.inverse().apply
        previous, now = ((0.1, 0.02, 0.3), (0.01, 0.002, 0.05)), (
            (0.1, 0.02, 0.31),
            (0.02, 0.01, -0.05),
        )
        expected = oracle.swept_contacts(SHEET, previous, now, 0.005)
        self.assertGreater(len(expected), 0)
        motion = shaft(*map(to_camera, now), 0.005, previous=tuple(map(to_camera, previous)))
        wait_until(
            lambda: self.node.query('framed', motion, SWEPT, frame='camera').status == 0,
            'the static transform of the camera',
        )
        result = self.node.query('framed', motion, SWEPT, frame='camera')
        self.assert_contacts(result, expected)
        self.assertEqual(result.header.frame_id, 'liver_frame')
        (result,) = self.node.query_batch('framed', [motion], SWEPT, frame='camera')
        self.assert_contacts(result, expected)

    def test_stamp_says_when_to_transform(self):
        """A carrier sinks by 0.1 m in 0.1 s, and takes the tip to the sheet at a known time."""
        begin = rospy.Time.now()
        self.tf.send(
            *[
                (
                    'liver_frame',
                    'carrier',
                    at((0, 0, 0.1 - 0.01 * hundredths)),
                    begin + rospy.Duration(0, 10**7 * hundredths),
                )
                for hundredths in range(11)
            ]
        )
        motion = shaft((0.01, 0.002, 0.3), (0.01, 0.002, 0.0), 0.004)
        end = begin + rospy.Duration(0, 10**8)
        wait_until(
            lambda: self.node.query('framed', motion, frame='carrier', stamp=end).status == 0,
            'the transforms of the carrier',
        )
        for height, nanoseconds in (
            (0.1, 1),
            (0.055, 45 * 10**6),
            (0.003, 97 * 10**6),
            (0.0, 10**8),
        ):
            stamp = begin + rospy.Duration(0, nanoseconds)
            axis = ((0.01, 0.002, 0.3 + height), (0.01, 0.002, height))
            result = self.node.query('framed', motion, frame='carrier', stamp=stamp)
            self.assertEqual(result.header.stamp, stamp)
            self.assert_contacts(result, oracle.static_contacts(SHEET, axis, 0.004))
        latest = self.node.query('framed', motion, frame='carrier')
        self.assert_contacts(
            latest, oracle.static_contacts(SHEET, ((0.01, 0.002, 0.3), (0.01, 0.002, 0.0)), 0.004)
        )
        early = self.node.query('framed', motion, frame='carrier', stamp=begin - rospy.Duration(1))
        self.assertEqual(early.status, ContactArray.NO_TRANSFORM)

    def test_tissue_swings_through_a_resting_tool(self):
        """With organ_motion, the tissue moves during the step from its previous to its latest
        shape."""
        high, low = scenes.sheet(0.1, 3, 0.031), scenes.sheet(0.1, 3, -0.02)
        low = low.moved(lambda v: (v[0], v[1] + 0.004, v[2] + 0.2 * v[0]))
        self.node.send_mesh('swing', high, rospy.Time(1))
        self.node.wait_for_shape('swing', rospy.Time(1))
        self.node.send_vertices('swing', low, rospy.Time(2))
        self.node.wait_for_shape('swing', rospy.Time(2))
        axis = ((-0.2, 0.004, 0.013), (0.012, 0.007, 0.015))
        motion = shaft(*axis, 0.003, previous=axis)
        self.assert_contacts(self.node.query('swing', motion, SWEPT), [])
        self.assert_contacts(self.node.query('swing', motion, STATIC), [])
        expected = oracle.contacts(low, high, (axis, axis), 0.003)
        self.assertGreater(len(expected), 2)
        self.assert_contacts(self.node.query('swing', motion, SWEPT, organ_motion=True), expected)
        (result,) = self.node.query_batch('swing', [motion], SWEPT, organ_motion=True)
        self.assert_contacts(result, expected)
        moved = ((-0.2, 0.004, 0.013), (0.02, 0.03, 0.01))
        result = self.node.query(
            'swing', shaft(*moved, 0.003, previous=axis), SWEPT, organ_motion=True
        )
        self.assert_contacts(result, oracle.contacts(low, high, (axis, moved), 0.003))

    def test_a_tool_of_the_node_by_name(self):
        """STATIC uses the tool's present pose in TF. SWEPT moves it there from its last published
        pose."""
        first, second = rospy.Time.now(), rospy.Time.now() + rospy.Duration(0, 10**7)
        self.tf.send_resting(('liver_frame', 'grasper_trocar', at((0.1, 0.02, 0.3))))
        above, below = (0.01, 0.003, 0.05), (0.013, 0.001, -0.05)
        self.tf.send(('liver_frame', 'grasper_tip', at(above), first))
        self.node.send_mesh('named', SHEET, first)
        self.assert_contacts(self.node.contacts.wait_for('named', 'grasper', mesh_stamp=first), [])
        axes = [((0.1, 0.02, 0.3), tip) for tip in (above, below)]
        self.tf.send(('liver_frame', 'grasper_tip', at(below), second))
        expected = oracle.static_contacts(SHEET, axes[1], 0.005)
        self.assertGreater(len(expected), 0)
        wait_until(
            lambda: self.node.query('named', tool='grasper').contacts, 'the tip in the sheet'
        )
        static = self.node.query('named', tool='grasper')
        self.assert_contacts(static, expected)
        self.assertEqual((static.tool, static.links), ('grasper', ['']))
        for _ in range(2):  # twice, because queries change no history
            swept = self.node.query('named', mode=SWEPT, tool='grasper')
            self.assert_contacts(swept, oracle.swept_contacts(SHEET, *axes, 0.005), 1e-6)
        self.assertEqual(len(self.node.contacts.of('named')), 1)


if __name__ == '__main__':
    rospy.init_node('query_frames_test')
    rostest.rosrun('organ_collision', 'query_frames', QueryFramesTest, sys.argv)
