#!/usr/bin/python3
"""Simulated time. Steps follow the simulator's clock, and a jump back clears all history."""

import sys
import threading
import time

from organ_collision.msg import ContactArray
import rospy
from rosgraph_msgs.msg import Clock
import rostest

from support import oracle, scenes
from support.link_case import LinkCase, ball_contacts
from support.node_client import FAR_AWAY, NodeClient, wait_until

STATIC, SWEPT = ContactArray.STATIC, ContactArray.SWEPT
SHEET = scenes.sheet(0.1, 4)
ABOVE = ((0.3, 0.007, 0.05), (0.013, 0.007, 0.05))
BELOW = ((0.3, 0.007, -0.05), (0.013, 0.007, -0.05))
RADIUS, BALL_RADIUS = 0.005, 0.006


class SimulatedClock:
    """Publishes /clock a hundred times a second until it is stopped."""

    def __init__(self, seconds):
        self.publisher = rospy.Publisher('/clock', Clock, queue_size=100)
        self.lock = threading.Lock()
        self.stopped = threading.Event()
        self.now = rospy.Time(seconds)
        self.thread = threading.Thread(target=self._run, daemon=True)
        self.thread.start()

    def _run(self):
        while not self.stopped.wait(0.01):
            with self.lock:
                self.tick()

    def jump(self, seconds):
        """Sets the time to `seconds`."""
        with self.lock:
            self.now = rospy.Time(seconds)

    def tick(self):
        """Advances the time by 10 ms. The caller must hold the lock."""
        self.now += rospy.Duration(0, 10**7)
        self.publisher.publish(self.now)

    def stop(self):
        self.stopped.set()
        self.thread.join()


