#!/usr/bin/python3
"""A fatal error in a nodelet stops neither its manager nor the other nodelets. The nodelet reports the error for each
tool, restarts, and answers again."""

import sys

from organ_collision.msg import ContactArray
import rospy
import rostest

from support import scenes
from support.contact_case import ContactCase
from support.node_client import NodeClient, TfSender, wait_until

SMALL = scenes.sheet(0.02, 4)
# The needle touches all faces of this mesh, and their contacts need more than a mebibyte. The hook touches no face.
LARGE = scenes.sheet(0.02, 70)


class NodeletRestartTest(ContactCase):
    def send(self, client, topology):
        """Sends a new shape until the needle answers, and checks that it touches all faces. It may answer only after
        the restart."""

        def answers():
            client.send_mesh('liver', SMALL, stamp, topology)
            return client.contacts.of('liver', 'needle', status=ContactArray.OK, mesh_stamp=stamp)

        stamp = rospy.Time.now()
        answer = wait_until(answers, 'contacts of the shape of %s' % stamp)[0]
        self.assertEqual([c.face for c in answer.contacts], list(range(len(SMALL.faces))))
        return answer

    def test_one_nodelet_breaks_down_and_is_back(self):
        left, right = (NodeClient(name + '/organ_collision', process='/manager') for name in ('/left', '/right'))
        tf = TfSender()
        tf.wait_for(left)
        tf.send_resting(*[('liver_frame', tool + end, (x, 0.0, z)) for tool, x in (('needle', 0.0), ('hook', 1.0))
                          for end, z in (('_trocar', 0.3), ('_tip', 0.05))])
        for client in (left, right):
            self.send(client, 1)
        left.send_mesh('liver', LARGE, rospy.Time.now(), 2)
        for tool in ('needle', 'hook'):
            failure = left.contacts.wait_for('liver', tool, status=ContactArray.PICKER_FAILED)
            self.assertIn('bad_alloc', failure.message)
            self.assertIn('send the organs again', failure.message)
            self.assertEqual((failure.contacts, failure.header.frame_id), ([], 'liver_frame'))
        left.diagnostics.wait_for_summary('queries', 'bad_alloc')  # Soon after, the node reports that all is well.
        self.send(right, 1)
        self.assertEqual(self.send(left, 3).mode, ContactArray.STATIC)
        self.assertEqual(right.contacts.of('liver', status=ContactArray.PICKER_FAILED), [])


if __name__ == '__main__':
    rospy.init_node('nodelet_restart_test')
    rostest.rosrun('organ_collision', 'nodelet_restart', NodeletRestartTest, sys.argv)
