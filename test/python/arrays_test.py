#!/usr/bin/python3
"""Arrays of the wrong shape, type or value are refused with what is legal; legal ones are copied."""

import unittest

import numpy as np

from organ_collision.arrays import face_array, points_array, vertex_array

POINTS = [[0.1, 0.2, 0.3], [1.5, -2.0, 4.0], [0.7, 0.1, -0.9], [3.0, 2.0, 1.0]]


class ArraysTest(unittest.TestCase):

    def assert_refused(self, reason, function, *arguments):
        with self.assertRaisesRegex(ValueError, reason):
            function(*arguments)

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

    def test_flat_vertices_are_refused(self):
        self.assert_refused(r'vertices has the shape \(12,\); it must be n x 3', vertex_array, np.ravel(POINTS))

    def test_vertices_with_two_coordinates_are_refused(self):
        self.assert_refused(r'shape \(4, 2\)', vertex_array, np.array(POINTS)[:, :2])

    def test_rows_of_different_lengths_are_refused(self):
        self.assert_refused('rows of equal length', vertex_array, [[0, 1, 2], [3, 4]])

    def test_words_and_none_are_refused(self):
        self.assert_refused('no array of numbers', vertex_array, [['a', 'b', 'c']])
        self.assert_refused('no array of numbers', vertex_array, None)

    def test_a_vertex_that_is_not_finite_is_named(self):
        for value in (np.nan, -np.inf, 1e39):
            points = np.array(POINTS)
            points[2, 1] = value
            self.assert_refused(r'vertices\[2\] is \[0.7, .*, -0.9\]; coordinates must be finite', vertex_array, points)

    def test_faces_become_32_bit_indices(self):
        for given in ([[0, 1, 2], [3, 2, 1]], np.array([[0, 1, 2], [3, 2, 1]], np.int64)):
            array = face_array(given, 4)
            self.assertEqual(array.dtype, np.uint32)
            np.testing.assert_array_equal(array, [[0, 1, 2], [3, 2, 1]])

    def test_no_faces_are_legal(self):
        self.assertEqual(face_array(np.empty((0, 3)), 0).shape, (0, 3))

    def test_a_face_without_its_vertex_is_named(self):
        self.assert_refused(r'faces\[1\] is \[1, 2, 4\]; there are 4 vertices, counted from 0',
                            face_array, [[0, 1, 2], [1, 2, 4]], 4)
        self.assert_refused(r'faces\[0\] is \[0, -1, 2\]', face_array, [[0, -1, 2]], 4)

    def test_flat_faces_and_quads_are_refused(self):
        self.assert_refused(r'faces has the shape \(6,\); it must be m x 3', face_array, [0, 1, 2, 3, 2, 1], 4)
        self.assert_refused(r'shape \(1, 4\)', face_array, [[0, 1, 2, 3]], 4)

    def test_indices_that_are_no_integers_are_refused(self):
        self.assert_refused('type float64; vertex indices must be integers', face_array, [[0.0, 1.0, 2.0]], 4)

    def test_points_name_the_argument(self):
        np.testing.assert_array_equal(points_array(POINTS, 'tips'), POINTS)
        self.assert_refused(r'tips has the shape \(3,\); it must be k x 3', points_array, POINTS[0], 'tips')


if __name__ == '__main__':
    unittest.main(verbosity=2)
