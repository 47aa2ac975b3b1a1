"""An organ that a Python program sends to the collision node."""

import threading
import time

import numpy as np
import rospy

from organ_collision.messages import organ_mesh, organ_vertices
from organ_collision.msg import OrganMesh, OrganVertices
from organ_collision.srv import ListOrgans

_QUEUE = 100  # [messages] A program may move several organs at once.
_PATIENCE = 2.0  # [s]


class Organ(rospy.SubscribeListener):
    """Publishes an organ. A node that starts later, or again, gets the latest shape when it connects. So this is like
    a latched topic, but also works if a program has several organs.

    name      the organ's name
    vertices  n x 3 numbers [m], in the organ's frame
    faces     m x 3 vertex indices, counted from 0; normals point outward by the right-hand rule
    frame     the organ's frame; None: the frame has the name of the organ
    node      name of the collision node
    stamp     rospy.Time at which the organ has this shape; None: zero, for which the node uses the latest transforms

    All methods raise ValueError if a shape or a value is illegal; nothing is sent then.
    """

    # rospy connects in threads of its own, and all organs share its publishers' buffers.
    _lock = threading.Lock()

    def __init__(self, name, vertices, faces, frame=None, node='/organ_collision', stamp=None):
        self._mesh, self._taken = _with_faces(organ_mesh(name, vertices, faces, frame, stamp=stamp)), None
        self._organs = rospy.ServiceProxy(node + '/list_organs', ListOrgans)
        self._shapes = rospy.Publisher(node + '/organ_vertices', OrganVertices, queue_size=_QUEUE)
        self._meshes = rospy.Publisher(node + '/organ_mesh', OrganMesh, self, queue_size=_QUEUE)
        self._send_mesh(self._mesh)

    @property
    def topology(self):
        """The revision of the faces, as the node's answers name it: 0 at first. replace() and remove() raise it by 1."""
        return self._mesh.topology

    def move(self, vertices, stamp=None):
        """Sends a new shape: n x 3 positions of the same vertices, in the same order.

        The first one waits until the node has taken the mesh, for at most 2 s: the node refuses vertices that come before
        their mesh, and messages of two topics overtake each other.
        """
        mesh = self._mesh
        shape = organ_vertices(mesh.organ, vertices, mesh.header.frame_id, mesh.topology, stamp)
        if len(shape.vertices) != len(mesh.vertices):
            raise ValueError('%d vertices; %s has %d. For another mesh, call replace()'
                             % (len(vertices), mesh.organ, len(mesh.vertices) // 3))
        if self._taken is not mesh:
            self._wait_until_taken(mesh)
        with self._lock:
            mesh.vertices, mesh.header.stamp = shape.vertices, shape.header.stamp
            self._shapes.publish(shape)

    def replace(self, vertices, faces, stamp=None):
        """Sends other triangles, as after a cut."""
        self._send_mesh(_with_faces(self._next_mesh(vertices, faces, stamp)))

    def remove(self):
        """Removes the organ from the node."""
        self._send_mesh(self._next_mesh(np.empty((0, 3)), np.empty((0, 3))))

    def _next_mesh(self, vertices, faces, stamp=None):
        old = self._mesh
        return organ_mesh(old.organ, vertices, faces, old.header.frame_id, old.topology + 1, stamp)

    def _wait_until_taken(self, mesh):
        end = time.monotonic() + _PATIENCE
        known = (mesh.organ, mesh.topology, len(mesh.vertices) // 3)
        while self._shapes.get_num_connections() > 0 and time.monotonic() < end and not rospy.is_shutdown():
            try:
                if known in [(organ.name, organ.topology, organ.vertices) for organ in self._organs().organs]:
                    self._taken = mesh
                    return
            except rospy.ServiceException:  # The node has gone, or does not serve yet.
                pass
            rospy.rostime.wallsleep(0.01)

    def _send_mesh(self, mesh):
        with self._lock:
            self._mesh = mesh
            self._meshes.publish(mesh)

    def peer_subscribe(self, topic_name, topic_publish, peer_publish):
        """rospy calls this for each new subscriber."""
        with self._lock:
            self._taken = None
            peer_publish(self._mesh)


def _with_faces(mesh):
    """Refuses a mesh without faces, because it would remove the organ."""
    if not len(mesh.triangles):
        raise ValueError('%s has no faces; an organ has at least one, and remove() removes it' % mesh.organ)
    return mesh
