#!/usr/bin/python3
"""Sends random messages and requests with a fixed seed, most of them malformed: three in each of ~rounds rounds. The
node must survive, and answers about a good organ must stay the same. ~process: of the nodelet, if it is one."""

import random
import sys

from geometry_msgs.msg import Point
from organ_collision.msg import ContactArray, OrganMesh, OrganVertices, ToolMotion
import rospy
import rostest

from support import oracle, scenes
from support.contact_case import ContactCase
from support.contract import KeepsContract
from support.node_client import NodeClient, TfSender, shaft, wait_until

SHEET = scenes.sheet(0.1, 4)
AXIS = ((0.01, 0.02, 0.3), (0.011, 0.017, 0.002))
ODD = [
    0.0,
    -0.0,
    1e-45,
    1e-20,
    0.01,
    -0.5,
    1e6,
    3e38,
    -3e38,
    float('nan'),
    float('inf'),
    -float('inf'),
]


class FuzzTest(KeepsContract, ContactCase):
    @classmethod
    def setUpClass(cls):
        cls.node = NodeClient(process=rospy.get_param('~process', None))
        cls.rng = random.Random(4711)
        cls.tf = TfSender()
        cls.tf.wait_for(cls.node)
        cls.tf.send_resting(
            *[
                ('liver_frame', 'grasper' + end, scenes.Pose((0, 0, 0, 1), point))
                for end, point in zip(('_trocar', '_tip'), AXIS)
            ]
        )
        cls.node.send_mesh('good', SHEET, rospy.Time(5))
        cls.node.wait_for_shape('good', rospy.Time(5))

    def number(self):
        return self.rng.choice(ODD) if self.rng.random() < 0.2 else self.rng.uniform(-0.1, 0.1)

    def header(self, message):
        message.header.frame_id = self.rng.choice(
            ['', 'liver_frame', 'liver_frame', 'a b', '/', '☃']
        )
        message.header.stamp = rospy.Time(
            self.rng.choice([0, 1, 2**32 - 1]), self.rng.randrange(10**9)
        )
        return message

    def vertices(self):
        count = self.rng.choice([0, 1, 2, 3, 9, 30, 75, 3000])
        bad = self.rng.random() < 0.5
        return [self.number() if bad else self.rng.uniform(-0.1, 0.1) for _ in range(count)]

    def mesh(self):
        message = OrganMesh(
            organ=self.rng.choice(['', 'a', 'b', 'ø\n']),
            vertices=self.vertices(),
            topology=self.rng.choice([0, 1, 2, 2**32 - 1]),
        )
        most = max(1, len(message.vertices) // 3)
        if self.rng.random() < 0.3:
            most = self.rng.choice([2**32, most + 1])
        message.triangles = [
            self.rng.randrange(most)
            for _ in range(self.rng.choice([0, 1, 3, 30, 96, 3 * 1000, 3 * 1001]))
        ]
        return self.header(message)

    def moved(self):
        message = OrganVertices(
            organ=self.rng.choice(['', 'a', 'b', 'c']),
            vertices=self.vertices(),
            topology=self.rng.choice([0, 1, 2]),
        )
        return self.header(message)

    def motion(self):
        points = [Point(*(self.number() for _ in range(3))) for _ in range(4)]
        if self.rng.random() < 0.2:
            points[2] = points[3]
        return ToolMotion(*points, self.rng.choice([0.005, 0.05, self.number()]))

    def query(self):
        organ = self.rng.choice(['good', 'good', 'a', 'b', ''])
        frame = self.rng.choice(['liver_frame', 'liver_frame', '', '/', 'nowhere'])
        mode = self.rng.choice([0, 1, 2, 3, 4, 5, 255])
        tool = self.rng.choice(['', '', '', 'grasper', 'saw'])
        gives_motion = not tool or self.rng.random() < 0.2
        return self.node.query(
            organ,
            self.motion() if gives_motion else None,
            mode,
            tool=tool,
            frame=frame,
            organ_motion=self.rng.random() < 0.5,
            regions=self.rng.random() < 0.5,
        )

    def test_the_node_lives_and_the_good_organ_answers(self):
        expected = oracle.static_contacts(SHEET, AXIS, 0.005)
        statuses = set()
        for i in range(rospy.get_param('~rounds', 600)):
            self.node.meshes.publish(self.mesh())
            self.node.shapes.publish(self.moved())
            result = self.query()
            statuses.add(result.status)
            if result.status == ContactArray.OK:
                for contact in result.contacts:
                    self.assertGreaterEqual(contact.fraction, 0)
                    self.assertLessEqual(contact.fraction, 1)
            else:
                self.assertEqual(result.contacts, [])
                self.assertNotEqual(result.message, '')
            if i % 20 == 0:
                self.assert_contacts(self.node.query('good', shaft(*AXIS, 0.005)), expected)
        self.assert_contacts(self.node.query('good', shaft(*AXIS, 0.005)), expected)
        self.assertLessEqual(
            {
                ContactArray.OK,
                ContactArray.INVALID_REQUEST,
                ContactArray.UNKNOWN_TOOL,
                ContactArray.NO_TRANSFORM,
            },
            statuses,
        )
        # After all of them, a new organ is still accepted.
        self.node.send_mesh('after', SHEET, rospy.Time(6))
        self.node.wait_for_shape('after', rospy.Time(6))


if __name__ == '__main__':
    rospy.init_node('fuzz_test')
    rostest.rosrun('organ_collision', 'fuzz', FuzzTest, sys.argv)
