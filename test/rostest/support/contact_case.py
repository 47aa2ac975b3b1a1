"""Test cases: the deepest contact is as deep as expected; no answer breaks the contract. Whether contacts are right in
all else is decided by the exact oracle, in test/query and test/proof."""

import math
import re
import unittest

from organ_collision.msg import ContactArray
import rospy
from std_srvs.srv import Trigger

from .node_client import LIMIT, wait_until


def xyz(message):
    return (message.x, message.y, message.z)


def faces_of(result):
    return [c.face for c in result.contacts]


class KeepsContract(unittest.TestCase):
    """A test whose .test file also starts check_contacts: after each test, it asks whether any answer so far broke the
    contract."""

    def tearDown(self):
        super().tearDown()
        rospy.wait_for_service('/check_contacts/summary', LIMIT)
        ask = rospy.ServiceProxy('/check_contacts/summary', Trigger)
        if self.node.contacts.messages:  # If this test has got answers, so has check_contacts.
            wait_until(lambda: not re.match('0 answers', ask().message), 'answers that are checked')
        found = ask()
        self.assertTrue(found.success, found.message)


class ContactCase(unittest.TestCase):
    def assert_near(self, found, expected, tolerance, what):
        self.assertLessEqual(math.dist(found, expected), tolerance, '%s: %r instead of %r' % (what, found, expected))

    def assert_ok(self, result):
        self.assertEqual((result.status, result.message), (ContactArray.OK, ''))

    def assert_depth(self, result, depth, tolerance=1e-6):
        """Checks how deep the deepest contact is [m]. None: there is no contact."""
        self.assert_ok(result)
        deepest = max((c.depth for c in result.contacts), default=None)
        if depth is None:
            self.assertIsNone(deepest)
        else:
            self.assertGreater(len(result.contacts), 0)
            self.assertAlmostEqual(deepest, depth, delta=tolerance)
