#!/usr/bin/python3
"""organ_mesh_adapter: what it reads in each message and refuses, what it sends, and its parameters. No ROS master runs."""

from importlib.machinery import SourceFileLoader
import io
import math
import os
import struct
import sys
import unittest

from geometry_msgs.msg import Point
import numpy as np
from organ_collision.surfaces import MessageError, SurfaceReader
from pcl_msgs.msg import PolygonMesh, Vertices
import rospy
from sensor_msgs.msg import PointCloud2, PointField
from shape_msgs.msg import Mesh, MeshTriangle
from visualization_msgs.msg import Marker

sys.dont_write_bytecode = True
adapter = SourceFileLoader('organ_mesh_adapter', os.environ['MESH_ADAPTER']).load_module()
rospy.rostime.set_rostime_initialized(True)

SIZES = {'b': 1, 'h': 2, 'f': 4, 'd': 8}  # of fields, by their formats
KINDS = {'b': PointField.INT8, 'h': PointField.INT16, 'f': PointField.FLOAT32, 'd': PointField.FLOAT64}
L_SHAPE = [(0, 0), (0.1, 0), (0.1, 0.05), (0.05, 0.05), (0.05, 0.1), (0, 0.1)]


def received(message, cut=0, **header):
    """The message as a subscriber gets it, without its last bytes."""
    buffer = io.BytesIO()
    message.serialize(buffer)
    found = rospy.AnyMsg()
    found._buff = buffer.getvalue()[:len(buffer.getvalue()) - cut]
    found._connection_header = {'type': message._type, 'md5sum': message._md5sum, **header}
    return found


def cloud(points, fields='x:f y:f z:f', big=False, width=0, padding=0, frame='liver', stamp=rospy.Time(100)):
    """A cloud with these fields in this order; those of one letter beside x, y and z are noise without a name."""
    fields = [field.split(':') for field in fields.split()]
    message = PointCloud2(is_bigendian=big, width=width or len(points))
    message.header.frame_id, message.header.stamp = frame, stamp
    for name, kind in fields:
        message.fields += [PointField(name, message.point_step, KINDS[kind], 1)] if name != '-' else []
        message.point_step += SIZES[kind]
    message.row_step = message.width * message.point_step + padding
    message.height = len(points) // message.width if message.width else 0
    for i, point in enumerate(points):
        for name, kind in fields:
            value = point['xyz'.index(name)] if name in 'xyz' else 77
            message.data += struct.pack(('>' if big else '<') + kind, value)
        message.data += b'\xa5' * (padding if (i + 1) % message.width == 0 else 0)
    return message


def polygons(points, faces, **header):
    return PolygonMesh(cloud=cloud(points, **header), polygons=[Vertices(face) for face in faces])


def shape(points, faces):
    return Mesh([MeshTriangle(face) for face in faces], [Point(*point) for point in points])


def marker(points, /, **fields):
    message = Marker(ns='organs', id=3, type=Marker.TRIANGLE_LIST, points=[Point(*point) for point in fields.pop('points', points)])
    message.header.frame_id = 'liver'
    message.scale.x = message.scale.y = message.scale.z = message.pose.orientation.w = 1.0
    for name, value in fields.items():
        *path, last = name.split('__')
        part = message
        for step in path:
            part = getattr(part, step)
        setattr(part, last, value)
    return message


def grid(height=0.0):
    points = [(0.1 * i, 0.1 * j, height * i * j) for j in range(3) for i in range(3)]
    return points, [(a, b, c) for i in (0, 1, 3, 4) for a, b, c in ((i, i + 1, i + 4), (i, i + 4, i + 3))]


class Case(unittest.TestCase):
    def assert_refused(self, call, *words):
        with self.assertRaises(MessageError) as caught:
            call()
        text = '%s: %s' % (caught.exception.reason, caught.exception)
        self.assertTrue(text.startswith(words[0] + ': '), text)
        for word in words[1:]:
            self.assertIn(word, text)
        self.assertLess(len(text), 1000)


