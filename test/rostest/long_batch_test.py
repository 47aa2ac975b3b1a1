#!/usr/bin/python3
"""While a long batch is answered, steps go on, and single queries are answered. The node ends in the middle of it.
Nothing here is measured in time: a batch is going on as long as /diagnostics counts its motions, and it would take far
longer than the test."""

import sys
import threading

from organ_collision.msg import ContactArray
from organ_collision.srv import QueryCollisionBatch
import rospy
import rostest

from support import scenes
from support.contact_case import ContactCase
from support.node_client import FAR_AWAY, NodeClient, TfSender, shaft, wait_until
from support.processes import NodeStarter

NODE = '/served'
PROBE = {'name': 'probe', 'trocar_frame': 'probe_trocar', 'tip_frame': 'probe_tip', 'radius': 0.005}
# How far such a motion is from each of these faces takes milliseconds.
LARGE = scenes.sheet(0.1, 100)
SLOW = shaft((0.02, 0.01, 0.5), (0.03, 0.02, 0.3), 0.005, ((0.02, 0.01, 0.5), (-0.03, 0.02, 0.3)))
LONG = 100000  # motions


class Batch(threading.Thread):
    """A batch that is asked in a thread of its own. `outcome`: its answer, or the error."""

    def __init__(self, organ, motions, **asked):
        super().__init__(daemon=True)
        self.service = rospy.ServiceProxy(NODE + '/query_batch', QueryCollisionBatch)
        self.request = self.service.request_class(organ=organ, motions=motions, mode=ContactArray.SWEPT, **asked)
        self.request.header.frame_id = 'liver_frame'
        self.outcome = None
        self.start()

    def run(self):
        try:
            self.outcome = self.service(self.request)
        except rospy.ServiceException as error:
            self.outcome = error


class LongBatchTest(ContactCase, NodeStarter):
    def test_a_batch_in_the_background(self):
        process = self.start(NODE, {'tools': [PROBE], 'diagnostic_period': 0.05})
        node, tf, small = NodeClient(NODE), TfSender(), scenes.sheet(0.1, 4)
        tf.wait_for(node)
        tf.send_resting(('liver_frame', 'probe_trocar', (0.01, 0.02, 0.3)),
                        ('liver_frame', 'probe_tip', (0.01, 0.02, 0.002)))
        for organ, mesh in (('large', LARGE), ('small', small)):
            node.bring(organ, mesh, rospy.Time(1))
        both = [Batch('small', [FAR_AWAY] * count) for count in (700, 500)]
        for batch, count in zip(both, (700, 500)):
            batch.join(timeout=60)
            self.assertEqual((batch.outcome.status, len(batch.outcome.results)), (0, count))

        answered = lambda: node.diagnostics.count('motions of batches')
        before = wait_until(answered, 'the count of motions')
        first = Batch('large', [SLOW] * LONG, clearance=True)
        wait_until(lambda: answered() > before, 'motions of the batch')
        second, before = Batch('small', [FAR_AWAY]), answered()
        for step in range(2, 32):
            stamp = rospy.Time(step)
            node.send_vertices('small', small, stamp)
            self.assert_ok(node.contacts.wait_for('small', 'probe', mesh_stamp=stamp))
            self.assert_ok(node.query('small', FAR_AWAY))
        wait_until(lambda: answered() > before, 'more motions of the batch')
        self.assertLess(answered(), LONG)
        self.assertIsNone(first.outcome)

        self.stop(process)
        for batch in (first, second):
            batch.join(timeout=30)
            if not isinstance(batch.outcome, rospy.ServiceException):
                self.assertEqual((batch.outcome.status, batch.outcome.results), (ContactArray.PICKER_FAILED, []))


if __name__ == '__main__':
    rospy.init_node('long_batch_test')
    rostest.rosrun('organ_collision', 'long_batch', LongBatchTest, sys.argv)
