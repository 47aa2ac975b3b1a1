#!/usr/bin/python3
"""Mesh files in several formats are read; OBJ files keep the order of their vertices and faces, which have the numbers
of query_offline; errors name the file and the line."""

import csv
import os
import subprocess
import tempfile
import unittest

import meshio
import numpy as np

from organ_collision import MeshFileError, read_mesh
from organ_collision.mesh_files import read_obj

# A tetrahedron with outward faces; the numbers are exact as 32-bit floats.
VERTICES = np.array([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [0.0, 20.0, 0.0], [0.5, 0.25, 30.0]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
KEEP_VERTICES = ('tetrahedron.ply', 'tetrahedron.off', 'tetrahedron.vtk', 'tetrahedron.vtu', 'TETRAHEDRON.OBJ')

# Two squares and a triangle, apart from each other in x, with all forms of corners, groups and materials.
FORMS = """# a comment
mtllib some.mtl
v 0 0 0
v 1 0 0 1.0
v 1 1 0 0.5 0.5 0.5
v 0 1 0
vt 0 0
vn 0 0 1
o second
usemtl red
f 5/1/1 6/1/1 7/1/1 8/1/1   # later vertices
v 3 0 0
v 4 0 0
v 4 1 0
v 3 1 0
usemtl blue
f 1//1 2//1 3//1 4//1
usemtl red
v 6 0 0
v 7 0 0
v 7 1 0
f -3 -2 -1
"""
FORMS_FACES = [[4, 5, 6], [4, 6, 7], [0, 1, 2], [0, 2, 3], [8, 9, 10]]


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
                              ('broken.ply', b'ply\nformat what\n'),
                              ('cut.ply', b'ply\nformat ascii 1.0\nelement vertex 3\n'), ('broken.vtk', b'\xff\x00'), ('empty.obj', b''),
                              ('unknown.liver', b'v 0 0 0'), ('no_ending', b'v 0 0 0')):
            with self.subTest(name):
                with self.assertRaisesRegex(MeshFileError, name.replace('.', r'\.')):
                    read_mesh(self.path(name, content))
        with self.assertRaisesRegex(MeshFileError, r'nowhere\.stl: there is no such file'):
            read_mesh(self.path('nowhere.stl'))

    def test_obj_files_keep_vertices_and_faces_in_their_order(self):
        for text in FORMS, '\ufeff' + FORMS[FORMS.index('v 0 0 0'):]:
            vertices, faces = read_obj(self.path('forms.obj', text.encode()))
            np.testing.assert_array_equal(vertices[:, 0], [0, 1, 1, 0, 3, 4, 4, 3, 6, 7, 7])
            np.testing.assert_array_equal(vertices[2], [1, 1, 0])
            np.testing.assert_array_equal(faces, FORMS_FACES)

    def test_faces_of_obj_files_have_the_numbers_of_query_offline(self):
        """A ball at the centre of each face touches, of all faces, that one only."""
        path = self.path('forms.obj', FORMS.encode())
        vertices, faces = read_obj(path)
        rows = []
        for face, corners in enumerate(faces):
            centre = '%r,%r,%r' % tuple(vertices[corners].mean(axis=0).tolist())
            rows.append('%d,static,%s,%s,%s,0.01' % (face, centre, centre, centre))
        motions = self.path('motions.csv', ('\n'.join(rows) + '\n').encode())
        answer = subprocess.check_output([os.environ['QUERY_OFFLINE'], '--mesh', path, '--motions', motions], text=True)
        self.assertEqual([(int(row['query']), int(row['face'])) for row in csv.DictReader(answer.splitlines())],
                         [(face, face) for face in range(len(faces))])

    def test_errors_in_obj_files_name_the_line(self):
        for place, text, reason in (
                (':1', 'v 1 2\n', 'a vertex with 2 coordinates'),
                (':2', '\nv 1 2 three\n', 'could not convert'),
                (':2', 'v 1 2 3\nf 1 1\n', 'a face with 2 corners'),
                (':2', 'v 1 2 3\nf 1 1 -2\n', 'refers to vertex -2; legal are numbers from 1, or from -1 to -1'),
                (':2', 'v 1 2 3\nf 0 1 1\n', 'refers to vertex 0'),
                (':1', 'f a b c\n', 'invalid literal'),
                ('', 'v 1 2 3\nv 4 5 6\nf 1 2 3\n', 'refers to vertex 3; the file has 2, counted from 1')):
            path = self.path('wrong.obj', text.encode())
            with self.assertRaisesRegex(MeshFileError, r'wrong\.obj%s: .*%s' % (place, reason)):
                read_obj(path)


if __name__ == '__main__':
    unittest.main(verbosity=2)
