#!/usr/bin/python3
"""The planners of plan.launch take the grasper to the liver's hilum. On its way it touches nothing, as the node and a
naive search find at the poses of TF. The straight way would have touched the liver."""

import os
import sys

from geometry_msgs.msg import Point, Pose, Quaternion
from organ_collision.msg import ContactArray, LinkMotion, OrganMesh
from organ_collision.srv import QueryCollisionBatch, QueryCollisionBatchRequest
import roslib.packages
import rospy
import rostest
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage
import tf2_ros

from support import oracle, scenes
from support.contact_case import ContactCase, xyz
from support.launched import Launched
from support.node_client import LIMIT, ContactLog, wait_until
from support.rigid_mesh import RigidMesh
from support.vectors import length, lerp, sub

PACKAGE = roslib.packages.get_pkg_dir('organ_collision')
LINKS = ['grasper_shaft', 'grasper_wrist', 'grasper_left_jaw', 'grasper_right_jaw']
JAW_MESH = RigidMesh.from_stl(os.path.join(PACKAGE, 'urdf/meshes/jaw.stl'))
SHAFT_RADIUS, SHAFT_LENGTH = 0.0025, 0.3
WRIST_LENGTH = 0.009  # of its box, whose cross section is 3 x 4 mm and so lies within the shaft's radius
TIP = (0.0, 0.0, 0.029)  # of the closed jaws, in the frame of the wrist
START, TARGET = (0.0, -0.01, 0.06), (0.004, -0.004, -0.017)
NAIVELY_CHECKED = 6  # poses
LONGEST = 60.0  # [s] A plan takes a second or two on a machine that does nothing else.


class Robot:
    """The joints and the poses of all links since the start, from the topics of the grasper."""

    def __init__(self):
        self.states = []
        self.transforms = tf2_ros.Buffer(rospy.Duration(1000.0))
        self.subscribers = [
            rospy.Subscriber('/tf', TFMessage, self.add, queue_size=10000),
            rospy.Subscriber('/tf_static', TFMessage, self.add_resting, queue_size=100),
            rospy.Subscriber('/joint_states', JointState, self.states.append, queue_size=10000),
        ]

    def add(self, message):
        for transform in message.transforms:
            self.transforms.set_transform(transform, 'test')

    def add_resting(self, message):
        for transform in message.transforms:
            self.transforms.set_transform_static(transform, 'test')

    def close(self):
        for subscriber in self.subscribers:
            subscriber.unregister()

    def has_left(self):
        return self.states and self.states[0].position != self.states[-1].position

    def has_arrived(self):
        last = [state.position for state in self.states[-20:]]
        return self.has_left() and last == last[:1] * 20

    def way(self):
        """The stamps of the joints from the last ones at rest until the grasper has arrived."""
        states = self.states
        steps = [i for i in range(1, len(states)) if states[i].position != states[i - 1].position]
        stamps = [states[i].header.stamp for i in [steps[0] - 1, *steps]]
        wait_until(lambda: all(self.knows(stamp) for stamp in stamps), 'all transforms')
        return stamps

    def rests(self):
        """A stamp before the grasper has left, and one after it has arrived. TF may lack single states: it interpolates
        between those around it, which are the same at rest."""
        last = self.states[-1].header.stamp
        wait_until(lambda: self.knows(last), 'the last transforms')
        return next(state.header.stamp for state in self.states if self.knows(state.header.stamp)), last

    def knows(self, stamp):
        return all(self.transforms.can_transform('liver', link, stamp) for link in LINKS)

    def pose(self, link, stamp):
        transform = self.transforms.lookup_transform('liver', link, stamp).transform
        r = transform.rotation
        return scenes.Pose((r.x, r.y, r.z, r.w), xyz(transform.translation))

    def message(self, stamp):
        """The poses of the links, for the node."""
        poses = [self.pose(link, stamp) for link in LINKS]
        return [Pose(Point(*pose.translation), Quaternion(*pose.rotation)) for pose in poses]


