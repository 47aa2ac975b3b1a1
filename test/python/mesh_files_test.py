#!/usr/bin/python3
"""The same file gives the same vertices and faces, or the same refusal, in read_mesh, query_offline, own_mesh.py and as a
mesh of a URDF; VTK's files, in Python, and in the others once they are converted. The files are those that 3D Slicer,
ParaView, MeshLab, CAD programs and others write."""

import csv
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import tempfile
import unittest

import numpy as np
from organ_collision import MeshFileError, read_mesh
from organ_collision.msg import RobotRecord

MESHES = pathlib.Path(os.environ['TEST_DATA']) / 'meshes'
CUBE = 0.05 * np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)])
CUBE_FACES = np.array([[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4], [2, 6, 7], [2, 7, 3], [0, 4, 6],
                       [0, 6, 2], [1, 3, 7], [1, 7, 5]])
HAS_VTK = subprocess.call(['/usr/bin/python3', '-c', 'import vtkmodules.vtkIOXML'], stderr=subprocess.DEVNULL) == 0
CUBES = ['c.vtp', 'c1.off', 'cont.obj', 'edges.ply', 'fcol.ply', 'poly3.vtk', 'slicer51.vtk', 'ushort.ply',
         'vertex_index.ply', 'wedge.ply']
OF_OWN_MESH = ('cont.obj', 'upper.STL', 'slicer51.vtk', 'bcut.stl')  # It loads slowly, and calls read_mesh.
DAE = """<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset/>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="9">0 0 0 0.5 0 0 0 0.25 0</float_array>
<technique_common><accessor source="#a" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/>
</vertices><triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry>
</library_geometries><library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>"""
OTHERS = {
    'quads.obj': ('v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nusemtl a\nf 4/1 3/2 2/1 1/1\nusemtl b\nf 2//1 3//1 6//1 5//1\n',
                  [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [2, 1, 0]], [[3, 2, 1], [3, 1, 0], [1, 2, 5], [1, 5, 4]]),
    'triangle.dae': (DAE, [[0, 0, 0], [0.5, 0, 0], [0, 0.25, 0]], [[0, 1, 2]]),
    'grid.vtk': ('# vtk DataFile Version 4.2\na\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n0 0 0 1 0 0 0 1 0 0 0 1.5\n'
                 'CELLS 3 13\n3 0 1 2\n4 0 1 2 3\n3 0 2 3\nCELL_TYPES 3\n5\n10\n5\n',
                 [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.5]], [[0, 1, 2], [0, 2, 3]]),
    'strip.vtk': ('# vtk DataFile Version 3.0\na\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 1 1 0\n'
                  'TRIANGLE_STRIPS 1 5\n4 0 1 2 3\n', [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], [[0, 1, 2], [1, 3, 2]]),
}


def c_vtp(corners):
    """A VTK file of one face."""
    array = '<DataArray type="%s" Name="%s" %sformat="ascii">%s</DataArray>'
    return ('<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64"><PolyData>'
            '<Piece NumberOfPoints="3" NumberOfPolys="1"><Points>%s</Points><Polys>%s%s</Polys></Piece></PolyData></VTKFile>'
            % (array % ('Float32', 'p', 'NumberOfComponents="3" ', '0 0 0 1 0 0 0 1 0'),
               array % ('Int64', 'connectivity', '', corners), array % ('Int64', 'offsets', '', '3')))


REFUSED = {
    'nowhere.stl': (None, 'there is no such file'),
    'empty.ply': (b'', 'it is empty'),
    'pointer.stl': (b'version https://git-lfs.github.com/spec/v1\n', "it is only a pointer of Git LFS; fetch the file itself by 'git lfs pull'"),
    'points.obj': (b'v 0 0 0\n', 'has no triangles or polygons; a volume mesh needs its surface extracted first'),
    'cut.off': (b'OFF 3 1 0\n0 0 0\n', 'the file ends before it has 3 of the element "vertex"; it may be cut off'),
    'text.liver': (b'This is no mesh.\n', 'No suitable reader found for the file format of file'),
    'tetrahedron.vtu': (b'<VTKFile', 'VTK cannot read it'),
    'nowhere.vtk': (None, 'there is no such file'),
    'cut.vtk': ('# vtk DataFile Version 3.0\na\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 2\n',
                'VTK cannot read it: '),
    'large_index.vtp': (c_vtp('0 1 4294967299'), 'a face refers to vertex 4294967299; the file has 3, counted from 0'),
    'bcount0.stl': (None, 'its header counts 0 triangles, for which it must have 84 bytes; the file has 684 bytes, as for 12 triangles'),
    'bcut.stl': (None, 'its header counts 12 triangles, for which it must have 684 bytes; the file has 664 bytes, as for 11 triangles'),
}