class ReaderTest(Case):
    def setUp(self):
        self.reader, self.random = SurfaceReader(), np.random.RandomState(7)
        self.points = np.round(self.random.uniform(-0.3, 0.3, (12, 3)) * 2 ** 40) / 2 ** 40

    def read(self, message):
        return self.reader.read(received(message))

    def read_points(self, message):
        return self.reader.read_points(received(message))[2]

    def test_every_layout_of_a_cloud(self):
        for trial in range(100):
            fields = ['%s:%s' % (axis, self.random.choice(['f', 'd'])) for axis in 'xyz']
            fields += ['%s:%s' % (name, self.random.choice(list(KINDS))) for name in ('-', 'intensity', '-')]
            fields = ' '.join(self.random.permutation(fields[:self.random.randint(3, 7)]))
            layout = fields, trial % 2 == 0, self.random.choice([1, 3, 12]), self.random.randint(6)
            found = self.read_points(cloud(self.points, *layout))
            np.testing.assert_array_equal(found, np.float32(self.points), err_msg=str(layout))

    def test_clouds_that_are_refused(self):
        fields = cloud([]).fields
        for change, *words in (
                ({'fields': fields[:2]}, 'missing field', "'x, y'", 'x, y and z'),
                ({'fields': fields[:2] + [PointField('z', 8, 7, 3)]}, 'wrong field count', 'field z', 'count 3', '1'),
                ({'fields': fields[:2] + [PointField('z', 9, 7, 1)]}, 'wrong point_step', 'field z', 'byte 13', 'is 12'),
                ({'fields': fields[:2] + [PointField('z', 2 ** 32 - 1, 7, 1)]}, 'wrong point_step', 'byte 4294967299'),
                ({'fields': fields[:2] + [PointField('z', 8, 8, 1)]}, 'wrong point_step', 'byte 16'),
                ({'fields': fields[:2] + [PointField('z', 8, 5, 1)]}, 'wrong field type', 'field z', 'datatype 5'),
                ({'point_step': 0}, 'wrong point_step', 'field x', 'is 0'), ({'data': b''}, 'truncated cloud', '0 bytes'),
                ({'point_step': 13}, 'wrong row_step', '48', '4 points', '52'), ({'row_step': 49}, 'truncated cloud', '144 bytes'),
                ({'width': 0}, 'wrong size', '0 x 3'), ({'height': 0}, 'wrong size', '4 x 0')):
            message = cloud(self.points, width=4)
            for name, value in change.items():
                setattr(message, name, value)
            self.assert_refused(lambda: self.read_points(message), *words)
        huge = 2 ** 32 - 1
        for width in (12, huge):
            for height in (1, 2, huge):
                for point_step in (12, 2 ** 31, huge):
                    for row_step in (144, 2 ** 31, huge):
                        message = cloud(self.points)
                        message.width, message.height = width, height
                        message.point_step, message.row_step = point_step, row_step
                        if (width, height, point_step) != (12, 1, 12):
                            self.assertRaises(MessageError, self.read_points, message)

    def test_what_is_not_finite_as_a_float_is_refused_with_its_place(self):
        faces = [(0, 1, 2)]
        for read, make in ((self.read_points, lambda points: cloud(points, 'z:d -:f x:d y:d')), (self.read, marker),
                           (self.read, lambda points: shape(points, faces))):
            for value in (math.nan, math.inf, -math.inf, 1e39, -3.5e38):
                vertex, axis = self.random.randint(12), self.random.randint(3)
                points = self.points.copy()
                points[vertex, axis] = value
                self.assert_refused(lambda: read(make(points)), 'not finite', '%s of vertex %d is ' % ('xyz'[axis], vertex),
                                    'must be finite 32-bit floats')
            points[vertex, axis] = 3.4e38
            read(make(points))

    def test_polygons_are_cut_as_in_files_and_once(self):
        points, faces = [(x, y, 0.0) for x, y in L_SHAPE] + [(0.05, 0.05, 0.1)], [(3, 4, 5, 0, 1, 2), (0, 1, 6)]
        surface = self.read(polygons(points, faces))
        a, b, c = (surface.vertices[surface.triangles[:-1, i]].astype(float) for i in range(3))
        normals = np.cross(b - a, c - a)[:, 2]
        self.assertTrue((normals > 0).all())
        self.assertAlmostEqual(normals.sum() / 2, 75e-4, delta=1e-9)
        self.assertEqual((len(surface.triangles), list(surface.triangles[-1])), (5, [0, 1, 6]))
        moved = self.read(polygons([(x, 0.1 - y, z) for x, y, z in points], faces))
        self.assertIs(moved.triangles, surface.triangles)
        quads = self.read(polygons(points, [(0, 1, 2, 3)])).triangles
        np.testing.assert_array_equal(quads, [(0, 1, 2), (0, 2, 3)])
        for corners in ([], [1], [1, 0]):
            self.assert_refused(lambda: self.read(polygons(points, [(0, 1, 2), corners])), 'polygon without area', 'at least 3')
        self.assert_refused(lambda: self.read(polygons(points, [(0, 1, 2, 9)])), 'wrong polygons', 'vertex 9', 'has 7')

    def test_a_marker_is_scaled_and_then_placed(self):
        half = math.sqrt(0.5)  # This turn maps x to y, and y to -x.
        surface = self.read(marker(self.points, scale__x=2.0, scale__y=0.5, scale__z=3.0, pose__position__x=0.4,
                                   pose__orientation__z=half, pose__orientation__w=half, lifetime=rospy.Duration(2, 500000000)))
        x, y, z = self.points.T
        np.testing.assert_allclose(surface.vertices, np.stack([0.4 - 0.5 * y, 2.0 * x, 3.0 * z], axis=1), atol=1e-6)
        np.testing.assert_array_equal(surface.triangles.ravel(), range(12))
        self.assertEqual((surface.frame, surface.marker, surface.lifetime), (b'liver', 'organs/3', 2.5))
        for w in (0.995, 0.0):
            np.testing.assert_array_equal(self.read(marker(self.points, pose__orientation__w=w)).vertices, np.float32(self.points))

    def test_markers_that_are_refused(self):
        for fields, *words in (
                ({'pose__orientation__w': 2.0}, 'wrong orientation', 'length 2', 'must be 1'),
                ({'pose__orientation__x': math.nan}, 'wrong orientation', 'nan'),
                ({'pose__position__y': math.nan}, 'not finite', 'pose.position is ', 'nan'),
                ({'scale__y': 1e41}, 'not finite', 'y of vertex 0 is '),
                *(({'scale__y': scale}, 'wrong scale', 'more than 0') for scale in (0.0, -1.0, math.nan, math.inf)),
                ({'points': [(0, 0, 0)] * 5}, 'wrong number of points', "'organs/3'", '5 points', 'three'),
                ({'type': 9}, 'other marker type', "'organs/3'", 'type 9', '11 (TRIANGLE_LIST)'),
                ({'action': 7}, 'unknown action', "'organs/3'", 'action 7', '0 (ADD)'),
                ({'ns': 'a\nb'}, 'illegal name', "namespace 'a b'"),
                ({'ns': 10 ** 7 * 'x'}, 'illegal name', "namespace 'xxx", 'at most 256 bytes')):
            self.assert_refused(lambda: self.read(marker(self.points, **fields)), *words)


