"""Triangle meshes from files."""

import contextlib
import io
import os

import numpy as np

from organ_collision.mesh_file_error import MeshFileError
from organ_collision.obj_file import read_obj


def read_mesh(path, scale=1.0):
    """Reads the surface in a mesh file: OBJ, or a format of the library meshio (STL, PLY, OFF, VTK, Gmsh, ...), which
    the ending of the name tells.

    path   name of the file
    scale  metres for each unit of the file: 0.001 for a file in millimetres

    Returns (vertices, faces): n x 3 floats [m] and m x 3 vertex indices. Vertices keep the order of the file, except
    in STL, which has none: there, corners at the same place become one vertex. Faces keep the order of the file; a
    polygon of k corners is cut into a fan of k - 2 faces around its first corner. Raises MeshFileError if the file
    is missing, broken or has no faces.
    """
    if not os.path.isfile(path):
        raise MeshFileError('%s: there is no such file' % path)
    read = read_obj if path.lower().endswith('.obj') else _read_with_meshio
    vertices, faces = read(path)
    if not len(faces):
        raise MeshFileError('%s: has no triangles or polygons; a volume mesh needs its surface extracted first' % path)
    return scale * vertices, faces


def _read_with_meshio(path):
    import meshio  # It takes a third of a second to load, and OBJ files need none of it.

    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said):
            mesh = meshio.read(path)
    except (Exception, SystemExit) as error:  # meshio raises anything at broken files, and may even exit.
        reason = said.getvalue().strip() or str(error) or type(error).__name__
        raise MeshFileError('%s: meshio cannot read it: %s' % (path, reason)) from error
    surfaces = [_fans(block.data) for block in mesh.cells if block.type in ('triangle', 'quad', 'polygon')]
    return np.asarray(mesh.points, dtype=float), np.concatenate([np.empty((0, 3), dtype=int)] + surfaces)


def _fans(polygons):
    """The triangles of polygons with equally many corners, each cut into a fan."""
    polygons = np.asarray(polygons)
    corners = [(0, i - 1, i) for i in range(2, polygons.shape[1])]
    return polygons[:, corners].reshape(-1, 3)
