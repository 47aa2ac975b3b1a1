"""What the scripts share that take pictures of the running node: a ROS master, the demo's liver at rest, one tool
that moves in steps, and RViz without a display."""

import contextlib
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time

from geometry_msgs.msg import TransformStamped
import numpy as np
from organ_collision.msg import ContactArray, OrganMesh
import rosgraph
import roslib.packages
import rospy
from std_srvs.srv import Empty
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray
import yaml

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.append(os.path.join(HERE, '..', '..', 'scripts'))
import view  # noqa: E402

NODE = '/organ_collision'
LIMIT = 60.0  # [s] longest wait for anything


@contextlib.contextmanager
def started(*command, **environment):
    """Runs a command until the end of a `with` block."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, env={**os.environ, **environment})
    try:
        yield process
    finally:
        process.send_signal(signal.SIGINT)
        process.wait()


def wait_until(condition, what):
    end = time.monotonic() + LIMIT
    while not condition():
        if time.monotonic() > end:
            raise SystemExit('waited %g s for %s' % (LIMIT, what))
        time.sleep(0.01)


def free_port():
    with socket.socket() as free:
        free.bind(('', 0))
        return free.getsockname()[1]


@contextlib.contextmanager
def ros_master(name):
    """A ROS master of its own, and this script as the node `name`, until the end of a `with` block."""
    port = free_port()
    os.environ['ROS_MASTER_URI'] = 'http://localhost:%d' % port
    os.environ['ROS_HOSTNAME'] = 'localhost'
    with started('roscore', '-p', str(port)):
        wait_until(rosgraph.is_master_online, 'the ROS master')
        rospy.init_node(name, disable_signals=True)
        yield


def demo_tools():
    with open(os.path.join(HERE, '..', '..', 'config', 'demo_tools.yaml')) as tools:
        return yaml.safe_load(tools)['tools']


def liver():
    """The demo's liver at rest: the first mesh of the demo's simulator."""
    rospy.set_param('/demo/tools', demo_tools())
    with started('rosrun', 'organ_collision', 'organ_collision_node', '__name:=demo'):
        with started('rosrun', 'organ_collision', 'liver_simulator', '_collision_node:=/demo'):
            return rospy.wait_for_message('/demo/organ_mesh', OrganMesh, LIMIT)


@contextlib.contextmanager
def collision_node(*tools, **parameters):
    """The collision node with these tools, until the end of a `with` block."""
    rospy.set_param(NODE, {'tools': list(tools), 'tf_timeout_sec': LIMIT, **parameters})
    with started('rosrun', 'organ_collision', 'organ_collision_node', '__name:=' + NODE[1:]):
        yield


class Camera:
    """Where the viewer is: azimuth and elevation [degrees], what is in the middle of the picture, how far away it is
    [m]; the picture's size [pixels]; the background, as RViz writes colours."""

    FIELD_OF_VIEW = 0.785  # [rad] vertical

    def __init__(self, view, target, distance, size, background='255; 255; 255'):
        self.view, self.target, self.distance, self.size = view, np.array(target), distance, size
        self.background = background

    def pixel(self, place):
        """Where the picture shows a place of its frame: from the left and from the top."""
        azimuth, elevation = np.radians(self.view)
        right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
        back = np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
        way = np.array(place) - self.target
        scale = 0.5 * self.size[1] / np.tan(0.5 * self.FIELD_OF_VIEW) / (self.distance - way @ back)
        return (0.5 * self.size[0] + scale * (way @ right), 0.5 * self.size[1] - scale * (way @ np.cross(back, right)))


def rviz_picture(output, camera, markers, frame='liver'):
    """A picture of RViz, which shows the markers that StillMarkers.still() has published. Needs rviz, xvfb and
    imagemagick."""
    with open(os.path.join(HERE, '..', '..', view.CONFIGURATION)) as text:
        configuration = yaml.safe_load(text)
    manager = configuration['Visualization Manager']
    manager['Global Options'].update({'Fixed Frame': frame, 'Background Color': camera.background})
    manager['Displays'] = [{'Class': 'rviz/MarkerArray', 'Name': 'still', 'Enabled': True, 'Namespaces': {},
                            'Marker Topic': markers.publisher.resolved_name, 'Queue Size': 4000}]
    orbit = manager['Views']['Current']
    orbit['Yaw'], orbit['Pitch'] = map(float, np.radians(camera.view))
    orbit['Distance'], orbit['Focal Point'] = camera.distance, dict(zip('XYZ', map(float, camera.target)))
    orbit['Field of View'] = camera.FIELD_OF_VIEW
    rviz, *_ = roslib.packages.find_node('rviz', 'rviz')
    with tempfile.NamedTemporaryFile('w', suffix='.rviz') as file:
        yaml.safe_dump(configuration, file)
        file.flush()
        view.take_picture(rviz, file.name, camera.size, output)


