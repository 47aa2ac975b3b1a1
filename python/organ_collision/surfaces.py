"""Surfaces in the bytes of other packages' messages, for organ_mesh_adapter. No loop runs over vertices or faces."""

import math
import re
from typing import NamedTuple

import numpy as np
from pcl_msgs.msg import PolygonMesh
import rospy
from sensor_msgs.msg import PointCloud2, PointField
from shape_msgs.msg import Mesh
from visualization_msgs.msg import Marker

from organ_collision.mesh_files import cut_polygons, MeshFileError

_LONGEST_NAME = 256  # [bytes] of an organ, or a frame
_UNIT_TOLERANCE = 1e-2  # The norm of a legal orientation differs from 1 by at most this.
_FIELD_TYPES = {PointField.FLOAT32: 'f4', PointField.FLOAT64: 'f8'}
_MARKER = np.dtype([('id', '<i4'), ('type', '<i4'), ('action', '<i4'), ('position', '<f8', 3), ('orientation', '<f8', 4),
                    ('scale', '<f8', 3), ('color', '<f4', 4), ('lifetime', '<i4', 2), ('frame_locked', 'u1')])


class MessageError(Exception):
    """A message that cannot be read as a surface. Errors are counted by their `reason`. The text names the illegal value
    and what is legal."""

    def __init__(self, reason, text):
        super().__init__(text)
        self.reason = reason


class Surface(NamedTuple):
    """It may be illegal: the collision node checks it."""

    frame: bytes  # empty: the message has none
    stamp: rospy.Time  # zero: the message has none
    vertices: np.ndarray  # n x 3 32-bit floats
    triangles: np.ndarray  # m x 3 vertex indices
    marker: str = ''  # the marker's namespace and id
    lifetime: float = 0.0  # [s] 0: for ever
    is_deletion: bool = False  # of the marker, or of all if there is no name


def name_fault(name):
    """What is wrong with the bytes of a name; empty if it is legal."""
    shown = re.sub('[\x00-\x1f\x7f-\x9f]', ' ', name[:_LONGEST_NAME].decode(errors='replace'))
    if len(name) <= _LONGEST_NAME and shown.encode() == name:
        return ''
    fault = 'has %d bytes' % len(name) if len(name) > _LONGEST_NAME else 'has control characters, or bytes that are no UTF-8'
    return "'%s' %s; a name must be UTF-8 without control characters, of at most %d bytes" % (shown, fault, _LONGEST_NAME)


