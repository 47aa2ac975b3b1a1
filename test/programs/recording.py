"""Bags as `rosbag record` writes them, the program replay, and a test case that records a bag and replays it."""

import os

import genpy
from geometry_msgs.msg import PoseStamped, Quaternion, TransformStamped, Vector3
from organ_collision.msg import OrganMesh, OrganVertices
import rosbag
from rosgraph_msgs.msg import Clock
from tf2_msgs.msg import TFMessage

from support import scenes
from support.contact_case import ContactCase

from program import ProgramCase

WORLD_LIVER = scenes.Pose((0.2, 0.35, -0.1, 0.9), (0.7, -0.4, 1.1))
TURN = (0.1, 0.2, 0.3, 0.9)
CONTACTS = '/organ_collision/contacts'
TOOLS = 'tools:\n  - {name: hook, trocar_frame: hook_trocar, tip_frame: hook_tip, radius: 0.005}\n'


def stamp(seconds):
    return genpy.Time(0, round(seconds * 1e9))


class Recording:
    """A bag that is being recorded. Times are in seconds: `at` is when the recorder got a message,
    and `time` is the message's stamp. `at` is `time` if it is not given."""

    def __init__(self, path, node='/organ_collision', compression='none'):
        self.bag = rosbag.Bag(path, 'w', compression)
        self.node = node
        self.publishers, self.connections = {}, {}

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.bag.close()

    def write(self, topic, message, at):
        self.bag.write(topic, message, stamp(at))

    def of_version(self, topic, kind, md5sum, at):
        """An empty message of another version of a type."""
        other = type(kind.__name__, (kind,), {'_md5sum': md5sum})
        self.bag.write(topic, (kind._type, b'', md5sum, None, other), stamp(at), raw=True)

    def mesh(self, time, mesh, at=None, organ='liver', topology=1, publisher=None):
        message = OrganMesh(organ=organ, topology=topology, vertices=mesh.flat_vertices(), triangles=mesh.flat_faces())
        message.header.frame_id, message.header.stamp = 'liver_frame', stamp(time)
        self._choose_connection(self.node + '/organ_mesh', publisher)
        self.write(self.node + '/organ_mesh', message, time if at is None else at)

    def _choose_connection(self, topic, publisher):
        """The next message of a topic is of this publisher. rosbag.Bag has only one connection for
        each topic, but `rosbag record` has one for each publisher."""
        connections = self.bag._topic_connections
        if self.publishers.get(topic) != publisher:
            self.connections[topic, self.publishers.get(topic)] = connections.pop(topic, None)
            known = self.connections.get((topic, publisher))
            if known:
                connections[topic] = known
        self.publishers[topic] = publisher

    def vertices(self, time, mesh, at=None, organ='liver', topology=1):
        message = OrganVertices(organ=organ, topology=topology, vertices=mesh.flat_vertices())
        message.header.frame_id, message.header.stamp = 'liver_frame', stamp(time)
        self.write(self.node + '/organ_vertices', message, time if at is None else at)

    def resting(self, at):
        """The organ's frame on /tf_static."""
        self._transforms('/tf_static', at, 0.0, ('liver_frame', WORLD_LIVER))

    def tool(self, time, axis, at=None, tool='hook'):
        """A tool's axis (trocar, tip) in the organ's frame, on /tf."""
        poses = [scenes.Pose(TURN, WORLD_LIVER.apply(point)) for point in axis]
        frames = [(tool + '_trocar', poses[0]), (tool + '_tip', poses[1])]
        self._transforms('/tf', time if at is None else at, time, *frames)

    def frame(self, time, frame, point, at=None):
        """A frame at a point of the organ's frame, and parallel to it, on /tf."""
        pose = scenes.Pose(WORLD_LIVER.rotation, WORLD_LIVER.apply(point))
        self._transforms('/tf', time if at is None else at, time, (frame, pose))

    def _transforms(self, topic, at, time, *frames):
        message = TFMessage()
        for frame, pose in frames:
            transform = TransformStamped(child_frame_id=frame)
            transform.header.frame_id, transform.header.stamp = 'world', stamp(time)
            transform.transform.translation = Vector3(*pose.translation)
            transform.transform.rotation = Quaternion(*pose.rotation)
            message.transforms.append(transform)
        self.write(topic, message, at)

    def pose(self, topic, time, point, at=None, turn=(0.0, 0.0, 0.0, 1.0)):
        """The pose of a tip, or of a marker, in the organ's frame."""
        pose = PoseStamped()
        pose.header.frame_id, pose.header.stamp = 'liver_frame', stamp(time)
        pose.pose.position.x, pose.pose.position.y, pose.pose.position.z = point
        pose.pose.orientation = Quaternion(*turn)
        self.write(topic, pose, time if at is None else at)

    def clock(self, time, at):
        self.write('/clock', Clock(stamp(time)), at)


def messages(path, topic=CONTACTS):
    """The (time, message) of one topic of a bag. Times are in seconds."""
    with rosbag.Bag(path) as bag:
        return [(at.to_sec(), message) for _, message, at in bag.read_messages([topic])]


def serialized(path):
    """The (topic, type, time, bytes) of all messages of a bag."""
    with rosbag.Bag(path) as bag:
        return [(topic, raw[0], at.to_nsec(), raw[1]) for topic, raw, at in bag.read_messages(raw=True)]


class ReplayCase(ProgramCase, ContactCase):
    def setUp(self):
        super().setUp()
        self.recorded, self.answers = self.path('in.bag'), self.path('out.bag')

    def path(self, name):
        return str(self.folder / name)

    def record(self, **named):
        return Recording(self.recorded, **named)

    def replay(self, parameters=TOOLS, options=(), out='out.bag'):
        """Replays the recorded bag. Returns what subprocess.run returns."""
        done = self.run_with(parameters, *options, 'in.bag', out)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def answers_of(self, *arguments, **named):
        """Replays the recorded bag. Returns (time, answer) for each answer."""
        self.replay(*arguments, **named)
        return messages(self.answers)

    def run_with(self, parameters, *arguments):
        """Runs replay with a file of parameters. Returns what subprocess.run returns."""
        self.write('parameters.yaml', parameters)
        return self.run_program('--parameters', 'parameters.yaml', *arguments, program=os.environ['REPLAY'])

    def assert_refused(self, done, *words, status=2):
        """One line on stderr with these words, the exit code, and no new file."""
        self.assertEqual((done.returncode, done.stdout), (status, ''), done.stderr)
        self.assertRegex(done.stderr, r'\A.*\n\Z')
        for word in words:
            self.assertIn(word, done.stderr)
        self.assertFalse([name for name in os.listdir(self.folder) if name.startswith('out')])
