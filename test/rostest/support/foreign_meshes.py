"""Meshes in the messages of other packages, as simulators publish them."""

import struct

from geometry_msgs.msg import Point, Pose, Quaternion
from pcl_msgs.msg import PolygonMesh, Vertices
import rospy
from sensor_msgs.msg import PointCloud2, PointField
from shape_msgs.msg import Mesh, MeshTriangle
from visualization_msgs.msg import Marker

from . import scenes

FORMATS = {PointField.FLOAT32: 'f', PointField.FLOAT64: 'd'}


def shape_mesh(mesh):
    return Mesh(vertices=[Point(*v) for v in mesh.vertices],
                triangles=[MeshTriangle(vertex_indices=f) for f in mesh.faces])


def marker(mesh, frame='liver_frame', stamp=rospy.Time(), name=('organs', 7), pose=scenes.IDENTITY, scale=(1, 1, 1)):
    """A TRIANGLE_LIST that shows `mesh` after its `pose` and `scale` are applied."""
    message = Marker(ns=name[0], id=name[1], type=Marker.TRIANGLE_LIST, action=Marker.ADD)
    message.header.frame_id, message.header.stamp = frame, stamp
    message.scale.x, message.scale.y, message.scale.z = scale
    message.pose = Pose(Point(*pose.translation), Quaternion(*pose.rotation))
    back = pose.inverse()
    for face in range(len(mesh.faces)):
        for corner in mesh.face(face):
            message.points.append(Point(*[c / s for c, s in zip(back.apply(corner), scale)]))
    return message


def deletion(action, name=('organs', 7)):
    return Marker(ns=name[0], id=name[1], action=action)


def cloud(vertices, frame='liver_frame', stamp=rospy.Time(), order='xyz', datatype=PointField.FLOAT32, padding=0,
          big_endian=False):
    """A cloud of one row. Each point has its coordinates in this order, then `padding` bytes."""
    number = ('>' if big_endian else '<') + FORMATS[datatype]
    size = struct.calcsize(number)
    message = PointCloud2(height=1, width=len(vertices), is_bigendian=big_endian, is_dense=True)
    message.header.frame_id, message.header.stamp = frame, stamp
    message.fields = [PointField(name, i * size, datatype, 1) for i, name in enumerate(order)]
    message.point_step = 3 * size + padding
    message.row_step = message.point_step * message.width
    message.data = b''.join(b''.join(struct.pack(number, v['xyz'.index(name)]) for name in order) + b'\xa5' * padding
                            for v in vertices)
    return message


def polygon_mesh(mesh, frame='liver_frame', stamp=rospy.Time(), **layout):
    message = PolygonMesh(cloud=cloud(mesh.vertices, '', **layout))
    message.header.frame_id, message.header.stamp = frame, stamp
    message.polygons = [Vertices(vertices=f) for f in mesh.faces]
    return message