class SimulatedTimeTest(LinkCase):
    link_frames = {'ball': ('ball',)}

    @classmethod
    def setUpClass(cls):
        cls.clock = SimulatedClock(100)
        wait_until(lambda: rospy.get_time() > 100, 'simulated time')
        super().setUpClass()

    @classmethod
    def tearDownClass(cls):
        cls.clock.stop()

    def jump(self, seconds):
        """Sets the clock. Returns when the stamp of an answer shows that the node has the new
        time."""

        def is_there():
            now = self.node.query('nobody', FAR_AWAY).header.stamp
            return rospy.Time(seconds) <= now <= self.clock.now

        self.clock.jump(seconds)
        wait_until(is_there, 'the node at %g s' % seconds)
        type(self).stamp = rospy.Time(seconds)

    def stab(self):
        """Moves the tool from above the sheet to below it. Returns the results of both steps."""
        return (
            self.step(SHEET, {'grasper': ABOVE})['grasper'],
            self.step(SHEET, {'grasper': BELOW}, vertices=True)['grasper'],
        )

    def check_stab(self, first, second):
        self.assertEqual(first.mode, STATIC)
        self.assert_contacts(first, [])
        self.assertEqual((second.mode, second.step_start), (SWEPT, first.header.stamp))
        expected = oracle.swept_contacts(SHEET, ABOVE, BELOW, RADIUS)
        self.assertGreater(len(expected), 0)
        self.assert_contacts(second, expected, 1e-6)

    def test_a_stab_in_simulated_time(self):
        self.check_stab(*self.stab())

    def test_a_jump_back_forgets_the_history(self):
        self.jump(500)
        self.check_stab(*self.stab())
        self.jump(200)
        result = self.step(SHEET, {'grasper': ABOVE}, vertices=True)['grasper']
        self.assertEqual((result.mode, result.header.stamp), (STATIC, self.stamp))
        self.assert_contacts(result, [])
        result = self.step(SHEET, {'grasper': BELOW}, vertices=True)['grasper']
        self.assertEqual(result.mode, SWEPT)
        self.assert_contacts(result, oracle.swept_contacts(SHEET, ABOVE, BELOW, RADIUS), 1e-6)

    def test_a_jump_back_forgets_where_links_were(self):
        before, after = ABOVE[1:], BELOW[1:]
        self.jump(900)
        self.step(SHEET, {'ball': before})
        self.jump(400)
        result = self.step(SHEET, {'ball': after}, vertices=True)['ball']
        self.assertEqual((result.mode, result.header.stamp), (STATIC, self.stamp))
        self.assert_contacts(result, [])
        result = self.step(SHEET, {'ball': before}, vertices=True)['ball']
        self.assertEqual(result.mode, SWEPT)
        expected = ball_contacts(SHEET, after, before, BALL_RADIUS)
        self.assertGreater(len(expected), 0)
        self.assert_contacts(result, expected, 1e-6)

    def test_a_jump_back_while_a_transform_is_awaited(self):
        """A shape that awaits a transform of the old time is not evaluated with one of the new
        time."""
        self.jump(800)
        self.step(SHEET, {'grasper': ABOVE})
        self.node.send_vertices(self.organ, SHEET, self.next_stamp())
        self.jump(700)
        result = self.step(SHEET, {'grasper': BELOW}, vertices=True)['grasper']
        self.assertEqual(result.mode, STATIC)
        self.assert_contacts(result, oracle.static_contacts(SHEET, BELOW, RADIUS))

    def test_a_jump_forward_is_a_long_step(self):
        self.jump(300)
        first = self.step(SHEET, {'grasper': ABOVE})['grasper']
        self.jump(304)
        second = self.step(SHEET, {'grasper': BELOW}, vertices=True)['grasper']
        self.check_stab(first, second)

    def test_diagnostics_come_after_a_jump_back(self):
        self.jump(1000)
        wait_until(lambda: self.node.diagnostics, 'diagnostics')
        self.jump(50)
        self.node.diagnostics.clear()
        wait_until(lambda: self.node.diagnostics, 'diagnostics after the jump')

    def test_a_transform_is_awaited_no_longer_than_its_limit_when_the_clock_stands_still(self):
        """A simulator may stop its clock until it has the answer. After 2 s, wall time counts."""
        self.jump(600)
        self.step(SHEET, {'grasper': ABOVE})
        with self.clock.lock:
            stamp = self.next_stamp()
            self.node.send_vertices(self.organ, SHEET, stamp)
            result = self.node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=stamp)
            self.assertEqual(result.status, ContactArray.NO_TRANSFORM)

    def test_a_slow_simulator_is_waited_for(self):
        """The node `ticking` waits 20 ms for transforms, but these are simulated ones."""
        node = NodeClient('/ticking')
        self.tf.wait_for(node)
        self.jump(1100)
        with self.clock.lock:
            stamp = self.next_stamp()
            node.send_mesh(self.organ, SHEET, stamp)
            node.wait_for_shape(self.organ, stamp)
            time.sleep(0.2)
            self.place('grasper', (ABOVE, stamp))
            result = node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=stamp)
            self.assert_ok(result)

    def test_the_time_of_the_simulator_is_over_before_that_of_the_wall(self):
        """The clock goes on by 2 s, tf_timeout_sec, in a moment."""
        self.jump(1200)
        self.step(SHEET, {'grasper': ABOVE})
        with self.clock.lock:
            stamp = self.next_stamp()
            self.node.send_vertices(self.organ, SHEET, stamp)
            self.node.wait_for_shape(self.organ, stamp)
            for _ in range(201):
                self.clock.tick()
            result = self.node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=stamp)
        self.assertEqual(result.status, ContactArray.NO_TRANSFORM)
        self.assertRegex(result.message, r'is 10 ms behind the stamp .*; waited 2 s')

    def test_superseded_shapes_are_counted(self):
        def superseded():
            return int(self.node.diagnostics['shapes superseded by newer ones'])

        self.jump(1300)
        self.node.diagnostics.clear()
        wait_until(lambda: self.node.diagnostics, 'diagnostics')
        before = superseded()
        with self.clock.lock:
            stamp = self.next_stamp()
            self.node.send_mesh(self.organ, SHEET, stamp)
            self.node.wait_for_shape(self.organ, stamp)  # The vertices come over another connection.
            for _ in range(4):
                self.node.send_vertices(self.organ, SHEET, self.next_stamp())
            # The first shape waits for both tools, the last one waits behind it.
            wait_until(lambda: superseded() == before + 2 * 3, lambda: str(superseded()))

    def test_ticks_are_as_many_as_the_rate_says(self):
        """The rate counts in the simulator's time. The simulator waits if the machine is busy."""
        node = NodeClient('/ticking')
        with self.clock.lock:
            node.send_mesh(self.organ, SHEET)
            node.wait_for_shape(self.organ, rospy.Time())
            node.contacts.wait_for(self.organ, 'grasper')
            start = len(node.contacts.of(self.organ))
            for _ in range(50):
                before = len(node.contacts.of(self.organ))
                self.clock.tick()
                wait_until(lambda: len(node.contacts.of(self.organ)) > before, 'one more tick')
            # The few other answers are about the new shape, or from ticks before the clock stopped.
            self.assertLessEqual(len(node.contacts.of(self.organ)) - start, 55)


if __name__ == '__main__':
    rospy.init_node('simulated_time_test')
    rostest.rosrun('organ_collision', 'simulated_time', SimulatedTimeTest, sys.argv)
