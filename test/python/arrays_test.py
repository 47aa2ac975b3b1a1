#!/usr/bin/python3
"""From arrays to messages. Arrays of the wrong shape, type or value are refused with what is legal; legal ones are
copied. Messages from arrays have the same bytes as messages from lists."""

import io
import unittest

import numpy as np
import rospy

import organ_collision
from organ_collision import link_motions, Organ, organ_mesh, organ_vertices, shaft_motion, shaft_motions
from organ_collision.arrays import face_array, points_array, poses_array, vertex_array
from organ_collision.msg import OrganMesh, OrganVertices

RANDOM = np.random.default_rng(13)
POINTS = [[0.1, 0.2, 0.3], [1.5, -2.0, 4.0], [0.7, 0.1, -0.9], [3.0, 2.0, 1.0]]
FACES = [[0, 1, 2], [3, 2, 1]]
NONE = np.empty((0, 3), int)


def serialized(message):
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


def matrix(x, y, z, w):
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def poses(motions, links):
    """Random poses, some of them half turns, as numbers and as matrices."""
    numbers = RANDOM.normal(size=(motions, links, 7))
    numbers[0, :, 6] = 0
    numbers[1, :, 3:5] = 0
    numbers[:, :, 3:] /= np.linalg.norm(numbers[:, :, 3:], axis=2, keepdims=True)
    matrices = np.zeros((motions, links, 4, 4))
    matrices[..., 3, 3] = 1
    matrices[..., :3, 3] = numbers[..., :3]
    for place in np.ndindex(motions, links):
        matrices[place][:3, :3] = matrix(*numbers[place][3:])
    return numbers, matrices


def changed(array, place, value):
    array = np.array(array, dtype=float)
    array[place] = value
    return array


class ArraysTest(unittest.TestCase):
    def test_legal_ones_become_copies_of_32_bits(self):
        for given in (POINTS, np.array(POINTS), np.asfortranarray(POINTS), np.array(POINTS, np.float32)):
            array = vertex_array(given)
            self.assertEqual((array.dtype, array.flags.c_contiguous), (np.float32, True))
            np.testing.assert_array_equal(array, np.array(POINTS, np.float32))
        for given in (FACES, np.array(FACES, np.int64)):
            array = face_array(given, 4)
            self.assertEqual(array.dtype, np.uint32)
            np.testing.assert_array_equal(array, FACES)
        self.assertEqual(face_array(np.empty((0, 3)), 0).shape, (0, 3))
        np.testing.assert_array_equal(points_array(POINTS, 'tips'), POINTS)
        vertices, faces = np.array(POINTS, np.float32), np.array(FACES, np.uint32)
        kept = vertex_array(vertices), face_array(faces, 4)
        vertices += 1
        faces += 1
        np.testing.assert_array_equal(kept[0], np.array(POINTS, np.float32))
        np.testing.assert_array_equal(kept[1], FACES)

    def test_illegal_ones_are_refused(self):
        numbers, matrices = poses(3, 2)
        mirrored = matrices.copy()
        mirrored[1, 0, :3, :3] *= -1
        finite = r'vertices\[2\] is \[0.7, .*, -0.9\]; coordinates must be finite'
        of_poses, no_matrix = 'links .* must be k x l x 7', r'links\[2, 1\] is no matrix'
        for reason, function, *arguments in [
                (r'vertices has the shape \(12,\); it must be n x 3', vertex_array, np.ravel(POINTS)),
                (r'shape \(4, 2\)', vertex_array, np.array(POINTS)[:, :2]),
                ('rows of equal length', vertex_array, [[0, 1, 2], [3, 4]]),
                ('no array of numbers', vertex_array, [['a', 'b', 'c']]),
                (finite, vertex_array, changed(POINTS, (2, 1), np.nan)),
                (finite, vertex_array, changed(POINTS, (2, 1), 1e39)),
                (r'faces\[1\] is \[1, 2, 4\]; there are 4 vertices, counted from 0', face_array, [[0, 1, 2], [1, 2, 4]], 4),
                (r'faces\[0\] is \[0, -1, 2\]', face_array, [[0, -1, 2]], 4),
                (r'faces has the shape \(6,\); it must be m x 3', face_array, [0, 1, 2, 3, 2, 1], 4),
                ('type float64; vertex indices must be integers', face_array, [[0.0, 1.0, 2.0]], 4),
                (r'tips has the shape \(3,\); it must be k x 3', points_array, POINTS[0], 'tips'),
                (of_poses, poses_array, numbers[0], 'links'),
                (of_poses, poses_array, numbers[..., :6], 'links'),
                (of_poses, poses_array, matrices[..., :3, :], 'links'),
                (no_matrix, poses_array, changed(matrices, (2, 1, 0, 0), 3.0), 'links'),
                (no_matrix, poses_array, changed(matrices, (2, 1, 3, 0), 0.5), 'links'),
                (no_matrix, poses_array, changed(matrices, (2, 1, 2, 2), np.nan), 'links'),
                (r'links\[1, 0\] is no matrix', poses_array, mirrored, 'links'),
                ('4 poses of links and 3 previous', link_motions, poses(4, 2)[0], numbers),
                ('5 trocars, 4 tips', shaft_motions, np.zeros((5, 3)), POINTS, 0.0),
                ('there are 4 vertices', organ_mesh, 'liver', POINTS, [[0, 1, 4]]),
                ('faces is empty, but there are 4 vertices', organ_mesh, 'liver', POINTS, NONE),
                ('faces is empty, but there are 4 vertices', Organ, 'liver', POINTS, NONE),
                (r'faces has the shape \(0,\)', Organ, 'liver', POINTS, []),
                ('liver has no faces; an organ has at least one', Organ, 'liver', NONE, NONE),
                ('topology is -1; must be a whole number from 0', organ_mesh, 'liver', POINTS, FACES, None, -1),
                ('topology is 1.0; must be a whole number', organ_vertices, 'liver', POINTS, None, 1.0),
                ('stamp is 1.5; must be a rospy.Time', organ_mesh, 'liver', POINTS, FACES, None, 0, 1.5),
                ('vertices has masked values', vertex_array,
                 list(np.ma.masked_greater(np.array(POINTS, float), 0.5))),
                ('vertices has masked values', vertex_array, np.ma.masked_greater(np.array(POINTS, float), 0.5))]:
            with self.subTest(reason=reason):
                with self.assertRaisesRegex(ValueError, reason):
                    function(*arguments)