class StillMarkers:
    """Keeps the markers of topics as RViz does. still() publishes those that are there at that time on the topic `still`,
    for a picture of one moment."""

    def __init__(self, *topics):
        self.markers = {}
        self.publisher = rospy.Publisher('still', MarkerArray, latch=True, queue_size=1)
        self.subscribers = [rospy.Subscriber(topic, MarkerArray, self.note, topic, queue_size=4000) for topic in topics]

    def note(self, array, topic):
        for marker in array.markers:
            key = topic, marker.ns, marker.id
            if marker.action == Marker.DELETEALL:
                self.markers = {known: kept for known, kept in self.markers.items() if known[0] != topic}
            elif marker.action == Marker.DELETE:
                self.markers.pop(key, None)
            else:
                self.markers[key] = marker

    def has(self, namespaces):
        """Whether markers of all these namespaces are there."""
        return namespaces <= {marker.ns for marker in list(self.markers.values())}

    def still(self, namespaces, *others):
        """Publishes the markers of these namespaces, and others."""
        markers = [marker for marker in list(self.markers.values()) if marker.ns in namespaces] + list(others)
        for number, marker in enumerate(markers):
            marker.id, marker.lifetime = number, rospy.Duration()
        self.publisher.publish(markers)


class Scene:
    """The resting liver, and a tool that moves in steps. `trocar`: its place in the liver's frame [m]. The tool's
    frames are `trocar` and `tip`."""

    def __init__(self, mesh, tool, trocar):
        rospy.wait_for_service(NODE + '/reset', LIMIT)
        self.reset = rospy.ServiceProxy(NODE + '/reset', Empty)
        self.answers = {}  # by tool
        self.mesh, self.tool, self.trocar = mesh, tool, trocar
        self.tf = rospy.Publisher('/tf', TFMessage, queue_size=10)
        self.meshes = rospy.Publisher(NODE + '/organ_mesh', OrganMesh, queue_size=10)
        self.contacts = rospy.Subscriber(NODE + '/contacts', ContactArray, self.note)
        wait_until(
            lambda: self.tf.get_num_connections() > 0
            and self.meshes.get_num_connections() > 0
            and self.contacts.get_num_connections() > 0,
            'connections to ' + NODE,
        )

    def note(self, answer):
        if answer.status == ContactArray.OK:
            self.answers[answer.tool] = answer

    def transform(self, child, place, stamp):
        transform = TransformStamped(child_frame_id=child)
        transform.header.frame_id, transform.header.stamp = self.mesh.header.frame_id, stamp
        translation = transform.transform.translation
        translation.x, translation.y, translation.z = place
        transform.transform.rotation.w = 1.0
        return transform

    def move_tool(self, tip):
        """Moves the tip there, and waits for the node's answer."""
        stamp = rospy.Time.now()
        self.tf.publish([self.transform('trocar', self.trocar, stamp), self.transform('tip', tip, stamp)])
        self.mesh.header.stamp = stamp
        self.meshes.publish(self.mesh)
        wait_until(lambda: self.tool in self.answers and self.answers[self.tool].mesh_stamp == stamp, 'contacts')
        return self.answers[self.tool]

    def play(self, tips):
        """Moves the tool through these tips. The reset makes the first one a static position. Returns the last
        answer."""
        self.reset()
        return [self.move_tool(tip) for tip in tips][-1]

    def moment(self, tips, markers, namespaces, *others):
        """Plays the tool's steps until all that these namespaces show is there at one moment, and publishes this moment,
        and other markers, on the topic `still`. Returns the last answer."""
        end = time.monotonic() + LIMIT
        while time.monotonic() < end:
            answer = self.play(tips)
            patience = time.monotonic() + 2.0
            while time.monotonic() < patience:
                if markers.has(namespaces):
                    markers.still(namespaces, *others)
                    return answer
                time.sleep(0.01)
        raise SystemExit('waited %g s for markers of %s' % (LIMIT, ', '.join(sorted(namespaces))))
