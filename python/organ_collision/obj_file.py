"""Wavefront OBJ files. The packaged libraries reorder faces by material, duplicate vertices, or refuse files with
texture coordinates. Here faces and vertices keep the order of the file, so that new positions from a simulator fit,
and faces have the same numbers as in query_offline."""

import numpy as np

from organ_collision.mesh_file_error import MeshFileError


def read_obj(path):
    """The vertices, n x 3 floats, and faces, m x 3 indices from 0, of an OBJ file. Raises MeshFileError."""
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