class ModuleTest(unittest.TestCase):
    def test_a_star_imports_every_name(self):
        names = {}
        exec('from organ_collision import *', names)
        self.assertEqual(set(names) - {'__builtins__'}, set(organ_collision._MODULES))
        self.assertEqual([name for name in organ_collision._MODULES
                          if names[name] is not getattr(organ_collision, name)], [])


class MessagesTest(unittest.TestCase):
    def test_organs_have_the_bytes_of_those_from_lists(self):
        """The frame is named after the organ and the stamp is zero, unless they are given."""
        vertices, triangles = np.float32(POINTS).ravel().tolist(), np.ravel(FACES).tolist()
        mesh = OrganMesh(organ='liver', topology=7, vertices=vertices, triangles=triangles)
        mesh.header.frame_id, mesh.header.stamp = 'camera', rospy.Time(3, 4)
        shape = OrganVertices(organ='liver', topology=7, vertices=vertices)
        shape.header.frame_id = 'liver'
        for made, listed in ((organ_mesh('liver', POINTS, FACES, 'camera', 7, rospy.Time(3, 4)), mesh),
                             (organ_vertices('liver', POINTS, topology=7), shape)):
            self.assertIsInstance(made, type(listed))
            self.assertEqual(serialized(made), serialized(listed))
        header = organ_mesh('liver', POINTS, FACES).header
        self.assertEqual((header.frame_id, header.stamp), ('liver', rospy.Time()))

    def test_a_shaft_that_moves(self):
        """An end without previous place rests."""
        motion = shaft_motion(np.array([1, 2, 3]), [4, 5, 6], 0.005, [7, 8, 9], (10, 11, 12))
        self.assertEqual((motion.trocar.x, motion.tip.y, motion.previous_trocar.z, motion.previous_tip.x),
                         (1, 5, 9, 10))
        self.assertEqual(motion.radius, 0.005)
        serialized(motion)
        motion = shaft_motion([1, 2, 3], [4, 5, 6], 0.005, previous_tip=[7, 8, 9])
        self.assertEqual((motion.previous_trocar, motion.previous_tip.x), (motion.trocar, 7))
        motions = shaft_motions(POINTS, np.add(POINTS, 1), 0.0)
        self.assertEqual((len(motions), motions[3].tip.z, motions[3].radius), (4, 2.0, 0.0))

    def test_links_that_move(self):
        ends, starts = poses(4, 2)[0], poses(4, 2)[0]
        motions = link_motions(ends, starts)
        pose = motions[3].links[1]
        self.assertEqual([pose.position.x, pose.position.y, pose.position.z, pose.orientation.x, pose.orientation.y,
                          pose.orientation.z, pose.orientation.w], ends[3, 1].tolist())
        self.assertEqual((len(motions), motions[2].previous[0].position.y), (4, starts[2, 0, 1]))
        self.assertEqual(link_motions(ends)[0].previous, [])


if __name__ == '__main__':
    unittest.main(verbosity=2)
