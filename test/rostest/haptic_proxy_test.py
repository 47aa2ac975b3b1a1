#!/usr/bin/python3
"""haptic_proxy as its users see it, the node, and in short the nodelet. Each hand is moved in small steps at a few
hundred poses a second. No test depends on how fast they are answered."""

import math
import sys
import time
import unittest

from dynamic_reconfigure.msg import DoubleParameter
from dynamic_reconfigure.srv import Reconfigure, ReconfigureRequest
from geometry_msgs.msg import PoseStamped, WrenchStamped
from organ_collision.msg import OrganMesh, ProxyState
from organ_collision.srv import ListOrgans, RemoveOrgan
import rospy
import rostest
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage

from support import scenes
from support.node_client import (LIMIT, Diagnostics, Log, TfSender, is_heard, mesh_message, pose_stamped,
                                 wait_until)

FRAME = 'liver_frame'
STIFFNESS = 200.0  # [N/m]
CLEARANCE = 1e-4  # [m]
RADIUS = {'needle': 0.003, 'probe': 0.005, 'stylus': 0.004}  # [m]
SHEET = scenes.sheet(0.1, 4)
X, Y = 0.013, 0.007  # [m] where the hands stab
TROCAR = (0.02, -0.01, 0.3)
AIR, DEEP = (X, Y, 0.03), (X, Y, -0.02)
FREE, TOUCHING, NO_ANSWER = ProxyState.FREE, ProxyState.TOUCHING, ProxyState.NO_ANSWER


def vector(message):
    return (message.x, message.y, message.z)


def no_force(state):
    return state.state == NO_ANSWER and state.wrench.force.z == 0.0


class Hands:
    """The hands of all tools. Both nodes follow them."""

    def __init__(self):
        self.poses = {tool: rospy.Publisher(tool + '/pose', PoseStamped, queue_size=1000)
                      for tool in ('needle', 'stylus')}
        self.tf, self.tips = TfSender(), {}
        self.tf.send_resting(*((FRAME, frame, TROCAR) for frame in ('needle_trocar', 'probe_trocar', 'stylus_base')))

    def hold(self, tool, tip):
        """Sends one pose of a hand."""
        self.tips[tool] = tip
        if tool in self.poses:
            self.poses[tool].publish(pose_stamped(FRAME, tip, rospy.Time.now()))
        else:
            self.tf.send((FRAME, tool + '_tip', tip, rospy.Time.now()))
        time.sleep(0.002)

    def move(self, tool, tip):
        """Moves a hand straight to a tip position, in steps of at most 1 mm."""
        start = self.tips[tool]
        steps = max(1, math.ceil(math.dist(start, tip) / 1e-3))
        for i in range(1, steps + 1):
            self.hold(tool, tuple(a + (b - a) * i / steps for a, b in zip(start, tip)))


