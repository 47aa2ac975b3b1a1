#!/usr/bin/python3
"""The vertex forces alone move the tissue of finite elements: it yields under the probe, and comes back. What its nodes are
given is minus the wrench, times the duration of a step."""

import sys
import unittest

from geometry_msgs.msg import WrenchStamped
import numpy
from organ_collision.msg import OrganMesh, OrganVertices, VertexForces
import rospy
import rostest

STEP = 0.004  # [s] in src/demo/fem_tissue.cpp
LIMIT = 90.0  # [s]


def vector(v):
    return numpy.array([v.x, v.y, v.z])


class Log:
    """The messages of a topic by their stamps [ns]."""

    def __init__(self, topic, message_type):
        self.messages = {}
        self.subscriber = rospy.Subscriber(topic, message_type, self.keep, tcp_nodelay=True)

    def keep(self, message):
        self.messages[message.header.stamp.to_nsec()] = message

    def of(self, *others):
        """The stamps that this log and the others have."""
        return sorted(set(list(self.messages)).intersection(*[list(other.messages) for other in others]))


class FemTissueTest(unittest.TestCase):

    def setUp(self):
        self.wrenches = Log('/contact_adapter/tissue/probe/wrench', WrenchStamped)
        self.forces = Log('/contact_adapter/tissue/probe/vertex_forces', VertexForces)
        self.impulses = Log('/fem_tissue/impulse', WrenchStamped)
        self.shapes = Log('/organ_collision/organ_vertices', OrganVertices)
        rest = rospy.wait_for_message('/organ_collision/organ_mesh', OrganMesh, LIMIT)
        self.rest = numpy.array(rest.vertices).reshape(-1, 3)

    def places(self, stamp):
        """The positions of all vertices [m]."""
        return numpy.array(self.shapes.messages[stamp].vertices).reshape(-1, 3)

    def depth(self, stamp):
        """The depth of the dent [m]."""
        moved = self.rest - self.places(stamp)
        self.assertTrue(numpy.isfinite(moved).all())
        return moved[:, 2].max()

    def wait_for_a_dent_that_came_back(self):
        """Returns the largest depth of the dent [m], and the depth after it had come back."""
        deepest, seen, give_up = 0.0, set(), rospy.get_time() + LIMIT
        while rospy.get_time() < give_up:
            for stamp in self.shapes.of(self.impulses):
                if stamp in seen:
                    continue
                seen.add(stamp)
                depth = self.depth(stamp)
                deepest = max(deepest, depth)
                if deepest > 0.002 and depth < 0.0002:
                    return deepest, depth
            rospy.sleep(0.05)
        self.fail('waited for a dent that comes back; the largest is %g m' % deepest)

    def test_tissue_yields_and_comes_back_and_takes_minus_the_wrench(self):
        deepest, _ = self.wait_for_a_dent_that_came_back()
        self.assertLess(deepest, 0.013)  # The probe's surface goes down to 13 mm below the tissue at rest.

        stamps, strongest = self.impulses.of(self.wrenches, self.forces, self.shapes), 0.0
        self.assertGreater(len(stamps), 100)
        for stamp in stamps:
            wrench, impulse = self.wrenches.messages[stamp].wrench, self.impulses.messages[stamp].wrench
            force, torque = vector(wrench.force), vector(wrench.torque)
            strongest = max(strongest, numpy.linalg.norm(force))
            # [N s], [N m s] Bullet computes with 32-bit floats.
            rounding = STEP * (1e-8 + 1e-5 * numpy.linalg.norm(force))
            self.assertLess(numpy.abs(vector(impulse.force) + STEP * force).max(), rounding, stamp)
            self.assertLess(numpy.abs(vector(impulse.torque) + STEP * torque).max(), rounding, stamp)
            self.check_vertex_forces(stamp, force, torque)
        self.assertGreater(strongest, 0.3)

    def check_vertex_forces(self, stamp, force, torque):
        """Their sum and their torque are minus the wrench's, up to rounding."""
        message = self.forces.messages[stamp]
        self.assertEqual(list(message.vertices), sorted(set(message.vertices)))
        self.assertEqual((message.organ, message.tool, message.topology), ('tissue', 'probe', 0))
        places = self.places(stamp)[list(message.vertices)]
        forces = numpy.array([vector(f) for f in message.forces]).reshape(-1, 3)
        self.assertLess(numpy.abs(forces.sum(axis=0) + force).max(), 1e-9)
        self.assertLess(numpy.abs(numpy.cross(places, forces).sum(axis=0) + torque).max(), 1e-9)


if __name__ == '__main__':
    rospy.init_node('fem_tissue_test')
    rostest.rosrun('organ_collision', 'fem_tissue_forces', FemTissueTest, sys.argv)
