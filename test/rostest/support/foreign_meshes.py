"""Meshes in the messages of other packages, as simulators publish them."""

import struct

from geometry_msgs.msg import Point
from pcl_msgs.msg import PolygonMesh, Vertices
import rospy
from sensor_msgs.msg import PointCloud2, PointField
from shape_msgs.msg import Mesh, MeshTriangle
from visualization_msgs.msg import Marker


def stamped(message, frame='liver_frame', stamp=rospy.Time()):
    message.header.frame_id, message.header.stamp = frame, stamp
    return message


def shape_mesh(mesh):
    return Mesh(vertices=[Point(*v) for v in mesh.vertices],
                triangles=[MeshTriangle(vertex_indices=f) for f in mesh.faces])


def marker(mesh, **header):
    message = Marker(ns='organs', id=7, type=Marker.TRIANGLE_LIST, action=Marker.ADD)
    message.scale.x = message.scale.y = message.scale.z = message.pose.orientation.w = 1.0
    message.points = [Point(*mesh.vertices[i]) for i in mesh.flat_faces()]
    return stamped(message, **header)


def cloud(vertices, **header):
    """A cloud of one row."""
    message = PointCloud2(height=1, width=len(vertices), point_step=12, row_step=12 * len(vertices), is_dense=True)
    message.fields = [PointField(name, 4 * i, PointField.FLOAT32, 1) for i, name in enumerate('xyz')]
    message.data = b''.join(struct.pack('<3f', *v) for v in vertices)
    return stamped(message, **header)


def polygon_mesh(mesh, **header):
    message = PolygonMesh(cloud=cloud(mesh.vertices, frame=''), polygons=[Vertices(vertices=f) for f in mesh.faces])
    return stamped(message, **header)
