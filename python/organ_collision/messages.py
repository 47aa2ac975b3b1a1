"""Messages from numpy arrays. The bytes of an array go into the message as they are, without a loop in Python."""

from geometry_msgs.msg import Point
import rospy
from rospy.numpy_msg import numpy_msg
from std_msgs.msg import Header

from organ_collision.arrays import face_array, vertex_array
from organ_collision.msg import OrganMesh, OrganVertices, ToolMotion

# Subclasses of the messages, which write numpy arrays. Any publisher of the messages publishes them.
_ArrayMesh, _ArrayVertices = numpy_msg(OrganMesh), numpy_msg(OrganVertices)


def organ_mesh(organ, vertices, faces, frame=None, topology=0, stamp=None):
    """An OrganMesh.

    organ     name of the organ
    vertices  n x 3 numbers [m], in the organ's frame
    faces     m x 3 vertex indices, counted from 0; normals point outward by the right-hand rule
    frame     the organ's frame; None: the frame has the name of the organ
    topology  revision of the faces: other faces need a higher one
    stamp     rospy.Time at which the organ has this shape; None: zero, for which the node uses the latest transforms

    The message keeps copies of the arrays. Raises ValueError if a shape or a value is illegal.
    """
    vertices = vertex_array(vertices)
    faces = face_array(faces, len(vertices))
    return _ArrayMesh(_header(organ, frame, stamp), organ, topology, vertices.ravel(), faces.ravel())


def organ_vertices(organ, vertices, frame=None, topology=0, stamp=None):
    """An OrganVertices: new positions of all vertices of an OrganMesh, in the same order. See organ_mesh."""
    return _ArrayVertices(_header(organ, frame, stamp), organ, topology, vertex_array(vertices).ravel())


def shaft_motion(trocar, tip, radius, previous_trocar=None, previous_tip=None):
    """A ToolMotion. All points are three numbers (x, y, z) [m], the radius is in metres.

    trocar, tip                    the ends of the shaft's axis at the end of the motion
    previous_trocar, previous_tip  the same at its start; None: where it is at the end
    """
    previous_trocar = trocar if previous_trocar is None else previous_trocar
    previous_tip = tip if previous_tip is None else previous_tip
    return ToolMotion(Point(*previous_trocar), Point(*previous_tip), Point(*trocar), Point(*tip), radius)


def _header(organ, frame, stamp):
    return Header(frame_id=organ if frame is None else frame, stamp=rospy.Time() if stamp is None else stamp)
