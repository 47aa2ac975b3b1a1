#!/usr/bin/python3
"""The grasper of the examples. Its jaws touch the faces that a naive check of their meshes finds. The planners of
plan.launch take it to the liver's hilum: on its way it touches nothing, as the node and a naive search find at the
poses of TF. The straight way would have touched the liver."""

import os
import sys

from geometry_msgs.msg import Point, Pose, Quaternion
from organ_collision.msg import ContactArray, LinkMotion, OrganMesh, OrganVertices
from organ_collision.srv import QueryCollisionBatch, QueryCollisionBatchRequest
import rospy
import rostest

from support import oracle, scenes
from support.contact_case import xyz
from support.launch_case import LaunchCase, PACKAGE
from support.node_client import LIMIT, ContactLog, Log, wait_until
from support.rigid_mesh import RigidMesh
from support.robot_log import RobotLog
from support.vectors import lerp

LINKS = ['grasper_shaft', 'grasper_wrist', 'grasper_left_jaw', 'grasper_right_jaw']
JAWS = LINKS[2:]
JAW_MESH = RigidMesh.from_stl(os.path.join(PACKAGE, 'urdf/meshes/jaw.stl'))
WANTED, CHECKED = 20, 8  # For each jaw: answers in which it touches, and how many of these are checked.
ON_SURFACE = 1e-4  # [m] tolerance, as the node and TF interpolate differently between transforms
SHAFT_RADIUS, SHAFT_LENGTH = 0.0025, 0.3
WRIST_LENGTH = 0.009  # of its box, whose cross section is 3 x 4 mm and so lies within the shaft's radius
TIP = (0.0, 0.0, 0.029)  # of the closed jaws, in the frame of the wrist
START, TARGET = (0.0, -0.01, 0.06), (0.004, -0.004, -0.017)
LONG = 90.0  # [s] A plan takes a second or two on a machine that does nothing else.


def mesh_of(vertices, triangles):
    return scenes.Mesh(zip(*[iter(vertices)] * 3), list(zip(*[iter(triangles)] * 3)))


