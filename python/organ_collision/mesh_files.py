"""Triangle meshes from files. The program robot_reader reads them, and VTK those of VTK.

As a program, it writes the surface in a VTK file to standard output as a PLY file, or why it cannot: a broken file may end
VTK, and must not end the caller.
"""

import functools
import os
import re
import resource
import subprocess
import sys

import numpy as np

_VTK = ('.vtk', '.vtp', '.vtu')
_REFUSED = 3  # the exit code of this program

LIMIT = 30.0  # [s] as in the collision node


class MeshFileError(ValueError):
    """A mesh file cannot be used. The text names the file and what is wrong."""


def read_mesh(path, scale=1.0, lps=False):
    """Reads the surface in a mesh file: OBJ, STL, PLY, OFF, DAE and others that assimp reads, and VTK (.vtk, .vtp, .vtu)
    if Debian's python3-vtk9 is installed. The ending of the name tells the format.

    path   name of the file
    scale  metres for each unit of the file: 0.001 for a file in millimetres
    lps    whether the axes of the file point to the patient's left, posterior and superior, as in files that 3D Slicer
           saves. Then x and y change their signs, so that the axes point right, anterior and superior (RAS).

    Returns (vertices, faces): n x 3 floats [m] and m x 3 vertex indices. Vertices keep the order of the file, except
    in STL and in what assimp reads: there, corners at the same place become one vertex. A face's number is its place
    among the file's faces, from 0. A polygon of k corners counts as k - 2 faces: a convex one as the fan around its
    first corner, a concave one without faces in the void. Raises MeshFileError if the file is missing or broken or has
    no faces. query_offline, and a mesh of a URDF, give the same vertices and faces, or the same refusal, but for VTK's
    files: there, write_ply() makes a file that they read.
    """
    path = str(path)
    is_vtk = path.lower().endswith(_VTK)
    vertices, faces = _read(path, _ply_of_vtk(path)) if is_vtk else _read(path)
    axes = np.array([-1.0, -1.0, 1.0] if lps else [1.0, 1.0, 1.0])
    return vertices * axes * scale, faces.astype(int)


def write_ply(path, vertices, faces):
    """Writes n x 3 vertices and m x 3 faces as a binary PLY file."""
    with open(path, 'wb') as file:
        file.write(_ply(vertices, len(faces), np.insert(faces, 0, 3, axis=1).astype('<u4')))


def cut_polygons(vertices, count, polygons):
    """The m x 3 faces of polygons, which are cut as those of a file. Raises MeshFileError if a polygon is illegal.

    vertices  n x 3 floats
    count     the number of polygons
    polygons  their 32-bit words, one polygon after the other: the number of its corners, and their vertex indices
    """
    return _read('polygons', _ply(vertices, count, polygons))[1]


def _ply(vertices, count, polygons):
    """A PLY file. Its lists are as polygons are in ROS messages."""
    head = ('ply\nformat binary_little_endian 1.0\nelement vertex %d\n%selement face %d\n'
            'property list uint uint vertex_indices\nend_header\n'
            % (len(vertices), ''.join('property double %s\n' % axis for axis in 'xyz'), count))
    return head.encode() + np.asarray(vertices, '<f8').tobytes() + polygons.tobytes()


@functools.lru_cache()
def _reader():
    """The paths of robot_reader. ROS needs some tenths of a second to find it."""
    from roslib.packages import find_node
    return find_node('organ_collision', 'robot_reader')


def _read(path, ply=None):
    """The mesh in a file, or in the bytes of a PLY file, as robot_reader reads it."""
    # VTK's process has only Python's own modules and numpy.
    from organ_collision.msg import RobotRecord
    program = _reader()
    if not program:
        raise MeshFileError('%s: the program robot_reader, which reads it, is not in ROS_PACKAGE_PATH' % path)
    try:
        reader = subprocess.run([program[0], '--mesh', '-' if ply else path], input=ply or b'', stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, timeout=LIMIT)
    except subprocess.TimeoutExpired:
        raise MeshFileError('%s: robot_reader took more than %g s to read it; the file may be broken' % (path, LIMIT))
    if reader.returncode == 2:
        why = reader.stderr.decode(errors='replace').splitlines()[-1]
        raise MeshFileError(why.replace('standard input.ply', path) if ply else why)
    if reader.returncode != 0:
        raise MeshFileError('%s: robot_reader ended with %d while it read it; the file may be broken, or too large'
                            % (path, reader.returncode))
    shape = RobotRecord().deserialize_numpy(reader.stdout[4:], np).links[0].shapes[0]  # Behind the number of its bytes.
    return shape.vertices.reshape(-1, 3), shape.triangles.reshape(-1, 3)


