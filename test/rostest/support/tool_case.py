"""Test cases with tools that move by TF, also by a simulator's clock. Their points are in the organ's frame, which is
rotated and shifted in the world. The tools' frames are sent in the world frame."""

import threading

from organ_collision.msg import ContactArray
import rospy
from rosgraph_msgs.msg import Clock

from . import scenes
from .contact_case import ContactCase
from .node_client import FAR_AWAY, NodeClient, TfSender, wait_until

WORLD_LIVER = scenes.Pose((0.2, 0.35, -0.1, 0.9), (0.7, -0.4, 1.1))
STEP = rospy.Duration(0, 10**7)
OUT_OF_REACH = 'out_of_reach'  # an organ that no tool touches


class ToolCase(ContactCase):
    node_name = '/organ_collision'
    link_frames = {}  # {tool with links: its frames, whose origins `place` places}

    @classmethod
    def setUpClass(cls):
        cls.node = NodeClient(cls.node_name)
        cls.tf = TfSender()
        cls.tf.wait_for(cls.node)
        cls.tf.send_resting(('world', 'liver_frame', WORLD_LIVER))
        cls.stamp = rospy.Time.now()
        cls.node.bring(OUT_OF_REACH, scenes.one_face().moved(lambda v: (v[0] + 100.0, v[1], v[2])))

    def setUp(self):
        self.organ = self.id().split('.')[-1]

    @classmethod
    def next_stamp(cls, step=STEP):
        """The next stamp, one step of 10 ms later. Stamps rise from test to test, too."""
        cls.stamp += step
        return cls.stamp

    def place(self, tool, *way):
        """Sends the tool's frames at each (axis, stamp) of `way`. The axis is (trocar, tip) in the organ's frame, or
        one point for each of the tool's frames."""
        frames = self.link_frames.get(tool) or (tool + '_trocar', tool + '_tip')
        turn = (0.1, 0.2, 0.3, 0.9)
        self.tf.send(*[('world', frame, scenes.Pose(turn, WORLD_LIVER.apply(point)), stamp)
                       for axis, stamp in way for frame, point in zip(frames, axis)])

    def place_and_wait(self, tool, axis, stamp):
        """Sends the tool's frames at one time, and waits until the node has received them."""

        def is_there():
            result = self.node.query(OUT_OF_REACH, tool=tool, stamp=stamp)
            seen[:] = [result.status, result.message]
            return result.status == ContactArray.OK

        seen = []
        self.place(tool, (axis, stamp))
        wait_until(is_there, lambda: 'the pose of %s at %s: %s' % (tool, stamp, seen))

    def step(self, shape, tools, topology=1, vertices=False, step=STEP):
        """One step: the tools are at `tools` ({name: axis}) when the organ has this shape. Returns {name: the
        ContactArray about this tool}. The poses are sent first, so that the node never has to wait for a transform."""
        stamp = self.next_stamp(step)
        for tool, axis in tools.items():
            self.place_and_wait(tool, axis, stamp)
        send = self.node.send_vertices if vertices else self.node.send_mesh
        send(self.organ, shape, stamp, topology)
        return {tool: self.node.contacts.wait_for(self.organ, tool, mesh_stamp=stamp) for tool in tools}


class SimulatedClock:
    """Publishes /clock a hundred times a second until it is stopped. Who holds `lock` stops the time."""

    def __init__(self, seconds):
        self.publisher = rospy.Publisher('/clock', Clock, queue_size=100)
        self.lock = threading.RLock()
        self.stopped = threading.Event()
        self.now = rospy.Time(seconds)
        self.thread = threading.Thread(target=self._run, daemon=True)
        self.thread.start()
        wait_until(lambda: rospy.get_time() >= seconds, 'simulated time')

    def _run(self):
        while not self.stopped.wait(0.01):
            self.tick()

    def tick(self, step=STEP):
        with self.lock:
            self.now += step
            self.publisher.publish(self.now)

    def stop(self):
        self.stopped.set()
        self.thread.join()


class SimulatedCase(ToolCase):
    """Stamps rise with the simulator's clock."""

    @classmethod
    def setUpClass(cls):
        cls.clock = SimulatedClock(seconds=100)
        super().setUpClass()

    @classmethod
    def tearDownClass(cls):
        cls.clock.stop()

    @classmethod
    def next_stamp(cls, step=STEP):
        """The clock is then not behind this stamp."""
        with cls.clock.lock:
            if super().next_stamp(step) > cls.clock.now:
                cls.clock.tick(cls.stamp - cls.clock.now)
        return cls.stamp

    def jump(self, seconds):
        """Sets the clock. Returns when the stamp of an answer shows that the node has the new time."""

        def is_there():
            return time <= self.node.query('nobody', FAR_AWAY).header.stamp <= self.clock.now

        time = rospy.Time(seconds)
        with self.clock.lock:
            self.clock.now = time
        wait_until(is_there, 'the node at %g s' % seconds)
        type(self).stamp = time

    def assert_no_transform(self, result, *words):
        self.assertEqual((result.status, result.contacts), (ContactArray.NO_TRANSFORM, []), result.message)
        for word in words:
            self.assertIn(word, result.message)
