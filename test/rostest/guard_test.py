#!/usr/bin/python3
"""A tool that obeys tool_guard moves towards an organ. In the middle of the motion, the node, the guard or the transforms
end or hang: the tool stops. How long that takes is printed and not checked, because the machine may be busy."""

import signal
import sys
import threading
import time

from dynamic_reconfigure.msg import Config, DoubleParameter
from dynamic_reconfigure.srv import Reconfigure
from geometry_msgs.msg import TwistStamped, Vector3
from organ_collision.msg import GuardState
from organ_collision.srv import RemoveOrgan
from rosgraph_msgs.msg import Clock
import rospy
import rostest

from support import scenes
from support.node_client import Log, NodeClient, TfSender, wait_until
from support.processes import NodeStarter

TROCAR, HIGH, SPEED = (0.003, 0.002, 0.4), 0.2, 0.02
TOOL = {'name': 'hook', 'trocar_frame': 'hook_trocar', 'tip_frame': 'hook_tip', 'radius': 0.004, 'margin': 0.3,
        'max_near': 8}
# Long, so that a busy machine makes no answer stale.
GUARD = {'latency': 2.0, 'watch_time': 0.1, 'tissue_speed': 0.0, 'hold_sec': 0.0, 'collision_node': '/organ_collision'}
BOX = scenes.box()
TOP = BOX.vertices[-1][2]


class Hook(threading.Thread):
    """The robot: it moves with the velocity that it is told, and sends its transforms."""

    def __init__(self, tf):
        super().__init__(daemon=True)
        self.tf, self.height, self.velocity, self.sends, self.ends = tf, HIGH, 0.0, True, False
        self.message, self.wish, self.turn = TwistStamped(), -SPEED, 0.0
        self.wanted = rospy.Publisher('/wanted', TwistStamped, queue_size=1)
        rospy.Subscriber('/velocity', TwistStamped, self.take, queue_size=1, tcp_nodelay=True)

    def take(self, message):
        self.message, self.velocity = message, message.twist.linear.z

    def run(self):
        wanted = TwistStamped()
        wanted.header.frame_id = 'liver_frame'
        while not self.ends:
            wanted.twist.linear, wanted.twist.angular = Vector3(0, 0, self.wish), Vector3(self.turn, 0, 0)
            self.height += 0.01 * self.velocity
            self.wanted.publish(wanted)
            if self.sends:
                points = {'hook_trocar': TROCAR, 'hook_tip': TROCAR[:2] + (self.height,)}
                self.tf.send(*[('liver_frame', frame, point, rospy.Time.now()) for frame, point in points.items()])
            time.sleep(0.01)