def _ply_of_vtk(path):
    """The surface in a VTK file, as a PLY file."""
    if not os.path.isfile(path):
        raise MeshFileError('%s: there is no such file' % path)
    try:
        # Isolated: no module is loaded from the folder of the user.
        reader = subprocess.run(['/usr/bin/python3', '-I', __file__, path], stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, timeout=60)
    except subprocess.TimeoutExpired:
        raise MeshFileError('%s: VTK takes longer than a minute to read it' % path)
    if reader.returncode == 0:
        return reader.stdout
    why = reader.stdout.decode(errors='replace').strip()
    raise MeshFileError('%s: %s' % (path, why if reader.returncode == _REFUSED else 'VTK crashes at it'))


def _surface_of_vtk(path):
    """The points, the number of polygons, and the polygons as in cut_polygons(), of a VTK file. Cells of three dimensions
    have no surface."""
    try:
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkCommonCore import vtkOutputWindow
        from vtkmodules.vtkIOLegacy import vtkGenericDataObjectReader
        from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader
    except ImportError:
        raise MeshFileError('needs VTK: install the package python3-vtk9')
    readers = dict(zip(_VTK, (vtkGenericDataObjectReader, vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader)))
    reader, errors = readers[os.path.splitext(path)[1].lower()](), []

    def heard(source, event, text):
        if event == 'ErrorEvent' or 'Error' in text:  # A legacy file that is cut off is only a warning.
            errors.append(re.sub(r'^.*?\): |^.*line \d+ ', '', ' '.join(text.split())))

    heard.CallDataType = 'string0'
    for event in ('ErrorEvent', 'WarningEvent'):
        vtkOutputWindow.GetInstance().AddObserver(event, heard)
    reader.SetFileName(path)
    reader.Update()
    data = reader.GetOutputDataObject(0)
    if errors or not data or not data.IsA('vtkPointSet') or not data.GetPoints():
        raise MeshFileError('VTK cannot read it: ' + (errors or ['it has no points, or is no polygonal mesh'])[0])

    def cells(array):
        """Where each cell begins in the vertex indices, and these."""
        return vtk_to_numpy(array.GetOffsetsArray()), vtk_to_numpy(array.GetConnectivityArray())

    def triangles(strips):
        return [strip[[i, i + 1 + i % 2, i + 2 - i % 2]] for strip in strips for i in range(len(strip) - 2)]

    if data.IsA('vtkPolyData'):
        at, ids = cells(data.GetPolys())
        first, of_strips = cells(data.GetStrips())
        found = triangles(np.split(of_strips, first[1:-1]))
        sizes, ids = np.append(np.diff(at), np.full(len(found), 3)), np.concatenate([ids, *found])
    else:
        (at, ids), kinds = cells(data.GetCells()), vtk_to_numpy(data.GetCellTypesArray())
        third = at[:-1][kinds == 8] + 2  # Pixels have their last two corners in the other order.
        ids[third], ids[third + 1] = ids[third + 1], ids[third]
        if (kinds == 6).any():  # strips
            faces = [triangles([cell]) if kind == 6 else [cell] for kind, cell in zip(kinds, np.split(ids, at[1:-1]))]
            kinds = np.repeat(np.where(kinds == 6, 5, kinds), [len(of_cell) for of_cell in faces])
            faces = [face for of_cell in faces for face in of_cell]
            at, ids = np.cumsum([0, *map(len, faces)]), np.concatenate(faces)
        sizes, is_face = np.diff(at), np.isin(kinds, (5, 7, 8, 9))
        ids, sizes = ids[np.repeat(is_face, sizes)], sizes[is_face]
    points = vtk_to_numpy(data.GetPoints().GetData())
    wrong = ids[(ids < 0) | (ids >= len(points))]
    if wrong.size:
        raise MeshFileError('a face refers to vertex %d; the file has %d, counted from 0' % (wrong[0], len(points)))
    return points, len(sizes), np.insert(ids, np.cumsum(sizes) - sizes, sizes).astype('<u4')


if __name__ == '__main__':
    for limited, most in (resource.RLIMIT_CPU, 10), (resource.RLIMIT_AS, 2 << 30):  # as of robot_reader
        resource.setrlimit(limited, (most, most))
    try:
        sys.stdout.buffer.write(_ply(*_surface_of_vtk(sys.argv[1])))
    except MeshFileError as error:
        print(error)
        sys.exit(_REFUSED)
