#!/usr/bin/python3
"""The services query and query_batch. A long batch does not disturb the node, which may end in the middle of it. Contacts
and refusals are in unit tests."""

import sys
import threading

from organ_collision.msg import ContactArray, ToolPlacement
from organ_collision.srv import QueryCollisionBatch
import rospy
import rostest

from support import scenes
from support.contact_case import KeepsContract
from support.node_client import FAR_AWAY, NodeClient, shaft, wait_until
from support.processes import NodeStarter
from support.tool_case import ToolCase

LIVER = scenes.liver()
LONG = 100000  # motions of a batch that takes far longer than the test


class Batch(threading.Thread):
    """A batch that is asked in a thread of its own. `outcome`: its answer, or the error."""

    def __init__(self, node, organ, motions, **asked):
        super().__init__(daemon=True)
        self.service = rospy.ServiceProxy(node + '/query_batch', QueryCollisionBatch)
        self.request = self.service.request_class(organ=organ, motions=motions, mode=ContactArray.SWEPT, **asked)
        self.request.header.frame_id = 'liver_frame'
        self.outcome = None
        self.start()

    def run(self):
        try:
            self.outcome = self.service(self.request)
        except rospy.ServiceException as error:
            self.outcome = error


class QueryTest(KeepsContract, ToolCase, NodeStarter):
    link_frames = {'hook': ('hook_trocar', 'hook_tip', 'hook/ball'), 'ball': ('ball/ball',)}

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.node.bring('liver', LIVER)

    def test_placement_comes_once_the_node_knows_the_surface(self):
        motion = shaft((0.3, 0.31, 0.32), (0.0013, -0.0021, 0.0017), 0.002)
        ask = lambda: self.node.query('liver', motion, placement=True).placement
        found = wait_until(lambda: ask() if ask().tip != ToolPlacement.UNKNOWN else None, 'sides of the liver')
        self.assertEqual((found.tip, found.trocar, len(found.crossings), found.length_known),
                         (ToolPlacement.INSIDE, ToolPlacement.OUTSIDE, 1, True))
        (of_batch,) = self.node.query_batch('liver', [motion], placement=True)
        self.assertEqual(of_batch.placement, found)

    def test_a_long_batch_in_the_background(self):
        """Steps go on, and single queries are answered. Nothing is measured in time: the batch is going on as long as
        /diagnostics counts its motions."""
        name, tip, small = '/served', (0.01, 0.02, 0.002), scenes.sheet(0.1, 4)
        process = self.start(name, {'tools': [{'name': 'probe', 'trocar_frame': 'liver_frame', 'tip_frame': 'probe_tip',
                                               'radius': 0.005}], 'diagnostic_period_sec': 0.05})
        node = NodeClient(name)
        self.addCleanup(node.close)
        self.tf.wait_for(node)
        self.tf.send_resting(('liver_frame', 'probe_tip', tip))
        # How far a motion is from each of many faces takes milliseconds.
        for organ, mesh in (('large', scenes.sheet(0.1, 100)), ('small', small)):
            node.bring(organ, mesh, rospy.Time(1))
        answered = lambda: node.diagnostics.count('motions of batches')
        slow = shaft((0.02, 0.01, 0.5), (0.03, 0.02, 0.3), 0.005, ((0.02, 0.01, 0.5), (-0.03, 0.02, 0.3)))
        first = Batch(name, 'large', [slow] * LONG, clearance=True)
        before = wait_until(answered, 'motions of the batch')
        second = Batch(name, 'small', [FAR_AWAY])
        for step in range(2, 32):
            node.send_vertices('small', small, rospy.Time(step))
            self.assert_ok(node.contacts.wait_for('small', 'probe', mesh_stamp=rospy.Time(step)))
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
    rospy.init_node('query_test')
    rostest.rosrun('organ_collision', 'query', QueryTest, sys.argv)
