"""A test case whose .test file also starts check_contacts: after each test, it asks whether any answer so far broke the
contract."""

import re
import unittest

import rospy
from std_srvs.srv import Trigger

from .node_client import LIMIT, wait_until

SERVICE = '/check_contacts/summary'


class KeepsContract(unittest.TestCase):
    def tearDown(self):
        super().tearDown()
        rospy.wait_for_service(SERVICE, LIMIT)
        ask = rospy.ServiceProxy(SERVICE, Trigger)
        if self.node.contacts.messages:  # If this test has got answers, so has check_contacts.
            wait_until(lambda: not re.match('0 answers', ask().message), 'answers that are checked')
        found = ask()
        self.assertTrue(found.success, found.message)
