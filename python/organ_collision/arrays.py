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
    """A copy of `faces` as m x 3 indices. Raises ValueError if it is not m x 3, and if an index is no integer or
    there is no such vertex."""
    given = _number_array(faces, 'faces', 'm x 3: one row of three vertex indices for each triangle')
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


def _number_array(values, name, legal):
    try:
        array = np.asarray(values)
    except ValueError:  # Newer versions of numpy refuse rows of different lengths.
        array = np.empty(0, dtype=object)
    if array.dtype.kind not in 'iuf':
        raise ValueError('%s is no array of numbers with rows of equal length; it must be %s' % (name, legal))
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError('%s has the shape %s; it must be %s' % (name, array.shape, legal))
    return array