# Writes what a segmentation becomes: a closed surface with normals, in millimetres.


def volume(corners):
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    return np.einsum('ij,ij->', a, np.cross(b, c)) / 6


class MeshFilesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix='organ_collision_meshes_')
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def path(self, name, content=None):
        """The path of a copy of the file."""
        path = self.folder / name
        if content is not None:
            path.write_bytes(content if isinstance(content, bytes) else content.encode())
        elif (MESHES / name).exists():
            shutil.copy(str(MESHES / name), str(path))
        return str(path)

    def run_program(self, program, *arguments, text=''):
        return subprocess.run([os.environ[program], *arguments], input=text.encode(), stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, timeout=100)

    def urdf_mesh(self, path):
        """Vertices and faces, or the refusal, of the only link."""
        urdf = ('<robot name="r"><link name="l"><collision><geometry><mesh filename="%s"/></geometry></collision></link>'
                '</robot>' % path)
        done = self.run_program('ROBOT_READER', '-', 'l', text=urdf)
        if done.returncode == 2:
            return done.stderr.decode().splitlines()[-1]
        shape = RobotRecord().deserialize_numpy(done.stdout[4:], np).links[0].shapes[0]
        return shape.vertices.reshape(-1, 3), shape.triangles.reshape(-1, 3)

    def offline(self, path, points):
        """For each point, the sorted faces that a small ball there touches, or what query_offline prints as an error."""
        lines = ['%d,static,%s,,,,%s,1e-6' % (i, *2 * [','.join(map(repr, map(float, point)))]) for i, point in enumerate(points)]
        self.path('motions.csv', '\n'.join(lines) + '\n')
        done = self.run_program('QUERY_OFFLINE', '--mesh', path, '--motions', str(self.folder / 'motions.csv'))
        if done.returncode != 0:
            return done.stderr.decode()
        touched = [[] for _ in points]
        for row in csv.DictReader(done.stdout.decode().splitlines()):
            touched[int(row['query'])].append(int(row['face']))
        return touched

    def own_mesh(self, path, *options, lines=1):
        """The first lines that own_mesh.py prints, for which it needs no ROS master."""
        program = subprocess.Popen(['/usr/bin/python3', os.environ['OWN_MESH'], path, *options], stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, env={**os.environ, 'ROS_MASTER_URI': 'http://localhost:1'})
        with program:
            text = ''.join(program.stdout.readline().decode() for _ in range(lines))
            program.kill()
        return text

    def assert_mesh(self, path, vertices, faces, name):
        if '.vt' in name:
            found = read_mesh(path)
            np.testing.assert_array_equal(found[0].astype('f'), np.float32(vertices), err_msg=name)
            np.testing.assert_array_equal(found[1], faces, err_msg=name)
            path = self.converted(path)
        for found_vertices, found_faces in read_mesh(path), self.urdf_mesh(path):
            np.testing.assert_array_equal(found_vertices.astype('f'), np.float32(vertices), err_msg=name)
            np.testing.assert_array_equal(found_faces, faces, err_msg=name)
        # Each vertex touches its faces, and the centre of each face only this face.
        vertices, faces = np.array(vertices), np.array(faces)
        expected = [sorted(np.flatnonzero((faces == vertex).any(axis=1))) for vertex in range(len(vertices))]
        expected += [[face] for face in range(len(faces))]
        self.assertEqual(self.offline(path, [*vertices, *vertices[faces].mean(axis=1)]), expected, name)
        if name in OF_OWN_MESH:
            self.assertTrue(self.own_mesh(path).startswith(
                '%d vertices, %d faces, ' % (len(vertices), len(faces))), name)

    def converted(self, path):
        """The file that the command makes which query_offline and the meshes of a URDF name when they refuse a VTK file."""
        text = self.offline(path, [[0, 0, 0]])
        self.assertEqual(self.urdf_mesh(path) + '\n', "link 'l': mesh " + text)
        words = shlex.split(re.fullmatch(r"(.*): VTK's files are read .*'rosrun organ_collision own_mesh.py (.*)' makes .*\n", text)[2])
        pathlib.Path(self.folder / 'numpy.py').write_text('print("a module from the current folder")\n')
        printed = subprocess.check_output(['/usr/bin/python3', os.environ['OWN_MESH'], *words], cwd=str(self.folder), text=True)
        self.assertRegex(printed, r'\A\d+ vertices, ')
        return words[-1]

    def assert_refused(self, path, why, name):
        with self.assertRaises(MeshFileError) as caught:
            read_mesh(path)
        text = str(caught.exception)
        self.assertRegex(text, r'\A%s:(\d+:)? ' % path)
        self.assertIn(why, text, name)
        if '.vt' not in name:
            self.assertEqual(self.urdf_mesh(path), "link 'l': mesh " + text, name)
            self.assertEqual(self.offline(path, [[0, 0, 0]]), text + '\n', name)
        if name in OF_OWN_MESH:
            self.assertEqual(self.own_mesh(path), 'own_mesh.py: %s\n' % text, name)

    def test_the_same_mesh(self):
        rows = [(name, None, CUBE, CUBE_FACES) for name in CUBES]
        rows += [(name, content, vertices, faces) for name, (content, vertices, faces) in OTHERS.items()]
        for name, content, vertices, faces in rows:
            with self.subTest(name):
                if HAS_VTK or '.vt' not in name:
                    self.assert_mesh(self.path(name, content), vertices, faces, name)
                else:
                    self.assert_refused(self.path(name, content), 'needs VTK: install the package python3-vtk9', name)

    def test_the_corners_of_stl_become_shared_vertices(self):
        for name in ('bextra.stl', 'bsolid.stl', 'upper.STL'):
            with self.subTest(name):
                path = self.path(name)
                vertices, faces = read_mesh(path)
                self.assertEqual(len(vertices), 8)
                np.testing.assert_array_equal(np.float32(vertices[faces]), np.float32(CUBE[CUBE_FACES]))
                self.assert_mesh(path, vertices, faces, name)

    def test_the_same_refusal(self):
        for name, (content, why) in REFUSED.items():
            with self.subTest(name):
                self.assert_refused(self.path(name, content), why if HAS_VTK or '.vt' not in name else 'python3-vtk9', name)

    def test_concave_polygons_have_no_faces_in_the_void(self):
        for name, area, beside in ('L.obj', 75e-4, [0.06, 0.06, 0]), ('dart.obj', 42.5e-4, [0.05, 0.008, 0]):
            path = self.path(name)
            vertices, faces = read_mesh(path)
            a, b, c = (vertices[faces[:, i]] for i in range(3))
            normals = np.cross(b - a, c - a)
            self.assertTrue((normals[:, 2] > 0).all(), name)
            self.assertAlmostEqual(normals[:, 2].sum() / 2, area, delta=1e-12)
            self.assertEqual(self.offline(path, [beside]), [[]])

    def test_millimetres_and_axes_of_slicer_become_those_of_ros(self):
        path = self.path('vertex_index.ply')
        vertices, faces = read_mesh(path, scale=0.001, lps=True)
        np.testing.assert_allclose(vertices, CUBE * [-0.001, -0.001, 0.001])
        self.assertAlmostEqual(volume(vertices[faces]), 1e-12, delta=1e-18)

    def test_own_mesh_says_what_is_often_wrong(self):
        path = self.path('turned.obj', ''.join('v %r %r %r\n' % tuple(100 * v) for v in CUBE)
                         + ''.join('f %d %d %d\n' % tuple(face[::-1] + 1) for face in CUBE_FACES[1:]))
        self.assertRegex(self.own_mesh(path, lines=3),
                         r'\A8 vertices, 11 faces, 10 x 10 x 10 m, 3 open edges, normals point inward\n'
                         r'warning: the mesh is 10 m large.*--scale 0.001\nwarning: the normals point inward')
        self.assertRegex(self.own_mesh(path, '--scale', '0.001', lines=2), r'0.01 x 0.01 x 0.01 m.*\nwarning: the normals')


if __name__ == '__main__':
    unittest.main(verbosity=2)