class GuardTest(NodeStarter):
    def setUp(self):
        self.tf, self.states = TfSender(), Log('/tool_guard/state', GuardState)
        self.hook = Hook(self.tf)
        self.begin_node()
        self.guard = self.start('/tool_guard', GUARD, 'tool_guard')
        obedience = {'tool': 'hook', 'watch_time': GUARD['watch_time'], 'latest': GUARD['latency']}
        self.obey = self.start('/obey_guard', obedience, 'obey_guard.py')
        self.hook.start()
        self.addCleanup(self.hook.join)
        self.addCleanup(setattr, self.hook, 'ends', True)

    def begin_node(self):
        self.process = self.start('/organ_collision', {'tools': [TOOL], 'rate': 100})
        self.node = NodeClient('/organ_collision')
        self.node.bring('liver', BOX)

    def stage(self):
        state = self.states.last()
        return state and state.stage

    def wait_for_motion(self):
        begin = self.hook.height
        wait_until(lambda: self.hook.velocity < 0.0 and self.hook.height < begin - 0.001,
                   lambda: 'motion; %s' % self.states.last())

    def assert_stops(self, what, *words):
        """The tool stops within the motion. Prints how long it takes."""
        begin = time.monotonic()
        if words:
            state = wait_until(lambda: self.stage() == GuardState.STOP and self.states.last(), 'STOP')
            told = time.monotonic() - begin
            for word in words:
                self.assertIn(word, state.reason)
        wait_until(lambda: self.hook.velocity == 0.0, 'the tool stands')
        print('%s: %s, the tool was told to stop after %.3f s' % (
            what, 'STOP after %.3f s' % told if words else 'silence', time.monotonic() - begin))
        self.assertGreater(self.hook.height, TOP + TOOL['radius'])

    def test_the_node_hangs_and_is_killed(self):
        self.wait_for_motion()
        self.process.send_signal(signal.SIGSTOP)
        self.assert_stops('node, SIGSTOP', ' s old', 'liver')
        self.process.send_signal(signal.SIGCONT)
        self.wait_for_motion()
        self.process.kill()
        self.assert_stops('node, kill -9', ' s old', 'liver')
        self.process.wait()  # Its port may still accept connections.
        self.begin_node()
        self.wait_for_motion()
        self.process.send_signal(signal.SIGSTOP)
        self.assert_stops('the new node, SIGSTOP', ' s old', 'liver')
        time.sleep(1.0)  # until the guard waits for the lists of the node
        self.stop(self.guard)

    def test_the_guard_hangs_and_is_killed(self):
        self.wait_for_motion()
        self.guard.send_signal(signal.SIGSTOP)
        self.assert_stops('guard, SIGSTOP')
        self.guard.send_signal(signal.SIGCONT)
        self.wait_for_motion()
        self.guard.kill()
        self.assert_stops('guard, kill -9')

    def test_transforms_end(self):
        self.wait_for_motion()
        self.hook.sends = False
        self.assert_stops('transforms', 'liver')

    def test_an_organ_is_removed_and_another_comes(self):
        self.wait_for_motion()
        self.node.bring('colon', BOX.moved(lambda v: (v[0] + 0.2, v[1], v[2])))
        self.hook.height = TOP + TOOL['radius'] + 0.0005
        wait_until(lambda: self.states.last(lambda state: state.stage == GuardState.STOP and state.organ == 'liver'),
                   'STOP near the liver')
        rospy.ServiceProxy('/organ_collision/remove_organ', RemoveOrgan)('liver')
        wait_until(lambda: self.states.last(lambda state: state.organ == 'colon' and state.stage != GuardState.STOP),
                   'only the colon is left')

    def test_speeds_and_the_way_out_of_an_organ(self):
        self.wait_for_motion()
        self.hook.turn, self.hook.wish = 10.0, -0.001
        wait_until(lambda: self.hook.message.twist.angular.x > 0.0, 'the tool turns')
        self.assertLess(0.4 * self.hook.message.twist.angular.x, 0.1)
        self.hook.turn = 0.0
        change = rospy.ServiceProxy('/tool_guard/set_parameters', Reconfigure)
        change(config=Config(doubles=[DoubleParameter(name='deceleration', value=0.001)]))
        wait_until(lambda: self.states.last().speed_scale < 0.2, 'a lower speed')
        shown = change(config=Config(doubles=[DoubleParameter(name='max_speed', value=0.01)])).config.doubles
        self.assertNotIn('max_speed', [parameter.name for parameter in shown])
        self.hook.height, self.hook.wish = 0.0, SPEED
        state = wait_until(lambda: self.states.last(lambda state: 'touched' in state.reason and state.retreat.z > 0),
                           lambda: 'the way out; %s' % self.states.last())
        self.assertEqual(state.stage, GuardState.STOP)
        self.assertAlmostEqual(state.retreat.z, 1.0, 5)  # from the tip to the trocar
        wait_until(lambda: abs(self.hook.velocity - 0.005) < 1e-6, 'the tool retreats at `retreat_speed`')

    def test_nothing_that_a_clock_says_ends_them(self):
        """A guard and a program that obeys have a clock of their own, which jumps. Afterwards they go on."""
        rospy.set_param('/use_sim_time', True)
        self.addCleanup(rospy.delete_param, '/use_sim_time')
        clock, states = rospy.Publisher('/clock', Clock, queue_size=1), Log('/clocked_guard/state', GuardState)
        processes = [self.start('/clocked_guard', GUARD, 'tool_guard'),
                     self.start('/clocked_obey', {'tool': 'hook'}, 'obey_guard.py')]

        def goes_on(time_of, is_right):
            count = len(states.messages)

            def is_seen():
                self.assertEqual([process.poll() for process in processes], [None, None])
                clock.publish(time_of())
                return len(states.messages) > count + 10 and states.messages[-1] and is_right(states.messages[-1])
            wait_until(is_seen, lambda: '%s: %s' % (time_of(), states.messages[-1:]))

        last, top = 2 ** 31 - 1, 2 ** 32 - 1
        for seconds in (top, 1, top, last, top, last + 1, 0, 3 * 10 ** 9, last, 10 ** 9, top):
            goes_on(lambda: rospy.Time(seconds, 999999999), lambda state: state.stage == GuardState.STOP)
            self.tf.send(('liver_frame', 'extreme', TROCAR, rospy.Time(seconds, 999999999)))
            goes_on(rospy.Time.now, lambda state: state.stage != GuardState.STOP)


if __name__ == '__main__':
    rospy.init_node('guard_test')
    rostest.rosrun('organ_collision', 'guard', GuardTest, sys.argv)
