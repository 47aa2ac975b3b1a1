#!/usr/bin/python3
"""check_contacts watches topics, tells what breaks the contract, and ends with the right exit code."""

import signal
import subprocess
import sys

from organ_collision.msg import Contact, ContactArray
import roslib.packages
import rospy
import rostest
from std_srvs.srv import Trigger

from support.node_client import LIMIT, is_heard, wait_until
from support.node_starter import NodeStarter

NODE = '/watcher'


def good(fraction=0.5):
    answer = ContactArray(organ='liver', tool='probe', links=[''], mode=ContactArray.SWEPT)
    answer.header.frame_id, answer.header.stamp = 'liver_frame', rospy.Time(2)
    answer.step_start = rospy.Time(1)
    contact = Contact(fraction=fraction, barycentric=[0.2, 0.3, 0.5])
    contact.normal.z = 1.0
    answer.contacts = [contact]
    return answer


def program():
    return roslib.packages.find_node('organ_collision', 'check_contacts')[0]


class CheckContactsTest(NodeStarter):
    def start_watching(self, *topics):
        publishers = [rospy.Publisher(topic, ContactArray, queue_size=10) for topic in topics]
        process = subprocess.Popen(
            [program(), '__name:=' + NODE.strip('/'), *topics],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            universal_newlines=True,
        )
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        for publisher in publishers:
            self.addCleanup(publisher.unregister)
        wait_until(lambda: all(is_heard(topic, NODE) for topic in publishers), 'connections')
        rospy.wait_for_service(NODE + '/summary', LIMIT)
        return process, publishers

    def wait_for_answers(self, count):
        ask = rospy.ServiceProxy(NODE + '/summary', Trigger)
        wait_until(lambda: ask().message.startswith('%d answers' % count), lambda: ask().message)
        return ask()

    def finish(self, process, code):
        process.send_signal(signal.SIGINT)
        printed, _ = process.communicate(timeout=LIMIT)
        self.assertEqual(process.returncode, code, printed)
        return printed

    def test_good_answers(self):
        process, topics = self.start_watching('/a/contacts', '/b/contacts')
        for topic in topics:
            topic.publish(good())
        found = self.wait_for_answers(2)
        self.assertTrue(found.success)
        self.assertIn('2 answers came, 2 with status OK', self.finish(process, 0))

    def test_bad_answers(self):
        process, (topic,) = self.start_watching('/c/contacts')
        for fraction in (0.5, float('nan'), 1.5):
            topic.publish(good(fraction))
        found = self.wait_for_answers(3)
        self.assertFalse(found.success)
        printed = self.finish(process, 1)
        for words in ('/c/contacts', "'liver'", "'probe'", 'fraction of contacts[0] (face 0) is nan', 'shares 2'):
            self.assertIn(words, printed)

    def test_no_answers(self):
        process, _ = self.start_watching('/d/contacts')
        self.assertIn('0 answers came', self.finish(process, 3))

    def test_it_ends_by_itself(self):
        done = subprocess.run(
            # This test has the name that the program has by default.
            [program(), '/e/contacts', '--seconds', '0.2', '__name:=ending'],
            timeout=LIMIT,
        )
        self.assertEqual(done.returncode, 3)


if __name__ == '__main__':
    rospy.init_node('check_contacts_test')
    rostest.rosrun('organ_collision', 'check_contacts', CheckContactsTest, sys.argv)
