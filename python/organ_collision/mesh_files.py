"""Triangle meshes from files, as the program robot_reader reads them."""

import subprocess

import numpy as np
from organ_collision.msg import RobotRecord
from roslib.packages import find_node


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
    no faces. query_offline, and a mesh of a URDF, give the same vertices and faces, or the same refusal.
    """
    program = find_node('organ_collision', 'robot_reader')
    if not program:
        raise MeshFileError('%s: the program robot_reader, which reads it, is not in ROS_PACKAGE_PATH' % path)
    reader = subprocess.run([program[0], '--mesh', str(path)], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    # A broken file may end the program.
    if reader.returncode != 0:
        raise MeshFileError('%s: robot_reader ended with %d while it read it; the file may be broken, or too large'
                            % (path, reader.returncode))
    record = RobotRecord().deserialize_numpy(reader.stdout, np)
    if record.kind == RobotRecord.REFUSAL:
        raise MeshFileError(record.text)
    shape = record.links[0].shapes[0]
    axes = np.array([-1.0, -1.0, 1.0] if lps else [1.0, 1.0, 1.0])
    return shape.vertices.reshape(-1, 3) * axes * scale, shape.triangles.reshape(-1, 3).astype(int)