class RobotsTest(LaunchCase):
    def setUp(self):
        self.robot, self.log = RobotLog(), ContactLog('/organ_collision/contacts')
        self.addCleanup(self.robot.close)
        self.addCleanup(self.log.subscriber.unregister)

    def pose(self, link, stamp, parent='liver'):
        return self.robot.pose(parent, link, stamp)

    def test_the_jaws_touch_what_their_meshes_touch(self):
        meshes, shapes = (Log('/organ_collision/organ_' + name, kind) for name, kind in (
            ('mesh', OrganMesh), ('vertices', OrganVertices)))

        def is_recorded(answer):
            """Whether this test has received the shapes and poses of the answer's step. The first ones may have been
            sent before this test listened; the last ones may still be on their way."""
            stamps = {m.header.stamp for m in meshes.messages} | {m.header.stamp for m in shapes.messages}
            return ({answer.step_start, answer.mesh_stamp} <= stamps
                    and self.robot.knows('liver', LINKS, answer.step_start, answer.header.stamp))

        def touched(jaw):
            return [a for a in self.log.of('liver', 'grasper') if any(a.links[c.link] == jaw for c in a.contacts)]

        rospy.set_param('/organ_collision/tf_timeout_sec', 20.0)
        self.addCleanup(rospy.delete_param, '/organ_collision/tf_timeout_sec')
        with self.launched('examples/grasper.launch'):
            for jaw in JAWS:
                wait_until(lambda: len(touched(jaw)) >= WANTED and sum(map(is_recorded, touched(jaw))) >= WANTED,
                           'contacts of ' + jaw, LONG)
            self.check_robot('urdf/grasper.urdf')
        vertices = {m.header.stamp: m.vertices for m in meshes.messages + shapes.messages}
        shape = lambda stamp: mesh_of(vertices[stamp], meshes.messages[-1].triangles)

        answers = self.log.messages
        for answer in answers:
            self.assertEqual((answer.tool, answer.organ, answer.links), ('grasper', 'liver', LINKS))
        first = next(i for i, answer in enumerate(answers) if answer.status == ContactArray.OK)
        self.assertEqual([answer.message for answer in answers[first:] if answer.status], [])
        pierced_faces, opened = 0, 0.0
        for jaw in JAWS:
            found = [answer for answer in touched(jaw) if is_recorded(answer)]
            for answer in found[::len(found) // CHECKED]:
                start, end = answer.step_start, answer.header.stamp
                before, after = shape(start), shape(answer.mesh_stamp)
                contacts = [c for c in answer.contacts if answer.links[c.link] == jaw]
                for contact in contacts:  # First touch is on the jaw and on the face.
                    corners = zip(before.face(contact.face), after.face(contact.face))
                    face = [lerp(a, b, contact.fraction) for a, b in corners]
                    self.assert_near(xyz(contact.point), oracle.weighted(face, contact.barycentric), 1e-7, contact)
                    touch = start + rospy.Duration((end - start).to_sec() * contact.fraction)
                    self.assertLess(JAW_MESH.at(self.pose(jaw, touch)).distance(xyz(contact.point)), ON_SURFACE,
                                    contact)
                pierced = JAW_MESH.at(self.pose(jaw, end)).faces_pierced(after)  # None of these is missed.
                self.assertEqual(pierced - {c.face for c in contacts}, set())
                pierced_faces += len(pierced)
                left, right = [self.pose(j, end, 'grasper_wrist').apply((0.0, 0.0, 0.02)) for j in JAWS]
                self.assert_near(right, (-left[0], -left[1], left[2]), 1e-9, 'the right jaw mimics the left one')
                opened = max(opened, left[0])
        self.assertGreater(pierced_faces, 0)
        self.assertGreater(opened, 0.001)

    def has_left(self):
        states = self.robot.states
        return states and states[0].position != states[-1].position

    def has_arrived(self):
        last = [state.position for state in self.robot.states[-20:]]
        return self.has_left() and last == last[:1] * 20

    def way(self):
        """The stamps of the joints from the last ones at rest until the grasper has arrived."""
        states = self.robot.states
        steps = [i for i in range(1, len(states)) if states[i].position != states[i - 1].position]
        stamps = [states[i].header.stamp for i in [steps[0] - 1, *steps]]
        wait_until(lambda: self.robot.knows('liver', LINKS, *stamps), 'all transforms')
        return stamps

    def plan(self, planner):
        with self.launched('examples/plan.launch', 'planner:=' + planner) as launched:
            for event in (self.has_left, self.has_arrived):
                wait_until(lambda: launched.process.poll() is not None or event(), event.__name__, LONG)
            stamps = self.way()
            self.assertGreater(len(stamps), 300)
            # TF may lack single states: it interpolates between those around it, which are the same at rest.
            rests = [next(stamp for stamp in (state.header.stamp for state in states)
                          if self.robot.knows('liver', LINKS, stamp))
                     for states in (self.robot.states, self.robot.states[-20:])]
            ends = [self.pose('grasper_wrist', stamp).apply(TIP) for stamp in rests]
            for found, expected in zip(ends, (START, TARGET)):
                self.assert_near(found, expected, 1e-6, 'the ends of the way')
            self.assert_nothing_is_touched(stamps)
            mesh = rospy.wait_for_message('/organ_collision/organ_mesh', OrganMesh, LIMIT)
        self.assertIn('from the liver', launched.printed)
        return stamps, mesh_of(mesh.vertices, mesh.triangles)

    def assert_nothing_is_touched(self, stamps):
        """Neither at the poses of TF, nor in a step between them."""
        service = rospy.ServiceProxy('/organ_collision/query_batch', QueryCollisionBatch)
        request = QueryCollisionBatchRequest(organ='liver', tool='grasper', mode=ContactArray.STATIC)
        request.header.frame_id = 'liver'
        for first in range(0, len(stamps), 500):
            part = stamps[first:first + 500]
            poses = [[self.pose(link, stamp) for link in LINKS] for stamp in part]
            request.link_motions = [LinkMotion(links=[Pose(Point(*p.translation), Quaternion(*p.rotation))
                                                      for p in links])
                                    for links in poses]
            answer = service(request)
            self.assertEqual((answer.status, answer.message, len(answer.results)), (ContactArray.OK, '', len(part)))
            self.assertEqual([(result.status, result.contacts) for result in answer.results], [(0, [])] * len(part))
        steps = self.log.of('liver', 'grasper', status=ContactArray.OK, mode=ContactArray.SWEPT)
        self.assertGreater(len(steps), 100)
        self.assertEqual([step.contacts for step in steps if step.contacts], [])

    def test_the_planner_in_cpp(self):
        self.plan('plan_grasper')
        with self.launched('examples/plan.launch', 'planner:=plan_grasper', 'target:=[0.0, 0.0, 1.0]',
                           ends_itself=True) as launched:
            wait_until(lambda: launched.process.poll() is not None, 'the end of the planner', LONG)
        self.assertIn('the tip cannot be at (0, 0, 1) without touching the liver', launched.printed)

    def test_the_planner_in_python(self):
        stamps, liver = self.plan('plan_grasper.py')
        for stamp in stamps[::len(stamps) // 5] + stamps[-1:]:
            for link, height in (('grasper_shaft', -SHAFT_LENGTH), ('grasper_wrist', WRIST_LENGTH)):
                pose = self.pose(link, stamp)
                axis = pose.apply((0.0, 0.0, height)), pose.apply((0.0, 0.0, 0.0))
                self.assertEqual(oracle.static_contacts(liver, axis, SHAFT_RADIUS), [])
            for jaw in JAWS:
                self.assertEqual(JAW_MESH.at(self.pose(jaw, stamp)).faces_pierced(liver), set())
        trocar = self.pose('grasper_trocar', stamps[0]).translation
        straight = [(tuple(trocar), lerp(START, TARGET, part / 10.0)) for part in range(1, 10)]
        self.assertTrue(any(oracle.static_contacts(liver, axis, SHAFT_RADIUS) for axis in straight))


if __name__ == '__main__':
    rospy.init_node('robots_test')
    rostest.rosrun('organ_collision', 'robots', RobotsTest, sys.argv)
