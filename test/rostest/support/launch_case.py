"""A test case that runs launch files of the package as a user would, and the checks that several of them need."""

import contextlib
import os
from xml.etree import ElementTree

from geometry_msgs.msg import WrenchStamped
from organ_collision.msg import OrganMesh, OrganVertices
import roslib.packages
import rospy
from sensor_msgs.msg import JointState
from shape_msgs.msg import Mesh
from tf2_msgs.msg import TFMessage

from . import scenes
from .contact_case import ContactCase
from .foreign_meshes import shape_mesh
from .node_client import LIMIT, Log, NodeClient, shaft, wait_until
from .processes import Launched, nodes_online
from .tool_over_sheet import RADIUS, SHEET, at_height, depth_at

PACKAGE = roslib.packages.get_pkg_dir('organ_collision')
# What these nodes of Python send once all their topics are registered at the ROS master. None may be stopped before:
# rospy's signal handler calls the ROS master, and waits forever if it interrupted such a call.
FIRST_MESSAGES = {
    '/simulator': ('/organ_collision/organ_vertices', OrganVertices),
    '/PSM1/joints': ('/PSM1/measured_js', JointState),
    '/PSM2/joints': ('/PSM2/measured_js', JointState),
    '/organ': ('/organ_collision/organ_mesh', OrganMesh),
    '/MTML/force': ('/MTML/body/servo_cf', WrenchStamped),
    '/MTMR/force': ('/MTMR/body/servo_cf', WrenchStamped),
}


def files(folder, ending):
    """The names of a folder's files, with the folder."""
    return {folder + '/' + name for name in os.listdir(os.path.join(PACKAGE, folder)) if name.endswith(ending)}


class FrameLog:
    """The names of all frames that TF knows."""

    def __init__(self):
        self.names = set()
        self.subscribers = [rospy.Subscriber(topic, TFMessage, self._add) for topic in ('/tf', '/tf_static')]

    def _add(self, message):
        for transform in message.transforms:
            self.names |= {transform.header.frame_id, transform.child_frame_id}

    def wait_for(self, frames):
        wait_until(lambda: frames <= self.names, lambda: 'frames %s of TF' % (frames - self.names))
        for subscriber in self.subscribers:
            subscriber.unregister()


class LaunchCase(ContactCase):
    @contextlib.contextmanager
    def launched(self, path, *arguments, ends_itself=False):
        """Runs a launch file of the package. All its nodes start, and at the end they stop cleanly."""
        with Launched(os.path.join(PACKAGE, path), *arguments) as launched:
            self.assertGreater(len(launched.nodes), 0, path)
            if not ends_itself:
                launched.wait_for_nodes()
                for node in set(FIRST_MESSAGES) & set(launched.nodes):
                    rospy.wait_for_message(*FIRST_MESSAGES[node], timeout=LIMIT)
            yield launched
        wait_until(lambda: not set(launched.nodes) & nodes_online(), 'the end of ' + path)
        if not ends_itself:
            self.assertNotIn('has died', launched.printed, path)
        self.assertNotIn('escalating', launched.printed, path)

    def check_collision_node(self, name, process=None):
        """The collision node answers about an organ that only it has."""
        node = NodeClient(name, process=process)
        node.bring('sheet', SHEET, rospy.Time(1))
        self.assert_depth(node.query('sheet', shaft(*at_height(0.002), RADIUS)), depth_at(0.002))
        node.close()

    def check_mesh_adapter(self, organs, collision_node='/organ_collision'):
        """A mesh on each organ's topic reaches the collision node."""
        meshes = Log(collision_node + '/organ_mesh', OrganMesh).wait_for_publisher()
        for organ in organs:
            publisher = rospy.Publisher(organ['topic'], Mesh, queue_size=1)
            wait_until(lambda: publisher.get_num_connections() > 0, organ['topic'])
            publisher.publish(shape_mesh(scenes.sheet(0.1, 4)))
            wait_until(lambda: meshes.last(lambda mesh: mesh.organ == organ['name']), 'a mesh of ' + organ['name'])
            publisher.unregister()

    def check_robot(self, urdf_file, replaced=('', '')):
        """TF knows all links of the robot, and its mesh files exist."""
        with open(os.path.join(PACKAGE, urdf_file)) as text:
            robot = ElementTree.fromstring(text.read().replace(*replaced) if replaced[0] else text.read())
        FrameLog().wait_for({link.get('name') for link in robot.iter('link')})
        for mesh in robot.iter('mesh'):
            path = mesh.get('filename').replace('package://organ_collision', PACKAGE)
            self.assertTrue(os.path.exists(path), path)
