#!/usr/bin/python3
"""While a long batch is answered, steps go on, and single queries are answered. The node ends in the
middle of it. Nothing here is measured in time: a batch is going on as long as /diagnostics counts
its motions, and it would take far longer than the test."""

import sys
import threading

from organ_collision.msg import ContactArray
from organ_collision.srv import QueryCollisionBatch
import rospy
import rostest

from support import scenes
from support.contact_case import ContactCase
from support.node_client import FAR_AWAY, NodeClient, TfSender, shaft, wait_until
from support.node_starter import NodeStarter

NODE = '/served'
PROBE = {'name': 'probe', 'trocar_frame': 'probe_trocar', 'tip_frame': 'probe_tip', 'radius': 0.005}
PARAMETERS = {'tools': [PROBE], 'diagnostic_period': 0.05}
# How far such a motion is from each of these faces takes milliseconds.
LARGE = scenes.sheet(0.1, 100)
SLOW = shaft((0.02, 0.01, 0.5), (0.03, 0.02, 0.3), 0.005, ((0.02, 0.01, 0.5), (-0.03, 0.02, 0.3)))
LONG = 100000  # motions


class Batch(threading.Thread):
    """A batch that is asked in a thread of its own. `outcome`: its answer, or the error."""

    def __init__(self, organ, motions, **asked):
        super().__init__(daemon=True)
        self.service = rospy.ServiceProxy(NODE + '/query_batch', QueryCollisionBatch)
        self.request = dict(organ=organ, motions=motions, mode=ContactArray.SWEPT, **asked)
        self.outcome = None
        self.start()

    def run(self):
        request = self.service.request_class(**self.request)
        request.header.frame_id = 'liver_frame'
        try:
            self.outcome = self.service(request)
        except rospy.ServiceException as error:
            self.outcome = error


class LongBatchTest(ContactCase, NodeStarter):
    def setUp(self):
        self.process = self.start(NODE, PARAMETERS)
        self.node = NodeClient(NODE)
        self.addCleanup(self.node.close)
        self.tf = TfSender()
        self.tf.wait_for(self.node)
        self.tf.send_resting(
            ('liver_frame', 'probe_trocar', scenes.Pose((0, 0, 0, 1), (0.01, 0.02, 0.3))),
            ('liver_frame', 'probe_tip', scenes.Pose((0, 0, 0, 1), (0.01, 0.02, 0.002))),
        )
        self.small = scenes.sheet(0.1, 4)
        for organ, mesh in (('large', LARGE), ('small', self.small)):
            self.node.send_mesh(organ, mesh, rospy.Time(1))
            self.node.wait_for_shape(organ, rospy.Time(1))

    def answered(self):
        """How many motions of batches the node has answered."""
        return int(self.node.diagnostics.get('motions of batches', 0))

    def start_long_batch(self):
        batch = Batch('large', [SLOW] * LONG, clearance=True)
        wait_until(lambda: self.answered() > 0, 'motions of the batch')
        return batch

    def test_steps_and_queries_go_on_during_a_batch(self):
        batch = self.start_long_batch()
        before = self.answered()
        for step in range(2, 52):
            stamp = rospy.Time(step)
            self.node.send_vertices('small', self.small, stamp)
            self.assert_ok(self.node.contacts.wait_for('small', 'probe', mesh_stamp=stamp))
            self.assert_ok(self.node.query('small', FAR_AWAY))
        wait_until(lambda: self.answered() > before, 'more motions of the batch')
        self.assertLess(self.answered(), LONG)
        self.assertIsNone(batch.outcome)

        self.stop(self.process)
        batch.join(timeout=30)
        self.assert_no_results(batch)

    def test_a_second_batch_waits_for_the_first(self):
        first, second = self.start_long_batch(), Batch('small', [FAR_AWAY])
        self.assert_ok(self.node.query('small', FAR_AWAY))
        self.stop(self.process)
        for batch in (first, second):
            batch.join(timeout=30)
            self.assert_no_results(batch)

    def assert_no_results(self, batch):
        if not isinstance(batch.outcome, rospy.ServiceException):
            self.assertEqual(batch.outcome.status, ContactArray.PICKER_FAILED)
            self.assertEqual(batch.outcome.results, [])

    def test_two_clients_of_batches_at_once(self):
        batches = [Batch('small', [FAR_AWAY] * count) for count in (700, 500)]
        for batch, count in zip(batches, (700, 500)):
            batch.join(timeout=60)
            self.assertEqual((batch.outcome.status, len(batch.outcome.results)), (0, count))


if __name__ == '__main__':
    rospy.init_node('long_batch_test')
    rostest.rosrun('organ_collision', 'long_batch', LongBatchTest, sys.argv)
