#!/usr/bin/python3
"""The grasper example. Answers are about all of its links, and its jaws touch the faces that a
naive check of their meshes finds."""

import os
import sys

from organ_collision.msg import ContactArray, OrganMesh, OrganVertices
import roslib.packages
import rospy
import rostest
from tf2_msgs.msg import TFMessage
import tf2_ros

from support import oracle, scenes
from support.contact_case import ContactCase, xyz
from support.node_client import ContactLog, wait_until
from support.rigid_mesh import RigidMesh
from support.vectors import lerp

LINKS = ['grasper_shaft', 'grasper_wrist', 'grasper_left_jaw', 'grasper_right_jaw']
JAWS = LINKS[2:]
JAW_MESH = RigidMesh.from_stl(
    os.path.join(roslib.packages.get_pkg_dir('organ_collision'), 'urdf/meshes/jaw.stl')
)
JAW_TIP = (0.0, 0.0, 0.02)
ANSWERS_WANTED = 20  # for each jaw: answers in which it touches
ANSWERS_CHECKED = 10  # how many of these are checked
ON_SURFACE = 1e-4  # [m] tolerance, as the node and TF interpolate differently between transforms


class ShapeLog:
    """All shapes of the organ, by stamp."""

    def __init__(self):
        self.triangles, self.vertices = [], {}
        self.subscribers = [
            rospy.Subscriber('/organ_collision/organ_mesh', OrganMesh, self._add_mesh),
            rospy.Subscriber('/organ_collision/organ_vertices', OrganVertices, self._add),
        ]

    def _add_mesh(self, mesh):
        self.triangles = list(zip(*[iter(mesh.triangles)] * 3))
        self._add(mesh)

    def _add(self, shape):
        self.vertices[shape.header.stamp] = shape.vertices

    def at(self, stamp):
        return scenes.Mesh(zip(*[iter(self.vertices[stamp])] * 3), self.triangles)


class GrasperTest(ContactCase):
    @classmethod
    def setUpClass(cls):
        """Records until both jaws have touched often enough."""
        cls.transforms = tf2_ros.Buffer(rospy.Duration(100.0))
        # On a busy machine, a tf2_ros.TransformListener would drop messages.
        listeners = [
            rospy.Subscriber('/tf', TFMessage, cls.add_transforms),
            rospy.Subscriber('/tf_static', TFMessage, cls.add_transforms, True),
        ]
        cls.shapes = ShapeLog()
        log = ContactLog('/organ_collision/contacts')

        def touched(jaw):
            return [
                answer
                for answer in log.of('liver', 'grasper')
                if any(answer.links[c.link] == jaw for c in answer.contacts)
                and cls.is_recorded(answer)
            ]

        for jaw in JAWS:
            wait_until(lambda: len(touched(jaw)) >= ANSWERS_WANTED, 'contacts of ' + jaw, 60.0)
        log.subscriber.unregister()
        cls.answers = log.messages
        for subscriber in [*listeners, *cls.shapes.subscribers]:
            subscriber.unregister()
        cls.checked = [
            (jaw, answer)
            for jaw in JAWS
            for answer in touched(jaw)[:: len(touched(jaw)) // ANSWERS_CHECKED]
        ]

    @classmethod
    def add_transforms(cls, message, resting=False):
        add = cls.transforms.set_transform_static if resting else cls.transforms.set_transform
        for transform in message.transforms:
            add(transform, 'test')

    @classmethod
    def is_recorded(cls, answer):
        """Whether this test has received the shapes and poses of the answer's step. The first ones
        may have been sent before this test listened; the last ones may still be on their way."""
        return {answer.step_start, answer.mesh_stamp} <= cls.shapes.vertices.keys() and all(
            cls.transforms.can_transform('liver', link, time)
            for link in LINKS
            for time in (answer.step_start, answer.header.stamp)
        )

    def pose(self, frame, time, parent='liver'):
        transform = self.transforms.lookup_transform(parent, frame, time).transform
        rotation = transform.rotation
        return scenes.Pose(
            (rotation.x, rotation.y, rotation.z, rotation.w), xyz(transform.translation)
        )

    def test_each_answer_is_about_the_four_links(self):
        for answer in self.answers:
            self.assertEqual((answer.tool, answer.organ), ('grasper', 'liver'))
            self.assertEqual(answer.links, LINKS)
            for contact in answer.contacts:
                self.assertLess(contact.link, len(LINKS))

    def test_all_goes_well_after_the_first_transforms(self):
        statuses = [answer.status for answer in self.answers]
        first = statuses.index(ContactArray.OK)
        failed = [answer.message for answer in self.answers[first:] if answer.status]
        self.assertEqual(failed, [])

    def test_right_jaw_mimics_the_left_one(self):
        opened = set()
        for _, answer in self.checked:
            left, right = [
                self.pose(jaw, answer.header.stamp, 'grasper_wrist').apply(JAW_TIP) for jaw in JAWS
            ]
            self.assert_near(right, (-left[0], -left[1], left[2]), 1e-9, 'tip of the right jaw')
            opened.add(left[0])
        self.assertGreater(max(opened), 0.001)

    def test_first_touch_is_on_the_jaw_and_on_the_face(self):
        for jaw, answer in self.checked:
            start, end = answer.step_start, answer.header.stamp
            before, after = self.shapes.at(start), self.shapes.at(end)
            for contact in answer.contacts:
                if answer.links[contact.link] != jaw:
                    continue
                what = '%s on face %d at %s' % (jaw, contact.face, end)
                corners = zip(before.face(contact.face), after.face(contact.face))
                face = [lerp(a, b, contact.fraction) for a, b in corners]
                on_face = oracle.weighted(face, contact.barycentric)
                self.assert_near(xyz(contact.point), on_face, 1e-7, what)
                touch = start + rospy.Duration((end - start).to_sec() * contact.fraction)
                mesh = JAW_MESH.at(self.pose(jaw, touch))
                self.assertLess(mesh.distance(xyz(contact.point)), ON_SURFACE, what)

    def test_no_face_that_a_jaw_goes_through_is_missed(self):
        found = 0
        for jaw, answer in self.checked:
            mesh = JAW_MESH.at(self.pose(jaw, answer.header.stamp))
            pierced = mesh.faces_pierced(self.shapes.at(answer.mesh_stamp))
            touched = {c.face for c in answer.contacts if answer.links[c.link] == jaw}
            self.assertEqual(pierced - touched, set(), '%s at %s' % (jaw, answer.header.stamp))
            found += len(pierced)
        self.assertGreater(found, 0)


if __name__ == '__main__':
    rospy.init_node('grasper_test')
    rostest.rosrun('organ_collision', 'grasper', GrasperTest, sys.argv)
