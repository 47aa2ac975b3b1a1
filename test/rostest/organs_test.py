#!/usr/bin/python3
"""When a simulator that starts again begins a new history."""

import signal
import subprocess
import sys

from organ_collision.msg import ContactArray, TouchEvent
from organ_collision.srv import RemoveOrgan
import rospy
import rostest

from support.contact_case import ContactCase, faces_of, KeepsContract
from support.node_client import Log, NodeClient, TfSender, wait_until
from support.tool_over_sheet import at_height, SHEET

STATIC, SWEPT = ContactArray.STATIC, ContactArray.SWEPT
BELOW, TOUCHING, ABOVE = -0.1, 0.0, 0.5  # [m] heights of a sheet: below the tool, across it, and beyond its trocar


def simulate(organ, height):
    """A simulator: sends a sheet that rests at this height, at 50 Hz."""
    rospy.init_node('simulator')  # The test gives it another name.
    node = NodeClient()
    sheet = SHEET.moved(lambda v: (v[0], v[1], height))
    start = rospy.Time.now()
    node.send_mesh(organ, sheet, start)
    node.wait_for_shape(organ, start)
    while not rospy.is_shutdown():
        node.send_vertices(organ, sheet, rospy.Time.now())
        rospy.rostime.wallsleep(0.02)


class OrgansTest(KeepsContract, ContactCase):
    @classmethod
    def setUpClass(cls):
        cls.node = NodeClient()
        cls.remove_service = rospy.ServiceProxy('/organ_collision/remove_organ', RemoveOrgan)
        tf = TfSender()
        tf.wait_for(cls.node)
        tf.send_resting(*[('liver_frame', 'grasper' + end, point)
                          for end, point in zip(('_trocar', '_tip'), at_height(0.001))])

    def setUp(self):
        self.organ = self.id().split('.')[-1]

    def tearDown(self):
        super().tearDown()
        self.remove_service(self.organ)

    def start(self, name, height):
        """Starts a simulator, and waits for the answers about four of its shapes. Returns the process, and the
        answers since the start."""
        start = rospy.Time.now()
        process = subprocess.Popen([sys.executable, __file__, '--simulate', self.organ, str(height), '__name:=' + name])
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        answers = lambda: [answer for answer in self.node.contacts.of(self.organ) if answer.mesh_stamp > start]
        wait_until(lambda: len(answers()) >= 4, 'answers about the shapes of ' + name)
        return process, answers()

    def test_a_simulator_that_starts_again(self):
        """Its first answer is static, so that nothing is touched between its shape and that of the dead process. That
        it is a new process shows also if it has the old name, or if the old process had no time to say that it ends."""
        touches = Log('/organ_collision/touches', TouchEvent).wait_for_publisher()
        told = lambda: [(event.event, event.reason) for event in touches.select(lambda e: e.organ == self.organ)]
        process, _ = self.start('simulator', BELOW)
        for name, end, height in (('simulator', signal.SIGKILL, ABOVE), ('simulator', signal.SIGINT, BELOW),
                                  ('second_simulator', signal.SIGINT, ABOVE),
                                  ('third_simulator', signal.SIGKILL, BELOW)):
            process.send_signal(end)
            process.wait()
            process, answers = self.start(name, height)
            self.assertEqual([answer.mode for answer in answers], [STATIC] + [SWEPT] * (len(answers) - 1), name)
            self.assertEqual([faces for faces in map(faces_of, answers) if faces], [], name)
            self.assertEqual(told(), [])
        process.kill()
        process.wait()
        process, answers = self.start('third_simulator', TOUCHING)
        self.assertGreater(len(answers[0].contacts), 0)
        self.assertEqual({contact.since for contact in answers[-1].contacts}, {answers[0].header.stamp})
        process.kill()
        process.wait()
        self.start('third_simulator', TOUCHING)
        wait_until(lambda: len(told()) >= 3, told)
        self.assertEqual(told(), [(TouchEvent.BEGIN, ''), (TouchEvent.END, 'sender restarted'), (TouchEvent.BEGIN, '')])


if __name__ == '__main__':
    if sys.argv[1:2] == ['--simulate']:
        simulate(sys.argv[2], float(sys.argv[3]))
        sys.exit()
    rospy.init_node('organs_test')
    rostest.rosrun('organ_collision', 'organs', OrgansTest, sys.argv)