class PlanTest(ContactCase):
    def check(self, planner):
        robot = Robot()
        self.addCleanup(robot.close)
        log = ContactLog('/organ_collision/contacts')
        self.addCleanup(log.subscriber.unregister)
        with Launched(os.path.join(PACKAGE, 'examples', 'plan.launch'), 'planner:=' + planner) as launched:
            for event in (robot.has_left, robot.has_arrived):
                wait_until(
                    lambda: launched.process.poll() is not None or event(), event.__name__, LONGEST
                )
            stamps = robot.way()
            self.assert_it_goes_to_the_target(robot, stamps)
            self.assert_nothing_is_touched(robot, stamps, log)
            mesh = rospy.wait_for_message('/organ_collision/organ_mesh', OrganMesh, LIMIT)
            liver = scenes.Mesh(zip(*[iter(mesh.vertices)] * 3), list(zip(*[iter(mesh.triangles)] * 3)))
            self.assert_a_naive_search_finds_nothing(robot, stamps, liver)
            self.assert_the_straight_way_touches(robot, stamps, liver)
        self.assertIn('from the liver', launched.printed)

    def assert_it_goes_to_the_target(self, robot, stamps):
        self.assertGreater(len(stamps), 300)
        start, end = robot.rests()
        self.assert_near(robot.pose('grasper_wrist', start).apply(TIP), START, 1e-6, 'start')
        self.assert_near(robot.pose('grasper_wrist', end).apply(TIP), TARGET, 1e-6, 'target')

    def assert_nothing_is_touched(self, robot, stamps, log):
        """Neither at the poses of TF, nor in a step between them."""
        service = rospy.ServiceProxy('/organ_collision/query_batch', QueryCollisionBatch)
        request = QueryCollisionBatchRequest(organ='liver', tool='grasper', mode=ContactArray.STATIC)
        request.header.frame_id = 'liver'
        for first in range(0, len(stamps), 500):
            part = stamps[first:first + 500]
            request.link_motions = [LinkMotion(links=robot.message(stamp)) for stamp in part]
            answer = service(request)
            self.assertEqual((answer.status, answer.message), (ContactArray.OK, ''))
            self.assertEqual(len(answer.results), len(part))
            for result in answer.results:
                self.assert_ok(result)
                self.assertEqual(result.contacts, [])
        steps = [m for m in log.of('liver', 'grasper', status=ContactArray.OK) if m.mode == ContactArray.SWEPT]
        self.assertGreater(len(steps), 100)
        self.assertEqual([step.contacts for step in steps if step.contacts], [])

    def assert_a_naive_search_finds_nothing(self, robot, stamps, liver):
        for stamp in stamps[::len(stamps) // NAIVELY_CHECKED] + stamps[-1:]:
            self.assertEqual(self.touched_by_cylinder(robot.pose('grasper_shaft', stamp), -SHAFT_LENGTH, liver), [])
            self.assertEqual(self.touched_by_cylinder(robot.pose('grasper_wrist', stamp), WRIST_LENGTH, liver), [])
            for jaw in LINKS[2:]:
                self.assertEqual(JAW_MESH.at(robot.pose(jaw, stamp)).faces_pierced(liver), set())

    def touched_by_cylinder(self, pose, height, liver):
        """The faces that a capsule touches which goes from the origin of a link along its z axis."""
        axis = pose.apply((0.0, 0.0, height)), pose.apply((0.0, 0.0, 0.0))
        return oracle.static_contacts(liver, axis, SHAFT_RADIUS)

    def assert_the_straight_way_touches(self, robot, stamps, liver):
        """The tip alone, on the straight line to the target, would go through the liver."""
        ends = [robot.pose('grasper_wrist', stamp).apply(TIP) for stamp in (stamps[0], stamps[-1])]
        trocar = robot.transforms.lookup_transform('liver', 'grasper_trocar', stamps[0]).transform.translation
        touched = [
            oracle.static_contacts(liver, (xyz(trocar), lerp(*ends, part / 10.0)), SHAFT_RADIUS)
            for part in range(1, 10)
        ]
        self.assertTrue(any(touched))
        self.assertGreater(length(sub(*ends)), 0.05)

    def check_unreachable(self, planner):
        words = ['planner:=' + planner, 'target:=[0.0, 0.0, 1.0]']
        with Launched(os.path.join(PACKAGE, 'examples', 'plan.launch'), *words) as launched:
            wait_until(lambda: launched.process.poll() is not None, 'the end of the planner', LONGEST)
        self.assertIn('the tip cannot be at (0, 0, 1) without touching the liver', launched.printed)

    def test_targets_that_cannot_be_reached(self):
        self.check_unreachable('plan_grasper.py')
        self.check_unreachable('plan_grasper')

    def test_the_planner_in_python(self):
        self.check('plan_grasper.py')

    def test_the_planner_in_cpp(self):
        self.check('plan_grasper')


if __name__ == '__main__':
    rospy.init_node('plan_test')
    rostest.rosrun('organ_collision', 'plan', PlanTest, sys.argv)
