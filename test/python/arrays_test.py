#!/usr/bin/python3
"""Arrays of the wrong shape, type or value are refused with what is legal; legal ones are copied."""

import unittest

import numpy as np

from organ_collision.arrays import face_array, points_array, vertex_array

POINTS = [[0.1, 0.2, 0.3], [1.5, -2.0, 4.0], [0.7, 0.1, -0.9], [3.0, 2.0, 1.0]]


class ArraysTest(unittest.TestCase):

    def test_vertices_become_32_bit_floats(self):
        for given in (POINTS, np.array(POINTS), np.asfortranarray(POINTS), np.array(POINTS, np.float32)):
            array = vertex_array(given)
            self.assertEqual(array.dtype, np.float32)
            self.assertTrue(array.flags.c_contiguous)
            np.testing.assert_array_equal(array, np.array(POINTS, np.float32))

    def test_arrays_are_copies(self):
        vertices, faces = np.array(POINTS, np.float32), np.array([[0, 1, 2]], np.uint32)
        kept = vertex_array(vertices), face_array(faces, 4)
        vertices += 1
        faces += 1
        np.testing.assert_array_equal(kept[0], np.array(POINTS, np.float32))
        np.testing.assert_array_equal(kept[1], [[0, 1, 2]])

    def test_faces_become_32_bit_indices(self):
        for given in ([[0, 1, 2], [3, 2, 1]], np.array([[0, 1, 2], [3, 2, 1]], np.int64)):
            array = face_array(given, 4)
            self.assertEqual(array.dtype, np.uint32)
            np.testing.assert_array_equal(array, [[0, 1, 2], [3, 2, 1]])
        self.assertEqual(face_array(np.empty((0, 3)), 0).shape, (0, 3))

    def test_illegal_ones_are_refused(self):
        def with_value(value):
            points = np.array(POINTS)
            points[2, 1] = value
            return points

        np.testing.assert_array_equal(points_array(POINTS, 'tips'), POINTS)
        finite = r'vertices\[2\] is \[0.7, .*, -0.9\]; coordinates must be finite'
        for reason, function, *arguments in [
                (r'vertices has the shape \(12,\); it must be n x 3', vertex_array, np.ravel(POINTS)),
                (r'shape \(4, 2\)', vertex_array, np.array(POINTS)[:, :2]),
                ('rows of equal length', vertex_array, [[0, 1, 2], [3, 4]]),
                ('no array of numbers', vertex_array, [['a', 'b', 'c']]),
                ('no array of numbers', vertex_array, None),
                (finite, vertex_array, with_value(np.nan)),
                (finite, vertex_array, with_value(-np.inf)),
                (finite, vertex_array, with_value(1e39)),
                (r'faces\[1\] is \[1, 2, 4\]; there are 4 vertices, counted from 0', face_array, [[0, 1, 2], [1, 2, 4]], 4),
                (r'faces\[0\] is \[0, -1, 2\]', face_array, [[0, -1, 2]], 4),
                (r'faces has the shape \(6,\); it must be m x 3', face_array, [0, 1, 2, 3, 2, 1], 4),
                (r'shape \(1, 4\)', face_array, [[0, 1, 2, 3]], 4),
                ('type float64; vertex indices must be integers', face_array, [[0.0, 1.0, 2.0]], 4),
                (r'tips has the shape \(3,\); it must be k x 3', points_array, POINTS[0], 'tips')]:
            with self.subTest(reason=reason):
                with self.assertRaisesRegex(ValueError, reason):
                    function(*arguments)


if __name__ == '__main__':
    unittest.main(verbosity=2)
