#!/usr/bin/python3
"""A fatal error in a nodelet stops neither its manager nor the other nodelets. The nodelet reports
the error for each tool, restarts, and answers again."""

import sys

from organ_collision.msg import ContactArray
import rospy
import rostest

from support import scenes
from support.contact_case import ContactCase
from support.node_client import NodeClient, TfSender, wait_until

SMALL = scenes.sheet(0.02, 4)
# The probe touches all faces of this mesh, and their contacts need more than a mebibyte. The hook
# touches no face.
LARGE = scenes.sheet(0.02, 70)


class NodeletRestartTest(ContactCase):
    def setUp(self):
        self.left, self.right = (
            NodeClient(name + '/organ_collision', process='/manager') for name in ('/left', '/right')
        )
        self.tf = TfSender()
        self.tf.wait_for(self.left)
        for tool, x in (('probe', 0.0), ('hook', 1.0)):
            self.tf.send_resting(
                *(
                    ('liver_frame', tool + end, scenes.Pose((0, 0, 0, 1), (x, 0.0, z)))
                    for end, z in (('_trocar', 0.3), ('_tip', 0.05))
                )
            )

    def send(self, client, mesh, topology):
        """Sends a new shape and returns the probe's answer, which may arrive only after the
        restart."""

        def answers():
            client.send_mesh('liver', mesh, stamp, topology)
            return client.contacts.of('liver', 'probe', status=ContactArray.OK, mesh_stamp=stamp)

        stamp = rospy.Time.now()
        return wait_until(answers, 'contacts of the shape of %s' % stamp)[0]

    def assert_touched(self, answer, mesh):
        self.assert_ok(answer)
        self.assertEqual([c.face for c in answer.contacts], list(range(len(mesh.faces))))

    def test_one_nodelet_breaks_down_and_is_back(self):
        for client in (self.left, self.right):
            self.assert_touched(self.send(client, SMALL, 1), SMALL)

        stamp = rospy.Time.now()
        self.left.send_mesh('liver', LARGE, stamp, 2)
        for tool in ('probe', 'hook'):
            failure = self.left.contacts.wait_for(
                'liver', tool, status=ContactArray.PICKER_FAILED
            )
            self.assertIn('bad_alloc', failure.message)
            self.assertIn('send the organs again', failure.message)
            self.assertEqual(failure.contacts, [])
            self.assertEqual(failure.header.frame_id, 'liver_frame')
        # Soon after the restart, the node reports that all is well.
        wait_until(
            lambda: any('bad_alloc' in s for s in self.left.past_summaries.get('queries', [])),
            lambda: self.left.past_summaries,
        )

        self.assert_touched(self.send(self.right, SMALL, 1), SMALL)
        answer = self.send(self.left, SMALL, 3)
        self.assert_touched(answer, SMALL)
        self.assertEqual(answer.mode, ContactArray.STATIC)
        self.assertEqual(self.right.contacts.of('liver', status=ContactArray.PICKER_FAILED), [])


if __name__ == '__main__':
    rospy.init_node('nodelet_restart_test')
    rostest.rosrun('organ_collision', 'nodelet_restart', NodeletRestartTest, sys.argv)
