"""Test cases: contacts are those of the oracle, face by face and field by field; no answer breaks the contract."""

import re
import unittest

from organ_collision.msg import ContactArray
import rospy
from std_srvs.srv import Trigger

from .node_client import LIMIT, wait_until
from .vectors import cross, dot, length, sub


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


SHAFT_LINK = -1  # Contact.link of a shaft


class ContactCase(unittest.TestCase):
    def assert_near(self, found, expected, tolerance, what):
        difference = length(sub(found, expected))
        self.assertLessEqual(difference, tolerance, '%s: %r instead of %r' % (what, found, expected))

    def assert_ok(self, result):
        self.assertEqual((result.status, result.message), (ContactArray.OK, ''))

    def assert_contacts(self, result, expected, tolerance=1e-7):
        """Checks that the contacts are the oracle's, `expected`, all with the shaft, or with the first link of a
        tool of links."""
        link = 0 if result.links else SHAFT_LINK
        self.assertEqual([c.face for c in result.contacts if c.link != link], [])
        self.assert_contacts_of_link(result, link, expected, tolerance)

    def assert_contacts_of_link(self, result, link, expected, tolerance):
        """Checks that the contacts with one link are `expected`: the same faces in the same order, lengths [m] and
        fractions within `tolerance`, and directions, barycentric coordinates and places on the shaft within 100 times
        that."""
        self.assert_ok(result)
        contacts = [c for c in result.contacts if c.link == link]
        self.assertEqual([c.face for c in contacts], [c.face for c in expected])
        for found, right in zip(contacts, expected):
            what = 'face %d' % right.face
            self.assertAlmostEqual(found.fraction, right.fraction, delta=tolerance, msg=what)
            self.assert_near(xyz(found.point), right.point, tolerance, what + ' point')
            self.assert_near(xyz(found.normal), right.normal, 100 * tolerance, what + ' normal')
            self.assertAlmostEqual(length(xyz(found.normal)), 1.0, delta=1e-9, msg=what)
            self.assert_near(found.barycentric, right.barycentric, 100 * tolerance, what + ' barycentric')
            self.assertAlmostEqual(found.shaft, right.shaft, delta=100 * tolerance, msg=what)
            self.assertAlmostEqual(found.depth, right.depth, delta=tolerance, msg=what)
            if right.behind is not None:
                self.assertEqual(found.behind, right.behind, what)

    def assert_regions_lie_on_faces(self, result, mesh, margin=1e-5):
        """Checks that there is one region for each contact, with its corners on the contact's face to float
        precision."""
        self.assertEqual(len(result.regions), len(result.contacts))
        for contact, region in zip(result.contacts, result.regions):
            a, b, c = mesh.face(contact.face)
            normal = cross(sub(b, a), sub(c, a))
            for corner in region.points:
                p = xyz(corner)
                self.assertLess(abs(dot(sub(p, a), normal)) / length(normal), margin)
                for start, end in ((a, b), (b, c), (c, a)):
                    outward = cross(sub(end, start), normal)
                    self.assertLess(dot(sub(p, start), outward) / length(outward), margin)