class SurfaceReader:
    """Reads the messages of one organ. Raises MessageError."""

    def __init__(self):
        # The last polygons, and their triangles: they are cut once, in their first shape.
        self._polygons = np.empty(0, '<u4'), np.empty((0, 3), '<u4')

    def read(self, message):
        """A message of the organ's topic: a rospy.AnyMsg."""
        readers = {Mesh: _read_shape, PolygonMesh: self._read_polygons, Marker: _read_marker}
        kind = _kind_of(message, readers, 'shape_msgs/Mesh, pcl_msgs/PolygonMesh or visualization_msgs/Marker')
        return readers[kind](_Bytes(message._buff, kind))

    def read_points(self, message):
        """A message of the organ's vertices_topic: frame, stamp and n x 3 32-bit floats."""
        data = _Bytes(message._buff, _kind_of(message, [PointCloud2], PointCloud2._type))
        found = _read_cloud(data)
        data.end()
        return found

    def _read_polygons(self, data):
        frame, stamp = data.header()
        cloud_frame, cloud_stamp, vertices = _read_cloud(data)
        count, words = data.number(), data.array('<u4', data.left() // 4)
        data.end()
        known, triangles = self._polygons
        if not np.array_equal(words, known):
            are_triangles = len(words) == 4 * count and (words[::4] == 3).all()
            triangles = words.reshape(-1, 4)[:, 1:].copy() if are_triangles else _cut(vertices, count, words)
            self._polygons = words, triangles
        return Surface(frame or cloud_frame, stamp or cloud_stamp, vertices, triangles)


def _cut(vertices, count, words):
    """The triangles of polygons, which are cut as those of a file."""
    try:
        return cut_polygons(vertices, count, words)
    except MeshFileError as error:
        is_short = re.search('face with [012] corners', str(error))
        raise MessageError('polygon without area' if is_short else 'wrong polygons', str(error))


def _kind_of(message, legal, names):
    """The class of the message among `legal`."""
    name, checksum = (message._connection_header.get(key) for key in ('type', 'md5sum'))
    for kind in legal:
        if kind._type == name and kind._md5sum == checksum:
            return kind
        if kind._type == name:
            raise MessageError('unreadable message', 'the messages are no %s: they have another md5sum; must be of the '
                               'version that is installed here' % name)
    raise MessageError('wrong type', 'the messages are %s; must be %s' % (name, names))


class _Bytes:
    """The bytes of a message, from which one value is read after the other."""

    def __init__(self, data, kind):
        self._data, self._place, self._kind = data, 0, kind

    def left(self):
        return len(self._data) - self._place

    def array(self, kind, count):
        kind = np.dtype(kind)
        if count * kind.itemsize > self.left():
            self._refuse('they end too early')
        begin, self._place = self._place, self._place + count * kind.itemsize
        return np.frombuffer(self._data[begin:self._place], kind)  # A copy: numpy is slow where numbers are not aligned.

    def number(self, kind='<u4'):
        return self.array(kind, 1)[0].item()

    def text(self):
        return self.array('u1', self.number()).tobytes()

    def points(self):
        return self.array('<f8', 3 * self.number()).reshape(-1, 3)

    def header(self):
        """Its frame and stamp."""
        _, stamp = self.number(), rospy.Time()
        stamp.secs, stamp.nsecs = self.array('<u4', 2).tolist()
        return self.text(), stamp

    def end(self):
        if self.left():
            self._refuse('%d of them are left' % self.left())

    def _refuse(self, why):
        raise MessageError('unreadable message', '%d bytes are no %s: %s' % (len(self._data), self._kind._type, why))


def floats(points):
    """n x 3 points as 32-bit floats. Refuses what is not finite as such a float."""
    with np.errstate(over='ignore'):
        vertices = points.astype('<f4')
    _check_finite(vertices, points)
    return vertices


def _check_finite(vertices, points):
    if not np.isfinite(vertices).all():
        vertex, axis = np.argwhere(~np.isfinite(vertices))[0]
        raise MessageError('not finite', '%s of vertex %d is %g; coordinates must be finite 32-bit floats, in metres'
                           % ('xyz'[axis], vertex, points[vertex, axis]))


def _read_shape(data):
    triangles = data.array('<u4', 3 * data.number()).reshape(-1, 3)
    points = data.points()
    data.end()
    return Surface(b'', rospy.Time(), floats(points), triangles)


def _read_cloud(data):
    """Frame, stamp, and the fields x, y and z of all points, row by row, of a PointCloud2."""
    frame, stamp = data.header()
    height, width = data.array('<u4', 2).tolist()
    fields = {}
    for _ in range(data.number()):
        name, offset, kind = data.text(), data.number(), data.number('u1')
        fields.setdefault(name, (offset, kind, data.number()))
    is_big_endian, point_step, row_step = data.number('u1'), data.number(), data.number()
    points = data.array('u1', data.number())
    data.number('u1')  # is_dense
    if not width * height:
        if points.size:
            raise MessageError('wrong size', 'the cloud is %d x %d points; must be none only where data is empty'
                               % (width, height))
        return frame, stamp, np.empty((0, 3), '<f4')
    found = [_field(fields, axis, point_step) for axis in ('x', 'y', 'z')]
    row = width * point_step
    if height > 1 and row_step < row:
        raise MessageError('wrong row_step', 'row_step is %d; %d points of point_step %d need %d'
                           % (row_step, width, point_step, row))
    if (height - 1) * row_step + row > points.size:
        raise MessageError('truncated cloud', 'data has %d bytes; too few for %d x %d points of point_step %d'
                           % (points.size, width, height, point_step))
    columns = [np.ndarray((height, width), ('>' if is_big_endian else '<') + kind, points, offset, (row_step, point_step))
               for offset, kind in found]
    return frame, stamp, floats(np.stack([column.reshape(-1) for column in columns], axis=1))


def _field(fields, axis, point_step):
    """The offset and the type of a field. Old PCL versions write the count 0 instead of 1."""
    if axis.encode() not in fields:
        names = ', '.join(name.decode(errors='replace') for name in fields)
        raise MessageError('missing field', "the fields of the points are '%s'; must hold x, y and z" % names)
    offset, kind, count = fields[axis.encode()]
    if kind not in _FIELD_TYPES:
        raise MessageError('wrong field type', 'field %s has datatype %d; must be 7 (float32) or 8 (float64)' % (axis, kind))
    if count > 1:
        raise MessageError('wrong field count', 'field %s has count %d; must be 1' % (axis, count))
    end = offset + np.dtype(_FIELD_TYPES[kind]).itemsize
    if end > point_step:
        raise MessageError('wrong point_step', 'field %s ends at byte %d of a point; point_step is %d, must be at least that'
                           % (axis, end, point_step))
    return offset, _FIELD_TYPES[kind]


def _read_marker(data):
    frame, stamp = data.header()
    namespace, marker, points = data.text(), data.array(_MARKER, 1)[0], data.points()
    data.array('<f4', 4 * data.number())  # the colours
    data.text(), data.text(), data.number('u1')
    data.end()
    if name_fault(namespace):
        raise MessageError('illegal name', "the marker's namespace " + name_fault(namespace))
    name = '%s/%d' % (namespace.decode(), marker['id'])
    action = marker['action']
    if action in (Marker.DELETE, Marker.DELETEALL):
        name = '' if action == Marker.DELETEALL else name
        return Surface(frame, stamp, np.empty((0, 3), '<f4'), np.empty((0, 3), '<u4'), name, is_deletion=True)
    if action != Marker.ADD:
        raise MessageError('unknown action', "marker '%s' has action %d; must be 0 (ADD), 2 (DELETE) or 3 (DELETEALL)"
                           % (name, action))
    if marker['type'] != Marker.TRIANGLE_LIST:
        raise MessageError('other marker type', "marker '%s' is of type %d; must be 11 (TRIANGLE_LIST)"
                           % (name, marker['type']))
    if len(points) % 3:
        raise MessageError('wrong number of points', "marker '%s' has %d points; must be a multiple of three"
                           % (name, len(points)))
    seconds, nanoseconds = marker['lifetime'].tolist()
    return Surface(frame, stamp, _placed(points, marker), np.arange(len(points), dtype='<u4').reshape(-1, 3), name,
                   max(0.0, seconds + 1e-9 * nanoseconds))


def _placed(points, marker):
    """The points of a marker at its scale and pose. An orientation of four zeros means no rotation, as in RViz."""
    scale, place, (x, y, z, w) = marker['scale'], marker['position'], marker['orientation']
    if not ((scale > 0) & np.isfinite(scale)).all():  # Otherwise the organ would be flat, or turned inside out.
        raise MessageError('wrong scale', 'scale is %g %g %g; must be finite and more than 0' % tuple(scale))
    norm = math.hypot(x, y, z, w)
    if norm and not abs(norm - 1) <= _UNIT_TOLERANCE:
        raise MessageError('wrong orientation', 'pose.orientation has length %g; must be 1, or 0 for none' % norm)
    if not np.isfinite(place).all():
        raise MessageError('not finite', 'pose.position is %g %g %g; must be finite, in metres' % tuple(place))
    if norm in (0, w) and (scale == 1).all() and not place.any():
        return floats(points)
    _check_finite(points, points)  # A rotation would make all three NaN.
    x, y, z, w = (part / norm for part in (x, y, z, w)) if norm else (0.0, 0.0, 0.0, 1.0)
    rotation = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                         [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                         [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    with np.errstate(over='ignore', invalid='ignore'):
        return floats(points @ (rotation * scale).T + place)