class ProxyCase(unittest.TestCase):
    node, process = '/haptic_proxy', '/haptic_proxy'
    hands = None

    @classmethod
    def setUpClass(cls):
        rospy.wait_for_service(cls.node + '/reload_tools', LIMIT)
        cls.reload, cls.remove_service, cls.list_service = (
            rospy.ServiceProxy(cls.node + name, kind) for name, kind in (
                ('/reload_tools', Trigger), ('/remove_organ', RemoveOrgan), ('/list_organs', ListOrgans)))
        cls.meshes = rospy.Publisher(cls.node + '/organ_mesh', OrganMesh, queue_size=10)
        cls.states = {tool: Log('%s/%s/state' % (cls.node, tool), ProxyState)
                      for tool in ('needle', 'probe', 'stylus', 'grasper')}
        cls.diagnostics = Diagnostics(cls.node)
        ProxyCase.hands = ProxyCase.hands or Hands()
        wait_until(lambda: all(is_heard(topic, cls.process) for topic in [cls.meshes, *cls.hands.poses.values()]),
                   'connections')
        cls.hands.tf.wait_for(cls)

    def setUp(self):
        self.organ = self.id().split('.')[-1]
        self.addCleanup(self.remove, self.organ)

    def organs(self):
        return [organ.name for organ in self.list_service().organs]

    def remove(self, organ):
        self.remove_service(organ)
        wait_until(lambda: organ not in self.organs(), 'removal')

    def send_sheet(self, mesh=SHEET):
        self.meshes.publish(mesh_message(self.organ, mesh, frame=FRAME))
        wait_until(lambda: self.organ in self.organs(), 'the organ')

    def change(self, name, value):
        """Sets a parameter of the running node. Returns its value then."""
        request = ReconfigureRequest()
        request.config.doubles = [DoubleParameter(name, value)]
        answer = rospy.ServiceProxy(self.node + '/set_parameters', Reconfigure)(request)
        return next(number.value for number in answer.config.doubles if number.name == name)

    def reload_with(self, tools):
        """The answer to other tools, which the node has until the test ends."""
        name, before = self.node + '/tools', rospy.get_param(self.node + '/tools')
        self.addCleanup(self.reload)
        self.addCleanup(rospy.set_param, name, before)
        rospy.set_param(name, tools(before))
        return self.reload()

    def hold_until(self, tool, tip, condition, what, log=None):
        """Holds the hand there until the last state of the tool, or another log, fulfils the condition. Returns it."""
        log = log or self.states[tool]

        def holds():
            self.hands.hold(tool, tip)
            message = log.last()
            return message if message and condition(message) else None

        return wait_until(holds, lambda: '%s; the last message is %s' % (what, log.last()))

    def hold_free(self, tool='needle'):
        return self.hold_until(tool, AIR, lambda state: state.state == FREE, tool + ' in the air')

    def spring(self, tool, height):
        """[N] on a hand that would have its tip there, while the proxy stays above the sheet."""
        return STIFFNESS * (RADIUS[tool] + CLEARANCE - height)

    def stab(self, tool='needle', depth=0.02):
        """Moves a hand from the air to a depth below the sheet, and waits for the whole force there. Returns the
        state."""
        self.hold_free(tool)
        self.hands.move(tool, (X, Y, -depth))
        expected = self.spring(tool, -depth)
        tolerance = 0.1 if tool == 'stylus' else 1e-3  # [N] A free shaft also turns.
        return self.hold_until(tool, (X, Y, -depth), lambda state: abs(state.wrench.force.z - expected) < tolerance,
                               '%g N of %s' % (expected, tool))


