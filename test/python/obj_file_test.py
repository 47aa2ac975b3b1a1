#!/usr/bin/python3
"""OBJ files: vertices and faces keep their order, faces have the numbers of query_offline, and errors name the line."""

import csv
import os
import subprocess
import tempfile
import unittest

import numpy as np

from organ_collision.mesh_file_error import MeshFileError
from organ_collision.obj_file import read_obj

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
FACES = [[4, 5, 6], [4, 6, 7], [0, 1, 2], [0, 2, 3], [8, 9, 10]]


class ObjFileTest(unittest.TestCase):

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory(prefix='organ_collision_obj_')
        self.addCleanup(self.folder.cleanup)

    def write(self, name, text):
        path = os.path.join(self.folder.name, name)
        with open(path, 'w', encoding='utf-8') as file:
            file.write(text)
        return path

    def test_vertices_and_faces_keep_their_order(self):
        vertices, faces = read_obj(self.write('forms.obj', FORMS))
        np.testing.assert_array_equal(vertices[:, 0], [0, 1, 1, 0, 3, 4, 4, 3, 6, 7, 7])
        np.testing.assert_array_equal(vertices[2], [1, 1, 0])
        np.testing.assert_array_equal(faces, FACES)

    def test_a_byte_order_mark_is_no_part_of_the_first_line(self):
        text = FORMS[FORMS.index('v 0 0 0'):]
        vertices, faces = read_obj(self.write('marked.obj', '\ufeff' + text))
        np.testing.assert_array_equal(vertices, read_obj(self.write('plain.obj', text))[0])
        np.testing.assert_array_equal(faces, FACES)

    def test_faces_have_the_numbers_of_query_offline(self):
        """A ball at the centre of each face touches, of all faces, that one only. So it is with byte order marks."""
        for mark in ('', '\ufeff'):
            self.check_numbers(mark)

    def check_numbers(self, mark):
        path = self.write('forms.obj', mark + FORMS[FORMS.index('v 0 0 0'):])
        vertices, faces = read_obj(path)
        rows = ['query,mode,trocar_x,trocar_y,trocar_z,previous_x,previous_y,previous_z,tip_x,tip_y,tip_z,radius']
        for face, corners in enumerate(faces):
            centre = '%r,%r,%r' % tuple(vertices[corners].mean(axis=0).tolist())
            rows.append('%d,static,%s,%s,%s,0.01' % (face, centre, centre, centre))
        motions = self.write('motions.csv', mark + '\n'.join(rows) + '\n')
        answer = subprocess.check_output([os.environ['QUERY_OFFLINE'], '--mesh', path, '--motions', motions], text=True)
        self.assertEqual([(int(row['query']), int(row['face'])) for row in csv.DictReader(answer.splitlines())],
                         [(face, face) for face in range(len(faces))])

    def test_errors_name_the_line(self):
        for line, text, reason in (
                (1, 'v 1 2\n', 'a vertex with 2 coordinates'),
                (2, '\nv 1 2 three\n', 'could not convert'),
                (2, 'v 1 2 3\nf 1 1\n', 'a face with 2 corners'),
                (2, 'v 1 2 3\nf 1 1 -2\n', 'refers to vertex -2; legal are numbers from 1, or from -1 to -1'),
                (2, 'v 1 2 3\nf 0 1 1\n', 'refers to vertex 0'),
                (1, 'f a b c\n', 'invalid literal')):
            path = self.write('wrong.obj', text)
            with self.assertRaisesRegex(MeshFileError, r'wrong\.obj:%d: .*%s' % (line, reason)):
                read_obj(path)

    def test_a_missing_vertex_is_named(self):
        path = self.write('wrong.obj', 'v 1 2 3\nv 4 5 6\nf 1 2 3\n')
        with self.assertRaisesRegex(MeshFileError, 'refers to vertex 3; the file has 2, counted from 1'):
            read_obj(path)


if __name__ == '__main__':
    unittest.main(verbosity=2)
