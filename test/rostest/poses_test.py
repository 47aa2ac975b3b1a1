#!/usr/bin/python3
"""Tools whose tip poses arrive as PoseStamped. Each pose is evaluated on arrival, against the organ's last shape."""

import sys

from geometry_msgs.msg import Point, PoseStamped, Quaternion
from organ_collision.msg import ContactArray
import rospy
import rostest

from support import oracle, scenes
from support.contact_case import ContactCase, faces_of
from support.node_client import NodeClient, TfSender, is_heard, wait_until
from support.simulated_clock import SimulatedClock

STATIC, SWEPT = ContactArray.STATIC, ContactArray.SWEPT
SHEET = scenes.sheet(0.1, 4)
RADIUS = 0.004
BASE = scenes.Pose((0.3, -0.2, 0.1, 0.9), (0.013, 0.007, 0.4))  # of the arm in the organ's frame
TROCAR = BASE.translation
SOON = 1e-6  # [m] tolerance of contacts computed from quaternions


def pose(frame, point, stamp=rospy.Time(), rotation=(0, 0, 0, 1)):
    message = PoseStamped()
    message.header.frame_id, message.header.stamp = frame, stamp
    message.pose.position, message.pose.orientation = Point(*point), Quaternion(*rotation)
    return message


def tip_at(x, z):
    return (x, 0.007, z)


class PosesTest(ContactCase):
    @classmethod
    def setUpClass(cls):
        cls.clock = SimulatedClock(20000)
        cls.node = NodeClient('/posed')
        cls.tf = TfSender()
        cls.arm = rospy.Publisher('/PSM1/local/measured_cp', PoseStamped, queue_size=1000)
        cls.base = rospy.Publisher('/SUJ/PSM1/measured_cp', PoseStamped, queue_size=10, latch=True)
        cls.stylus = rospy.Publisher('/stylus/pose', PoseStamped, queue_size=1000)
        for topic in (cls.arm, cls.base, cls.stylus):
            wait_until(lambda topic=topic: is_heard(topic, '/posed'), topic.name)
        cls.tf.wait_for(cls.node)
        cls.base.publish(pose('liver_frame', BASE.translation, rotation=BASE.rotation))
        cls.tf.send_resting(('liver_frame', 'stylus_trocar', (0.0, 0.0, 0.3)))
        cls.stamp = rospy.Time(20000)

    @classmethod
    def tearDownClass(cls):
        cls.clock.stop()

    def setUp(self):
        self.organ = self.id().split('.')[-1]

    def tearDown(self):
        self.node.remove(self.organ)

    @classmethod
    def next_stamp(cls, millis=10):
        cls.stamp += rospy.Duration(0, millis * 10**6)
        with cls.clock.lock:
            if cls.stamp > cls.clock.now:
                cls.clock.tick(cls.stamp - cls.clock.now)
        return cls.stamp

    def move_arm(self, tip, stamp):
        """Moves the tip to a point in the organ's frame. The arm publishes it in its base frame."""
        self.arm.publish(pose('PSM1_base', BASE.inverse().apply(tip), stamp))

    def start(self, tip):
        """Sends the organ and the arm's first pose, and waits for their first step. Returns the stamp."""
        stamp = self.next_stamp()
        self.move_arm(tip, stamp)
        self.node.send_mesh(self.organ, SHEET, stamp)
        first = self.node.contacts.wait_for(self.organ, 'PSM1', mesh_stamp=stamp, status=ContactArray.OK)
        self.assertEqual(first.mode, STATIC)
        return stamp

    def test_a_pose_is_answered_when_it_comes(self):
        """The answer needs no new shape of the organ. It covers the motion since the last pose. The step of a new shape
        begins with the tip at its last place."""
        begin, end = self.start(tip_at(-0.05, 0.1)), self.next_stamp()
        self.move_arm(tip_at(0.05, -0.1), end)
        answer = self.node.contacts.wait_for(self.organ, 'PSM1', stamp=end)
        self.assertEqual((answer.mode, answer.step_start, answer.mesh_stamp), (SWEPT, begin, begin))
        axes = [(TROCAR, tip) for tip in (tip_at(-0.05, 0.1), tip_at(0.05, -0.1))]
        expected = oracle.swept_contacts(SHEET, *axes, RADIUS)
        self.assertGreater(len(expected), 0)
        self.assert_contacts(answer, expected, SOON)
        lowered = SHEET.moved(lambda v: (v[0], v[1], v[2] - 0.03))
        self.node.send_vertices(self.organ, lowered, end)
        answer = self.node.contacts.wait_for(self.organ, 'PSM1', mesh_stamp=end)
        self.assert_contacts(answer, oracle.contacts(lowered, SHEET, (axes[1], axes[1]), RADIUS), SOON)

    def test_poses_faster_than_the_node_are_all_swept(self):
        """The tip jumps from side to side thousands of times a second, each time through the sheet."""
        start, last = self.start(tip_at(-0.09, 0.05)), None
        tips = [tip_at(-0.09 + 0.18 * i / 99, 0.05 if i % 2 else -0.05) for i in range(100)]
        for tip in tips:
            last = self.next_stamp(1)
            self.move_arm(tip, last)
        self.node.contacts.wait_for(self.organ, 'PSM1', stamp=last)
        answers = [a for a in self.node.contacts.of(self.organ, 'PSM1') if a.mode == SWEPT and a.step_start >= start]
        self.assertEqual({answer.status for answer in answers}, {ContactArray.OK})
        # Each step begins where the previous one ended.
        ends = [start] + [answer.header.stamp for answer in answers]
        self.assertEqual([answer.step_start for answer in answers], ends[:-1])
        touched = [oracle.swept_contacts(SHEET, (TROCAR, before), (TROCAR, after), RADIUS)
                   for before, after in zip([tip_at(-0.09, 0.05)] + tips, tips)]
        self.assertEqual({face for answer in answers for face in faces_of(answer)},
                         {c.face for cs in touched for c in cs})

    def test_no_pose_is_no_answer_and_one_without_stamp_is_of_now(self):
        self.node.send_mesh(self.organ, SHEET)
        answer = self.node.contacts.wait_for(self.organ, 'stylus')
        self.assertEqual(answer.status, ContactArray.NO_TRANSFORM)
        self.assertIn('stylus/pose', answer.message)
        self.stylus.publish(pose('liver_frame', (0.01, 0.02, 0.003)))
        answer = self.node.contacts.wait_for(self.organ, 'stylus', status=ContactArray.OK)
        expected = oracle.static_contacts(SHEET, ((0.0, 0.0, 0.3), (0.01, 0.02, 0.003)), RADIUS)
        self.assertGreater(len(expected), 0)
        self.assert_contacts(answer, expected, SOON)

    def test_bad_poses_are_counted_and_change_nothing(self):
        self.start(tip_at(0.0, 0.2))
        for bad in (pose('PSM1_base', (float('nan'), 0, 0), self.next_stamp()), pose('', (0, 0, -1), self.next_stamp()),
                    pose('PSM1_base', (0, 0, -1), self.next_stamp(), rotation=(0, 0, 0, 0))):
            self.arm.publish(bad)
        self.node.diagnostics.wait_for_count('rejected, pose', 3)
        self.move_arm(tip_at(0.0, 0.1), self.next_stamp())
        answer = self.node.contacts.wait_for(self.organ, 'PSM1', stamp=self.stamp)
        self.assertEqual((answer.status, answer.contacts), (ContactArray.OK, []))


if __name__ == '__main__':
    rospy.init_node('poses_test')
    rostest.rosrun('organ_collision', 'poses', PosesTest, sys.argv)