class HapticProxyTest(ProxyCase):
    def test_hands_that_stab_are_held(self):
        """On a topic of poses, and on TF."""
        self.send_sheet()
        for tool in ('needle', 'probe'):
            wrenches = Log('%s/%s/%s/wrench' % (self.node, self.organ, tool), WrenchStamped)
            state = self.stab(tool)
            self.assertEqual((state.state, state.header.frame_id, state.clipped), (TOUCHING, FRAME, False))
            self.assertGreater(state.proxy.position.z, RADIUS[tool])
            self.assertAlmostEqual(state.hand.position.z, -0.02, delta=1e-9)
            self.assertAlmostEqual(state.pull.z, self.spring(tool, -0.02) / STIFFNESS, delta=1e-6)
            wrench = self.hold_until(tool, DEEP, lambda w: abs(w.wrench.force.z - state.wrench.force.z) < 1e-3,
                                     'the wrench', wrenches)
            self.assertEqual(wrench.header.frame_id, FRAME)
            force, torque = vector(wrench.wrench.force), vector(wrench.wrench.torque)
            self.assertAlmostEqual(torque[0], Y * force[2], delta=1e-3)  # The force acts at the tip.
            self.assertAlmostEqual(torque[1], -X * force[2], delta=1e-3)

    def test_a_hand_in_the_air_is_free_and_feels_nothing(self):
        self.send_sheet()
        proxies, frames = Log(self.node + '/needle/proxy', PoseStamped), Log('/tf', TFMessage)
        state = self.hold_free()
        self.assertEqual(vector(state.wrench.force), (0.0, 0.0, 0.0))
        self.assertEqual(vector(state.hand.position), vector(state.proxy.position))
        proxy = self.hold_until('needle', AIR, lambda pose: abs(pose.pose.position.z - AIR[2]) < 1e-9, 'proxy', proxies)
        self.assertEqual(proxy.header.frame_id, FRAME)
        wait_until(lambda: self.hands.hold('needle', AIR) or frames.select(
            lambda message: message.transforms[0].child_frame_id == 'needle_proxy'
            and message.transforms[0].header.frame_id == FRAME), 'frame needle_proxy')

    def test_when_poses_stop_the_force_fades_and_comes_back(self):
        self.send_sheet()
        for _ in range(2):
            self.stab()
            log = self.states['needle']
            wait_until(lambda: no_force(log.last()), lambda: 'no force; there is %s' % log.last())
            fading = [state.wrench.force.z for state in log.messages if state.state == NO_ANSWER]
            self.assertGreater(len(fading), 5)
            self.assertIn('pose_timeout_sec', log.last().message)
            wait_until(lambda: any('pose_timeout_sec' in text for texts in self.diagnostics.summaries.values()
                                   for text in texts), 'the reason on /diagnostics')

    def test_parameters_can_be_changed(self):
        self.send_sheet()
        self.stab()
        self.addCleanup(self.change, 'max_force', math.inf)
        self.assertEqual(self.change('max_force', 1.5), 1.5)
        state = self.hold_until('needle', DEEP, lambda state: state.clipped and not state.fading,
                                'the force is clipped')
        self.assertAlmostEqual(state.wrench.force.z, 1.5, delta=1e-6)
        self.assertEqual(self.change('max_force', -1.0), 1.5, 'an illegal value is refused')

    def test_topics_end_with_their_organ_and_its_name_is_free(self):
        """Organs with new names come and go. One comes with the name of one that has just gone."""
        def topics():
            return {name for name, _ in rospy.get_published_topics(self.node) if name.endswith('/needle/wrench')
                    and '/short_lived' in name}

        self.hands.hold('needle', AIR)
        for i in range(12):
            self.organ = 'short-lived %d' % (i // 2) if i % 2 else 'short lived %d' % (i // 2)
            self.send_sheet()
            log = Log('%s/short_lived_%d/needle/wrench' % (self.node, i // 2), WrenchStamped)
            self.hold_until('needle', AIR, lambda wrench: True, 'the wrench of ' + self.organ, log)
            self.remove(self.organ)
            log.subscriber.unregister()
        self.assertGreater(len(topics()), 0)
        wait_until(lambda: self.hands.hold('needle', AIR) or not topics(), topics)
        wait_until(lambda: 'unanswered, name taken' not in self.diagnostics.values, 'no refusal')


class ReloadTest(ProxyCase):
    def test_reloaded_tools_keep_their_proxies(self):
        """In another order."""
        self.send_sheet()
        self.stab()
        answer = self.reload_with(lambda tools: [tool for tool in tools[::-1] if tool['name'] != 'probe'])
        self.assertTrue(answer.success, answer.message)
        self.assertIn("removed: 'probe'", answer.message)
        del self.states['needle'].messages[:]
        self.assertFalse(self.hold_until('needle', DEEP, lambda state: True, 'a state').placed_anew)
        self.stab(depth=0.01)


class NodeletTest(ReloadTest):
    node, process = '/proxy_nodelet', '/manager'


class AllTests(unittest.TestSuite):
    def __init__(self):
        super().__init__(unittest.defaultTestLoader.loadTestsFromTestCase(case)
                         for case in (HapticProxyTest, ReloadTest, NodeletTest))


if __name__ == '__main__':
    rospy.init_node('haptic_proxy_test')
    rostest.rosrun('organ_collision', 'haptic_proxy', 'haptic_proxy_test.AllTests', sys.argv)
