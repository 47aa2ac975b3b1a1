#!/usr/bin/python3
"""Messages from arrays have the same bytes as messages from lists."""

import io
import unittest

import numpy as np
import rospy

from organ_collision import organ_mesh, organ_vertices, shaft_motion
from organ_collision.msg import OrganMesh, OrganVertices

RANDOM = np.random.default_rng(13)
VERTICES = RANDOM.normal(size=(50, 3))
FACES = RANDOM.integers(0, 50, (80, 3))


def serialized(message):
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


class MessagesTest(unittest.TestCase):

    def test_a_mesh_has_the_bytes_of_one_from_lists(self):
        made = organ_mesh('liver', VERTICES, FACES, 'camera', 7, rospy.Time(3, 4))
        listed = OrganMesh(organ='liver', topology=7, vertices=np.float32(VERTICES).ravel().tolist(),
                           triangles=FACES.ravel().tolist())
        listed.header.frame_id, listed.header.stamp = 'camera', rospy.Time(3, 4)
        self.assertEqual(serialized(made), serialized(listed))
        self.assertIsInstance(made, OrganMesh)

    def test_vertices_have_the_bytes_of_some_from_lists(self):
        made = organ_vertices('liver', VERTICES, topology=7)
        listed = OrganVertices(organ='liver', topology=7, vertices=np.float32(VERTICES).ravel().tolist())
        listed.header.frame_id = 'liver'
        self.assertEqual(serialized(made), serialized(listed))
        self.assertIsInstance(made, OrganVertices)

    def test_the_frame_is_named_after_the_organ_and_the_stamp_is_zero(self):
        header = organ_mesh('liver', VERTICES, FACES).header
        self.assertEqual((header.frame_id, header.stamp), ('liver', rospy.Time()))

    def test_a_mesh_that_refers_to_a_missing_vertex_is_refused(self):
        with self.assertRaisesRegex(ValueError, 'there are 49 vertices'):
            organ_mesh('liver', VERTICES[:49], [[0, 1, 49]])

    def test_a_shaft_that_moves(self):
        motion = shaft_motion(np.array([1, 2, 3]), [4, 5, 6], 0.005, [7, 8, 9], (10, 11, 12))
        self.assertEqual((motion.trocar.x, motion.tip.y, motion.previous_trocar.z, motion.previous_tip.x),
                         (1, 5, 9, 10))
        self.assertEqual(motion.radius, 0.005)
        serialized(motion)

    def test_an_end_without_previous_place_rests(self):
        motion = shaft_motion([1, 2, 3], [4, 5, 6], 0.005, previous_tip=[7, 8, 9])
        self.assertEqual(motion.previous_trocar, motion.trocar)
        self.assertEqual(motion.previous_tip.x, 7)


if __name__ == '__main__':
    unittest.main(verbosity=2)
