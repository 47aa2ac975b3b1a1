"""Triangle meshes from files."""

import contextlib
import io
import os

import numpy as np


_LFS_POINTER = b'version https://git-lfs.github.com/spec/'


class MeshFileError(ValueError):
    """A mesh file cannot be used. The text names the file and what is wrong."""


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
        raise MeshFileError('%s: %s' % (path, 'is no file' if os.path.exists(path) else 'there is no such file'))
    with open(path, 'rb') as content:
        if content.read(len(_LFS_POINTER)) == _LFS_POINTER:
            raise MeshFileError("%s: is only a pointer of Git LFS; fetch the file itself by 'git lfs pull'" % path)
    if path.lower().endswith('.ply') and not _has_whole_header(path):
        raise MeshFileError('%s: its header has no line end_header; the file may be cut off' % path)
    read = read_obj if path.lower().endswith('.obj') else _read_with_meshio
    vertices, faces = read(path)
    if not len(faces):
        raise MeshFileError('%s: has no triangles or polygons; a volume mesh needs its surface extracted first' % path)
    return scale * vertices, faces


def _has_whole_header(path):
    """Whether the header of a PLY file ends: meshio would never stop to read another one."""
    with open(path, 'rb') as content:
        return b'end_header' in [line.strip() for line in content.read(1 << 20).splitlines()]


def _read_with_meshio(path):
    import meshio  # It takes a third of a second to load, and OBJ files need none of it.

    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
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


def read_obj(path):
    """The vertices, n x 3 floats, and faces, m x 3 indices from 0, of a Wavefront OBJ file. Raises MeshFileError.

    The packaged libraries reorder faces by material, duplicate vertices, or refuse files with texture coordinates.
    Here faces and vertices keep the order of the file, so that new positions from a simulator fit, and faces have the
    same numbers as in query_offline.
    """
    vertices, faces = [], []
    with open(path, encoding='utf-8-sig', errors='replace') as lines:
        for number, line in enumerate(lines, 1):
            words = line.split('#')[0].split()
            try:
                if words[:1] == ['v']:
                    vertices.append(_vertex(words[1:]))
                elif words[:1] == ['f']:
                    faces += _fan(words[1:], len(vertices))
            except ValueError as error:
                raise MeshFileError('%s:%d: %s' % (path, number, error)) from None
    if faces and np.max(faces) >= len(vertices):
        raise MeshFileError('%s: a face refers to vertex %d; the file has %d, counted from 1'
                            % (path, np.max(faces) + 1, len(vertices)))
    return np.array(vertices, dtype=float).reshape(-1, 3), np.array(faces, dtype=int).reshape(-1, 3)


def _vertex(words):
    """Coordinates after the third are a weight or a colour, and are ignored."""
    if len(words) < 3:
        raise ValueError('a vertex with %d coordinates; must have x, y and z' % len(words))
    return [float(word) for word in words[:3]]


def _fan(words, vertices_so_far):
    if len(words) < 3:
        raise ValueError('a face with %d corners; must have at least 3' % len(words))
    corners = [_corner(word, vertices_so_far) for word in words]
    return [(corners[0], corners[i - 1], corners[i]) for i in range(2, len(corners))]


def _corner(word, vertices_so_far):
    """The index, from 0, of the vertex in v, v/vt, v//vn or v/vt/vn. The vertex may stand later in the file."""
    number = int(word.split('/')[0])
    index = vertices_so_far + number if number < 0 else number - 1
    if index < 0:
        raise ValueError('a face refers to vertex %d; legal are numbers from 1, or from -1 to -%d counted back'
                         % (number, vertices_so_far))
    return index
