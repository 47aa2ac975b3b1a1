"""Checks the arrays of users, so that a mistake is explained where it is made."""

import numpy as np


def vertex_array(vertices):
    """A copy of `vertices` as n x 3 32-bit floats. Raises ValueError if it is not n x 3 or not finite."""
    given = _number_array(vertices, 'vertices', 'n x 3: one row (x, y, z) for each vertex')
    with np.errstate(over='ignore'):  # Numbers that are too large become infinite, which is checked.
        array = np.array(given, dtype='<f4', order='C')
    wrong = np.flatnonzero(~np.isfinite(array).all(axis=1))
    if wrong.size:
        raise ValueError('vertices[%d] is %s; coordinates must be finite 32-bit floats, in metres'
                         % (wrong[0], given[wrong[0]].tolist()))
    return array


def face_array(faces, vertex_count):
    """A copy of `faces` as m x 3 indices. Raises ValueError if it is not m x 3, if an index is no integer or there is
    no such vertex, and if there are vertices but no faces."""
    given = _number_array(faces, 'faces', 'm x 3: one row of three vertex indices for each triangle')
    if vertex_count and not given.size:
        raise ValueError('faces is empty, but there are %d vertices; an organ has at least one face' % vertex_count)
    if given.size and given.dtype.kind not in 'iu':
        raise ValueError('faces has the type %s; vertex indices must be integers' % given.dtype)
    wrong = np.flatnonzero(((given < 0) | (given >= vertex_count)).any(axis=1))
    if wrong.size:
        raise ValueError('faces[%d] is %s; there are %d vertices, counted from 0'
                         % (wrong[0], given[wrong[0]].tolist(), vertex_count))
    return np.array(given, dtype='<u4', order='C')


def points_array(points, name):
    """`points` as k x 3 floats. Raises ValueError, naming `name`, if it is not k x 3."""
    return _number_array(points, name, 'k x 3: one row (x, y, z) for each motion').astype(float)


def poses_array(poses, name):
    """`poses` as k x l x 7 floats: position (x, y, z) and quaternion (x, y, z, w) of l links in k motions.

    They may be given so, or as k x l x 4 x 4 matrices. Raises ValueError, naming `name`, if they have another shape, or
    if a matrix is no rotation and translation.
    """
    legal = 'k x l x 7 (x, y, z and quaternion x, y, z, w), or k x l x 4 x 4: one pose for each motion and link'
    array = _numbers(poses, name, legal).astype(float)
    if array.ndim == 4 and array.shape[2:] == (4, 4):
        return _poses_of_matrices(array, name)
    if array.ndim != 3 or array.shape[2] != 7:
        raise ValueError('%s has the shape %s; it must be %s' % (name, array.shape, legal))
    return array


def _poses_of_matrices(matrices, name):
    rotations = matrices[:, :, :3, :3]
    is_rotation = (np.isclose(rotations @ np.swapaxes(rotations, 2, 3), np.eye(3), atol=1e-6).all(axis=(2, 3))
                   & (np.linalg.det(np.nan_to_num(rotations)) > 0)
                   & np.isclose(matrices[:, :, 3], (0, 0, 0, 1)).all(axis=2))
    wrong = np.argwhere(~is_rotation)
    if wrong.size:
        raise ValueError('%s[%d, %d] is no matrix of a rotation and a translation' % (name, *wrong[0]))
    return np.concatenate([matrices[:, :, :3, 3], _quaternions(rotations)], axis=2)


def _quaternions(rotations):
    """The quaternions (x, y, z, w) of rotation matrices.

    The 4 x 4 matrix below is four times the outer product of the quaternion with itself. Each of its columns is
    therefore a multiple of the quaternion; the largest column is used.
    """
    r = np.moveaxis(rotations, (2, 3), (0, 1))
    x, y, z, w = 0, 1, 2, 3
    products = np.empty((4, 4) + rotations.shape[:2])
    products[x, x], products[y, y], products[z, z], products[w, w] = (
        1 + r[0, 0] - r[1, 1] - r[2, 2], 1 - r[0, 0] + r[1, 1] - r[2, 2],
        1 - r[0, 0] - r[1, 1] + r[2, 2], 1 + r[0, 0] + r[1, 1] + r[2, 2])
    for i, j, value in ((x, y, r[0, 1] + r[1, 0]), (x, z, r[0, 2] + r[2, 0]), (y, z, r[1, 2] + r[2, 1]),
                        (x, w, r[2, 1] - r[1, 2]), (y, w, r[0, 2] - r[2, 0]), (z, w, r[1, 0] - r[0, 1])):
        products[i, j] = products[j, i] = value
    columns = np.moveaxis(products, (0, 1), (3, 2))
    largest = np.linalg.norm(columns, axis=3).argmax(axis=2)
    chosen = np.take_along_axis(columns, largest[:, :, None, None], axis=2)[:, :, 0]
    return chosen / np.linalg.norm(chosen, axis=2, keepdims=True)


def _numbers(values, name, legal):
    if _has_masked(values):
        raise ValueError('%s has masked values; fill them, or leave their rows out' % name)
    try:
        array = np.asarray(values)
    except ValueError:  # Newer versions of numpy refuse rows of different lengths.
        array = np.empty(0, dtype=object)
    if array.dtype.kind not in 'iuf':
        raise ValueError('%s is no array of numbers with rows of equal length; it must be %s' % (name, legal))
    return array


def _has_masked(values):
    """Of an array, or of the rows of a list."""
    rows = values if isinstance(values, (list, tuple)) else [values]
    return any(isinstance(row, np.ma.MaskedArray) and np.ma.is_masked(row) for row in rows)


def _number_array(values, name, legal):
    array = _numbers(values, name, legal)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError('%s has the shape %s; it must be %s' % (name, array.shape, legal))
    return array
