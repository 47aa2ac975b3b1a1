#!/usr/bin/python3
"""One closed surface, written by meshio in several formats, is read back; broken files are refused."""

import os
import tempfile
import unittest

import meshio
import numpy as np

from organ_collision import MeshFileError, read_mesh

# A tetrahedron with outward faces; the numbers are exact as 32-bit floats.
VERTICES = np.array([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [0.0, 20.0, 0.0], [0.5, 0.25, 30.0]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
KEEP_VERTICES = ('tetrahedron.ply', 'tetrahedron.off', 'tetrahedron.vtk', 'tetrahedron.vtu', 'TETRAHEDRON.OBJ')


def volume(corners):
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    return np.einsum('ij,ij->', a, np.cross(b, c)) / 6


class MeshFilesTest(unittest.TestCase):

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix='organ_collision_meshes_')
        self.addCleanup(self.folder.cleanup)

    def path(self, name, content=None):
        path = os.path.join(self.folder.name, name)
        if content is not None:
            with open(path, 'wb') as file:
                file.write(content)
        return path

    def written(self, name, cells=(('triangle', FACES),), **options):
        mesh = meshio.Mesh(VERTICES, list(cells))
        mesh.write(self.path(name), **options)
        return self.path(name)

    def test_formats_with_vertices_keep_them(self):
        for name in KEEP_VERTICES:
            vertices, faces = read_mesh(self.written(name))
            np.testing.assert_allclose(vertices, VERTICES, err_msg=name)
            np.testing.assert_array_equal(faces, FACES, err_msg=name)

    def test_the_corners_of_stl_become_shared_vertices(self):
        for binary in (False, True):
            vertices, faces = read_mesh(self.written('tetrahedron.stl', binary=binary))
            self.assertEqual(len(vertices), 4)
            np.testing.assert_allclose(vertices[faces], VERTICES[FACES])

    def test_millimetres_become_metres(self):
        vertices, faces = read_mesh(self.written('tetrahedron.stl', binary=True), scale=0.001)
        self.assertAlmostEqual(volume(vertices[faces]), 1e-6, delta=1e-15)

    def test_polygons_become_fans_in_the_order_of_the_file(self):
        quads = np.array([[3, 2, 1, 0], [0, 1, 3, 2]])
        _, faces = read_mesh(self.written('quads.vtu', [('triangle', FACES[:1]), ('quad', quads)]))
        np.testing.assert_array_equal(faces, [[0, 2, 1], [3, 2, 1], [3, 1, 0], [0, 1, 3], [0, 3, 2]])

    def test_a_volume_mesh_is_refused(self):
        path = self.written('volume.vtk', [('tetra', np.array([[0, 1, 2, 3]]))])
        with self.assertRaisesRegex(MeshFileError, r'volume\.vtk: has no triangles'):
            read_mesh(path)

    def test_files_that_cannot_be_read_are_named(self):
        with open(self.written('whole.stl', binary=True), 'rb') as file:
            cut = file.read()[:-60]
        for name, content in (('empty.stl', b''), ('cut.stl', cut),
                              ('broken.ply', b'ply\nformat what\n'), ('broken.vtk', b'\xff\x00'), ('empty.obj', b''),
                              ('unknown.liver', b'v 0 0 0'), ('no_ending', b'v 0 0 0')):
            with self.subTest(name):
                with self.assertRaisesRegex(MeshFileError, name.replace('.', r'\.')):
                    read_mesh(self.path(name, content))

    def test_a_missing_file_is_named(self):
        with self.assertRaisesRegex(MeshFileError, r'nowhere\.stl: there is no such file'):
            read_mesh(self.path('nowhere.stl'))


if __name__ == '__main__':
    unittest.main(verbosity=2)
