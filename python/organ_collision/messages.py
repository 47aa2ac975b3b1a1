"""Messages from numpy arrays. The bytes of an array go into the message as they are, without a loop in Python."""

from geometry_msgs.msg import Point, Pose, Quaternion
import numpy as np
import rospy
from rospy.numpy_msg import numpy_msg
from std_msgs.msg import Header

from organ_collision.arrays import face_array, points_array, poses_array, vertex_array
from organ_collision.msg import LinkMotion, OrganMesh, OrganVertices, ToolMotion

# Subclasses of the messages, which write numpy arrays. Any publisher of the messages publishes them.
ArrayMesh, ArrayVertices = numpy_msg(OrganMesh), numpy_msg(OrganVertices)


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
    return ArrayMesh(_header(organ, frame, stamp), organ, _revision(topology), vertices.ravel(), faces.ravel())


def organ_vertices(organ, vertices, frame=None, topology=0, stamp=None):
    """An OrganVertices: new positions of all vertices of an OrganMesh, in the same order. See organ_mesh."""
    return ArrayVertices(_header(organ, frame, stamp), organ, _revision(topology), vertex_array(vertices).ravel())


def shaft_motion(trocar, tip, radius, previous_trocar=None, previous_tip=None):
    """A ToolMotion. All points are three numbers (x, y, z) [m], the radius is in metres.

    trocar, tip                    the ends of the shaft's axis at the end of the motion
    previous_trocar, previous_tip  the same at its start; None: where it is at the end
    """
    previous_trocar = trocar if previous_trocar is None else previous_trocar
    previous_tip = tip if previous_tip is None else previous_tip
    return ToolMotion(Point(*previous_trocar), Point(*previous_tip), Point(*trocar), Point(*tip), radius)


def shaft_motions(trocars, tips, radius, previous_trocars=None, previous_tips=None):
    """A list of k ToolMotions. Points are k x 3 arrays; without previous ones, that end rests. See shaft_motion.

    The radius may be 0 for a tool of the node: then it is the tool's. Raises ValueError if a shape is illegal.
    """
    ends = [points_array(tips if points is None else points, name) for name, points, tips in (
        ('trocars', trocars, None), ('tips', tips, None), ('previous_trocars', previous_trocars, trocars),
        ('previous_tips', previous_tips, tips))]
    if len({len(points) for points in ends}) > 1:
        raise ValueError('%d trocars, %d tips, %d previous trocars and %d previous tips; must be equally many'
                         % tuple(len(points) for points in ends))
    return [shaft_motion(trocar, tip, radius, *previous) for trocar, tip, *previous in zip(*ends)]


def link_motions(links, previous=None):
    """A list of k LinkMotions, one for each motion of a tool with l links.

    links     the poses of the links at the end of each motion: k x l x 7 numbers, position [m] and quaternion
              (x, y, z, w), or k x l x 4 x 4 matrices; in the order of the tool's links, without its shaft
    previous  the same at the start of each motion; None: there is none, for static queries

    Raises ValueError if a shape is illegal or a matrix is no pose.
    """
    ends = _poses(links, 'links')
    starts = [()] * len(ends) if previous is None else _poses(previous, 'previous')
    if len(starts) != len(ends):
        raise ValueError('%d poses of links and %d previous ones; must be equally many' % (len(ends), len(starts)))
    return [LinkMotion(list(start), list(end)) for start, end in zip(starts, ends)]


def _poses(poses, name):
    """The Pose messages of each motion."""
    return [[Pose(Point(*row[:3]), Quaternion(*row[3:])) for row in motion]
            for motion in poses_array(poses, name).tolist()]


def _revision(topology):
    if isinstance(topology, bool) or not isinstance(topology, (int, np.integer)) or not 0 <= topology < 2 ** 32:
        raise ValueError('topology is %r; must be a whole number from 0 to 4294967295' % (topology,))
    return int(topology)


def _header(organ, frame, stamp):
    if not (stamp is None or isinstance(stamp, rospy.Time)):
        raise ValueError('stamp is %r; must be a rospy.Time, such as rospy.Time.from_sec(1.5), or None' % (stamp,))
    return Header(frame_id=organ if frame is None else frame, stamp=rospy.Time() if stamp is None else stamp)