class OrganTest(Case):
    """What an organ sends: `meshes` and `shapes`."""

    def setUp(self):
        self.organ = self.make()
        (self.points, self.faces), self.moved = grid(), grid(0.2)[0]

    def make(self, frame='', scale=1.0):
        self.meshes, self.shapes = [], []
        return adapter.Organ({'name': 'organ', 'frame': frame, 'scale': scale}, 2 ** 32 - 2, self.meshes.append, self.shapes.append)

    def send(self, points, faces=None, **header):
        self.organ.take_surface(received(polygons(points, self.faces if faces is None else faces, **header)))

    def send_points(self, points, **header):
        self.organ.take_vertices(received(cloud(points, **header)))

    def assert_sent(self, meshes, shapes, revision=None):
        """How many meshes and shapes were sent so far, and the last topology."""
        self.assertEqual((len(self.meshes), len(self.shapes)), (meshes, shapes))
        if revision is not None:
            self.assertEqual(self.organ.mesh.topology, (2 ** 32 - 2 + revision) % 2 ** 32)

    def test_only_new_triangles_are_a_mesh_with_the_next_topology(self):
        self.send(self.points)
        self.assert_sent(1, 0, 1)
        self.send(self.moved)
        self.assert_sent(1, 1, 1)
        self.send(self.points, frame='table')  # Another frame is a mesh of the same topology.
        self.assert_sent(2, 1, 1)
        self.send(self.points, self.faces[::-1])
        self.assert_sent(3, 1, 2)
        self.send(self.points + [(0, 0, 1)], self.faces[::-1])  # It has a vertex that no triangle has.
        self.assert_sent(4, 1, 3)
        mesh = self.meshes[-1]
        self.assertEqual((mesh.organ, mesh.header.frame_id, mesh.header.stamp), ('organ', 'liver', rospy.Time(100)))
        np.testing.assert_array_equal(mesh.vertices.reshape(-1, 3), np.float32(self.points + [(0, 0, 1)]))
        np.testing.assert_array_equal(mesh.triangles.reshape(-1, 3), self.faces[::-1])
        self.send([], [])
        self.assertEqual((len(self.meshes[-1].vertices), self.organ.mesh), (0, None))
        self.send(self.points)
        self.assert_sent(6, 1, 4)

    def test_the_first_shape_of_a_restarted_sender_replaces_the_organ(self):
        def hear(name, *still_open):
            self.organ.hear(senders.setdefault(name, {'callerid': name[:2], 'topic': name[2:]}),
                            lambda sender: sender in [senders[each] for each in still_open])

        senders = {}
        hear('/a mesh')
        self.send(self.points)
        hear('/a points', '/a mesh')
        hear('/b mesh', '/a mesh', '/a points')  # Two senders at a time are no restart.
        hear('/a mesh')
        self.send_points(self.points)
        self.assert_sent(1, 1, 1)
        hear('/c mesh')  # All others are gone.
        self.send(self.moved)  # A removal comes first.
        self.assert_sent(3, 1, 2)
        senders['/c mesh'] = {'callerid': '/c', 'topic': ' mesh', 'again': 1}
        hear('/c mesh')  # The same name, before the first connection is closed.
        self.send_points(self.points)
        self.assert_sent(5, 1, 3)
        hear('/c points', '/c mesh')
        self.send_points(self.moved)
        self.assert_sent(5, 2, 3)
        self.assertEqual([len(mesh.triangles) for mesh in self.meshes], [24, 0, 24, 0, 24])

    def test_what_the_collision_node_refuses_is_sent_but_not_remembered(self):
        self.assert_refused(lambda: self.send_points(self.points), 'no mesh', '9 vertices', "'organ'")
        self.send(self.points)
        self.assert_refused(lambda: self.send_points(self.points[1:]), 'wrong number of vertices', '8 vertices', 'has, 9')
        far = self.points[:-1] + [(1e30, 0, 0)]
        self.send_points(far)
        self.send_points(self.moved, frame='table')
        self.assert_sent(1, 2, 1)
        self.send(self.points, [(0, 1, 9)])
        self.assert_sent(2, 2, 1)
        np.testing.assert_array_equal(self.organ.mesh.vertices.reshape(-1, 3), np.float32(self.points))
        np.testing.assert_array_equal(self.organ.mesh.triangles.reshape(-1, 3), self.faces)

    def test_frames_and_units(self):
        self.assert_refused(lambda: self.send(self.points, frame=''), 'no frame', "'organ'", "'frame'")
        self.assert_refused(lambda: self.send(self.points, frame='a\nb'), 'illegal name', "frame 'a b'")
        self.organ = self.make('liver', 0.25)
        self.organ.take_surface(received(shape(self.points, self.faces)))
        self.send_points(self.moved, frame='/camera', stamp=rospy.Time())
        np.testing.assert_allclose(self.organ.mesh.vertices.reshape(-1, 3), np.float32(self.moved) / 4)
        self.assertEqual(self.organ.mesh.header.frame_id, 'liver')
        self.assertAlmostEqual(self.organ.mesh.header.stamp.to_sec(), rospy.get_time(), delta=60)
        self.organ = self.make('liver', 1e38)
        self.assert_refused(lambda: self.send([(1e8, 0, 0)], []), 'not finite', 'x of vertex 0 is 1e+46')

    def test_the_first_marker_is_the_organ_until_it_is_deleted_or_its_lifetime_is_over(self):
        def take(**fields):
            self.organ.take_surface(received(marker(self.points, **fields)))

        self.assert_refused(lambda: take(id=2, type=0), 'other marker type')
        take(points=[])  # It keeps its name.
        take()
        for other in ({'ns': 'tools'}, {'id': 4}, {'id': 4, 'action': Marker.DELETE}):
            self.assert_refused(lambda: take(**other), 'other marker', "'organs/3'")
        take(action=Marker.DELETE)
        self.assertIsNone(self.organ.mesh)
        take(id=4)
        take(ns='any', action=Marker.DELETEALL)
        self.assertIsNone(self.organ.mesh)
        take(lifetime=rospy.Duration(50))
        self.organ.expire()
        self.assertIsNotNone(self.organ.mesh)
        self.organ.end -= 50
        self.organ.expire()
        self.assertEqual((self.organ.mesh, len(self.meshes[-1].triangles)), (None, 0))
        take(id=5)
        self.assertIsNotNone(self.organ.mesh)


