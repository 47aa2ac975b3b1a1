#!/usr/bin/python3
"""Names and batches of any size. If one is too large, it is refused, and the answer is small and
says what is legal. Damaged messages, whose arrays are larger than the message."""

import io
import struct
import sys
import xmlrpc.client

from organ_collision.msg import ContactArray, OrganMesh
from organ_collision.srv import QueryCollisionBatchRequest
import rosgraph
import rospy
from rosgraph_msgs.msg import Log
import rostest

from support import oracle, scenes
from support.contact_case import ContactCase
from support.contract import KeepsContract
from support.node_client import NodeClient, TfSender, shaft, wait_until

SHEET = scenes.sheet(0.1, 4)
AXIS = ((0.01, 0.02, 0.3), (0.011, 0.017, 0.002))
GOOD = rospy.Time(5)
HUGE = 'x' * 10**7
ILLEGAL = (HUGE, 'a\nb', '\x1b[31m')
# [items] In 32 bits, these are 8 bytes of floats.
DAMAGED_COUNT = 0x40000002
PEAK = 2 * 1024**2  # [kB] of the node's memory; the array of a damaged message would take 4 GiB
SMALL = 4000  # [bytes] more than the longest names and the longest message together


def size(message):
    buffer = io.BytesIO()
    message.serialize(buffer)
    return len(buffer.getvalue())


class DamagedMesh(OrganMesh):
    """Has vertices without end, as it says."""

    def serialize(self, buff):
        self.header.serialize(buff)
        name = self.organ.encode()
        buff.write(struct.pack('<I%dsII2fI' % len(name), len(name), name, 1, DAMAGED_COUNT, 0, 0, 0))


class DamagedBatch(QueryCollisionBatchRequest):
    """Has motions without end, as it says."""

    def serialize(self, buff):
        self.header.serialize(buff)
        name = self.organ.encode()
        buff.write(struct.pack('<I%dsI' % len(name), len(name), name, 20 * 10**6) + bytes(1000))


def peak_memory(node):
    """[kB] The most memory that a node of this machine has had."""
    address = rosgraph.Master('/limits_test').lookupNode(node)
    pid = xmlrpc.client.ServerProxy(address).getPid('/limits_test')[2]
    with open('/proc/%d/status' % pid) as lines:
        return int(next(line for line in lines if line.startswith('VmHWM')).split()[1])


