"""A simulator's clock, and a test case that runs by it."""

import threading

from organ_collision.msg import ContactArray
import rospy
from rosgraph_msgs.msg import Clock

from .node_client import FAR_AWAY, wait_until
from .tool_case import STEP, ToolCase


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
            with self.lock:
                self.tick()

    def tick(self, step=rospy.Duration(0, 10**7)):
        with self.lock:
            self.now += step
            self.publisher.publish(self.now)

    def jump(self, time):
        with self.lock:
            self.now = time

    def stop(self):
        self.stopped.set()
        self.thread.join()


class SimulatedCase(ToolCase):
    """Stamps rise with the simulator's clock."""

    start = 100  # [s]

    @classmethod
    def setUpClass(cls):
        cls.clock = SimulatedClock(cls.start)
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
        self.clock.jump(time)
        wait_until(is_there, 'the node at %g s' % seconds)
        type(self).stamp = time

    def assert_no_transform(self, result, *words):
        self.assertEqual((result.status, result.contacts), (ContactArray.NO_TRANSFORM, []), result.message)
        for word in words:
            self.assertIn(word, result.message)