class ParameterTest(unittest.TestCase):
    def parse(self, **second):
        rows = [{'name': 'liver', 'topic': 'sim/liver', 'vertices_topic': 'sim/points'},
                {'name': 'spleen', 'topic': 'b', **second}]
        return adapter.organs_of(adapter.Group('~', {'organs': rows}, adapter.PARAMETERS))

    def test_are_taken(self):
        self.assertEqual(self.parse(frame='/spleen_frame', scale=1)[1],
                         {'name': 'spleen', 'topic': 'b', 'frame': 'spleen_frame', 'vertices_topic': '', 'scale': 1.0})
        with self.assertRaisesRegex(ValueError, r'^~organs\[1\]/frame_id is no parameter; legal are name, topic, '):
            self.parse(frame_id='x')

    def test_are_refused_with_their_value_and_what_is_legal(self):
        for key, value, word in (
                ('name', '', 'not empty'), ('name', 'liver', 'unique'), ('name', 257 * 'x', '256 bytes'),
                ('frame', 'a\nb', 'control'), ('frame', '', 'not empty'), ('frame', '/', 'TF frame'),
                ('topic', 3, 'text'), ('topic', 'sim liver', 'name'),
                ('topic', '~mesh', 'not private'), ('topic', 'sim/liver', 'unique'), ('topic', 'sim/points', 'unique'),
                ('vertices_topic', 'b', 'unique'), ('vertices_topic', '', 'not empty'), ('scale', 0, 'above 0'),
                ('scale', -0.001, 'above 0'), ('scale', math.inf, 'above 0'), ('scale', '1e-3', 'without quotes'),
                ('scale', True, 'above 0')):
            with self.assertRaisesRegex(ValueError, r'^~organs\[1\]/%s is .*%s' % (key, word), msg=(key, value)):
                self.parse(**{key: value})


if __name__ == '__main__':
    unittest.main(verbosity=2)