class LimitsTest(KeepsContract, ContactCase):
    @classmethod
    def setUpClass(cls):
        cls.node = NodeClient()
        cls.log = []
        cls.log_subscriber = rospy.Subscriber('/rosout', Log, cls.log.append)
        wait_until(lambda: cls.log_subscriber.get_num_connections() > 0, 'the log')
        cls.node.send_mesh('good', SHEET, GOOD)
        cls.node.wait_for_shape('good', GOOD)

    def assert_refused(self, answer, *words):
        self.assertEqual(answer.status, ContactArray.INVALID_REQUEST, answer.message[:1000])
        self.assertLess(size(answer), SMALL)
        for word in words:
            self.assertIn(word, answer.message)

    def test_illegal_names_in_requests(self):
        motion = shaft(*AXIS, 0.005)
        for name in ILLEGAL:
            self.assert_refused(self.node.query(name, motion), 'organ', '256')
            self.assert_refused(self.node.query('good', tool=name), 'tool', '256')
            self.assert_refused(self.node.query('good', motion, frame=name), 'frame_id', '256')
            for batch in (
                self.node.answer_batch(name, [motion] * 30),
                self.node.answer_batch('good', [motion] * 30, frame=name),
            ):
                self.assert_refused(batch, '256')
                self.assertEqual(batch.results, [])

    def test_illegal_names_in_messages(self):
        for number, name in enumerate(ILLEGAL):
            stamp = rospy.Time(10 + number)
            self.node.send_mesh(name, SHEET, stamp)
            answer = wait_until(
                lambda: [m for m in self.node.contacts.messages if m.header.stamp == stamp],
                'an answer about the illegal name',
            )[0]
            self.assert_refused(answer, 'organ', '256')
            wait_until(
                lambda: [m for m in self.log if 'a name must be UTF-8' in m.msg],
                'a warning in the log',
            )
        self.assertLess(max(len(m.msg) for m in self.log), SMALL)
        self.assertLess(max(map(len, self.node.diagnostics.values()), default=0), SMALL)

    def test_a_loop_in_tf_with_long_names(self):
        tf = TfSender()
        tf.wait_for(self.node)
        tf.send_resting(
            ('loop_a', 'loop_b', scenes.Pose((0, 0, 0, 1), (0, 0, 1))),
            ('loop_b', 'loop_a', scenes.Pose((0, 0, 0, 1), (0, 0, 1))),
            ('table', 'liver_frame', scenes.Pose((0, 0, 0, 1), (0, 0, 1))),
            *[
                ('loop_b', 'x' * 1000 + str(i), scenes.Pose((0, 0, 0, 1), (0, 0, 1)))
                for i in range(500)
            ]
        )
        motion = shaft(*AXIS, 0.005)
        wait_until(
            lambda: 'loop.' in self.node.query('good', motion, frame='loop_a').message, 'the loop'
        )
        answer = self.node.query('good', motion, frame='loop_a')
        self.assertEqual(answer.status, ContactArray.NO_TRANSFORM)
        self.assertLess(size(answer), SMALL)
        batch = self.node.answer_batch('good', [motion] * 30, frame='loop_a')
        self.assertEqual((batch.status, batch.results), (ContactArray.NO_TRANSFORM, []))
        self.assertLess(size(batch), SMALL)

    def test_a_batch_of_too_many_motions(self):
        motion = shaft(*AXIS, 0.005)
        expected = oracle.static_contacts(SHEET, AXIS, 0.005)
        self.assertGreater(len(expected), 0)
        answer = self.node.answer_batch('good', [motion] * 30)
        self.assertEqual((answer.status, answer.message), (ContactArray.OK, ''))
        self.assertEqual(len(answer.results), 30)
        for result in answer.results:
            self.assert_contacts(result, expected)
        answer = self.node.answer_batch('good', [motion] * 31)
        self.assert_refused(answer, '31 motions', '30', 'max_batch')
        self.assertEqual(answer.results, [])
        # The log reports it.
        wait_until(
            lambda: [m for m in self.log if '31 motions' in m.msg], 'a warning in the log'
        )

    def test_a_batch_whose_answers_are_too_large(self):
        through_all = shaft((0.0, 0.0, 0.1), (0.0, 0.0, -0.1), 0.2)
        one = self.node.query('good', through_all)
        self.assertEqual(len(one.contacts), 32)
        fit = 100000 // size(one)
        self.assertIn(fit, range(10, 30))
        answer = self.node.answer_batch('good', [through_all] * fit)
        self.assertEqual((answer.status, len(answer.results)), (ContactArray.OK, fit))
        answer = self.node.answer_batch('good', [through_all] * 30)
        self.assert_refused(answer, 'first %d of 30' % (fit + 1), '100000', 'max_batch_bytes')
        self.assertEqual(answer.results, [])

    def test_damaged_messages(self):
        self.node.meshes.publish(DamagedMesh(organ='damaged'))
        wait_until(
            lambda: [m for m in self.log if 'are no organ_collision/OrganMesh' in m.msg],
            'the damaged mesh in the log',
        )
        with self.assertRaises(rospy.ServiceException):
            self.node.batch_service(DamagedBatch(organ='good'))
        # The node goes on.
        motion = shaft(*AXIS, 0.005)
        self.assertEqual(self.node.query('damaged', motion).status, ContactArray.UNKNOWN_ORGAN)
        self.assertEqual(self.node.answer_batch('good', [motion]).status, ContactArray.OK)
        self.assertLess(peak_memory('/organ_collision'), PEAK)


if __name__ == '__main__':
    rospy.init_node('limits_test')
    rostest.rosrun('organ_collision', 'limits', LimitsTest, sys.argv)
