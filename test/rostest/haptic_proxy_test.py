#!/usr/bin/python3
"""haptic_proxy, the node and the nodelet, as its users see it. Each hand is moved in small steps
at a few hundred poses a second. No test depends on how fast they are answered."""

import math
import sys
import time
import unittest

from diagnostic_msgs.msg import DiagnosticArray
from dynamic_reconfigure.msg import DoubleParameter
from dynamic_reconfigure.srv import Reconfigure, ReconfigureRequest
from geometry_msgs.msg import PoseStamped, WrenchStamped
from organ_collision.msg import ContactArray, OrganMesh, ProxyState, VertexForces
from organ_collision.srv import ListOrgans, RemoveOrgan
import rospy
import rostest
from std_srvs.srv import Empty, Trigger
from tf2_msgs.msg import TFMessage

from support import scenes
from support.node_client import LIMIT, TfSender, is_heard, wait_until

NODE = '/haptic_proxy'
FRAME = 'liver_frame'
STIFFNESS = 200.0  # [N/m]
CLEARANCE = 1e-4  # [m]
RADIUS = {'needle': 0.003, 'pin': 0.003, 'probe': 0.005, 'stylus': 0.004}  # [m]
SHEET = scenes.sheet(0.1, 4)
X, Y = 0.013, 0.007  # [m] where the hands stab
TROCAR = (0.02, -0.01, 0.3)


class Log:
    """All messages of a topic, in order."""

    def __init__(self, topic, kind):
        self.messages = []
        self.subscriber = rospy.Subscriber(topic, kind, self.messages.append, queue_size=1000)

    def last(self, wanted=lambda message: True):
        """The last such message; None if there is none."""
        return next((message for message in self.messages[::-1] if wanted(message)), None)


def vector(message):
    return (message.x, message.y, message.z)


def tip_pose(tip):
    message = PoseStamped()
    message.header.frame_id, message.header.stamp = FRAME, rospy.Time.now()
    p = message.pose.position
    p.x, p.y, p.z = tip
    message.pose.orientation.w = 1.0
    return message


class HapticProxyTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.process = rospy.get_param('~process', NODE)
        rospy.wait_for_service(NODE + '/reload_tools', LIMIT)
        cls.meshes = rospy.Publisher(NODE + '/organ_mesh', OrganMesh, queue_size=10)
        cls.hands = {
            tool: rospy.Publisher(tool + '/pose', PoseStamped, queue_size=1000)
            for tool in ('needle', 'stylus')
        }
        cls.tf = TfSender()
        cls.states = {
            tool: Log('%s/%s/state' % (NODE, tool), ProxyState)
            for tool in ('needle', 'pin', 'probe', 'stylus', 'grasper')
        }
        cls.proxies = Log(NODE + '/needle/proxy', PoseStamped)
        cls.contacts = Log(NODE + '/contacts', ContactArray)
        cls.frames = Log('/tf', TFMessage)
        cls.diagnostics = Log('/diagnostics', DiagnosticArray)
        wait_until(
            lambda: all(is_heard(topic, cls.process) for topic in [cls.meshes, *cls.hands.values()]),
            'connections',
        )
        cls.tf.wait_for(cls)
        base = scenes.Pose((0, 0, 0, 1), TROCAR)
        cls.tf.send_resting(
            *((FRAME, frame, base) for frame in ('needle_trocar', 'probe_trocar', 'stylus_base'))
        )

    def setUp(self):
        self.organ = self.id().split('.')[-1]
        self.tips = {}

    def tearDown(self):
        rospy.ServiceProxy(NODE + '/remove_organ', RemoveOrgan)(self.organ)
        wait_until(lambda: self.organ not in self.organs(), 'removal')

    @staticmethod
    def organs():
        return [organ.name for organ in rospy.ServiceProxy(NODE + '/list_organs', ListOrgans)().organs]

    def send_sheet(self, organ=None, frame=FRAME):
        organ = organ or self.organ
        mesh = OrganMesh(
            organ=organ,
            topology=1,
            vertices=SHEET.flat_vertices(),
            triangles=SHEET.flat_faces(),
        )
        mesh.header.frame_id = frame
        self.meshes.publish(mesh)
        wait_until(lambda: organ in self.organs(), 'the organ')

    @staticmethod
    def set_number(name, value):
        """Sets a parameter of the running node. Returns its value then."""
        request = ReconfigureRequest()
        request.config.doubles = [DoubleParameter(name, value)]
        answer = rospy.ServiceProxy(NODE + '/set_parameters', Reconfigure)(request)
        return next(number.value for number in answer.config.doubles if number.name == name)

    def hold(self, tool, tip):
        """Sends one pose of a hand."""
        self.tips[tool] = tip
        if tool in self.hands:
            self.hands[tool].publish(tip_pose(tip))
        else:
            self.tf.send((FRAME, tool + '_tip', scenes.Pose((0, 0, 0, 1), tip), rospy.Time.now()))

    def hold_until(self, tool, tip, condition, what):
        """Holds the hand there until the condition holds for the tool's last state. Returns it."""

        def holds():
            self.hold(tool, tip)
            time.sleep(0.002)
            state = self.states[tool].last()
            return state if state and condition(state) else None

        return wait_until(holds, lambda: '%s; the last state is %s' % (what, self.states[tool].last()))

    def move(self, tool, tip):
        """Moves a hand straight to a tip position, in steps of at most 1 mm."""
        start = self.tips[tool]
        steps = max(1, math.ceil(math.dist(start, tip) / 1e-3))
        for i in range(1, steps + 1):
            self.hold(tool, tuple(a + (b - a) * i / steps for a, b in zip(start, tip)))
            time.sleep(0.001)

    def stab(self, tool, depth):
        """Moves a hand from the air to a depth below the sheet, and waits for the whole force there.
        Returns the state."""
        self.hold_until(
            tool, (X, Y, 0.03), lambda state: state.state == ProxyState.FREE, tool + ' in the air'
        )
        self.move(tool, (X, Y, -depth))
        expected = self.spring(tool, -depth)
        tolerance = 0.1 if tool == 'stylus' else 1e-3  # [N] A free shaft also turns.
        return self.hold_until(
            tool,
            (X, Y, -depth),
            lambda state: abs(state.wrench.force.z - expected) < tolerance,
            '%g N of %s' % (expected, tool),
        )

    def spring(self, tool, height):
        """[N] on a hand that would have its tip there, while the proxy stays above the sheet."""
        return STIFFNESS * (RADIUS[tool] + CLEARANCE - height)

    def check_stab(self, tool):
        wrenches = Log('%s/%s/%s/wrench' % (NODE, self.organ, tool), WrenchStamped)
        state = self.stab(tool, 0.02)
        self.assertEqual((state.state, state.header.frame_id), (ProxyState.TOUCHING, FRAME))
        self.assertGreater(state.proxy.position.z, RADIUS[tool])
        self.assertAlmostEqual(state.hand.position.z, -0.02, delta=1e-9)
        self.assertAlmostEqual(state.pull.z, self.spring(tool, -0.02) / STIFFNESS, delta=1e-6)
        self.assertFalse(state.clipped)

        def last_wrench():
            self.hold(tool, self.tips[tool])
            time.sleep(0.002)
            return wrenches.last(lambda wrench: abs(wrench.wrench.force.z - state.wrench.force.z) < 1e-3)

        wrench = wait_until(last_wrench, 'the wrench of ' + tool)
        self.assertEqual(wrench.header.frame_id, FRAME)
        force, torque = vector(wrench.wrench.force), vector(wrench.wrench.torque)
        if tool != 'stylus':  # The force acts at the tip.
            self.assertAlmostEqual(torque[0], Y * force[2], delta=1e-3)
            self.assertAlmostEqual(torque[1], -X * force[2], delta=1e-3)

    def test_a_hand_on_a_pose_topic_that_stabs_is_held(self):
        self.send_sheet()
        self.check_stab('needle')

    def test_a_hand_on_tf_that_stabs_is_held(self):
        self.send_sheet()
        self.check_stab('probe')

    def test_a_hand_in_the_air_is_free_and_feels_nothing(self):
        self.send_sheet()
        state = self.hold_until(
            'needle', (X, Y, 0.04), lambda state: state.state == ProxyState.FREE, 'free'
        )
        self.assertEqual(vector(state.wrench.force), (0.0, 0.0, 0.0))
        self.assertEqual(vector(state.hand.position), vector(state.proxy.position))
        proxy = wait_until(
            lambda: self.proxies.last(lambda pose: abs(pose.pose.position.z - 0.04) < 1e-9), 'proxy'
        )
        self.assertEqual(proxy.header.frame_id, FRAME)
        self.hold_until(
            'needle',
            (X, Y, 0.04),
            lambda _: self.frames.last(
                lambda message: message.transforms[0].child_frame_id == 'needle_proxy'
                and message.transforms[0].header.frame_id == FRAME
            ),
            'frame needle_proxy',
        )

    def test_of_a_free_tool_the_forces_on_vertices_are_minus_the_wrench(self):
        self.send_sheet()
        pair = '%s/%s/stylus' % (NODE, self.organ)
        wrenches = Log(pair + '/wrench', WrenchStamped)
        forces = Log(pair + '/vertex_forces', VertexForces)
        self.stab('stylus', 0.004)

        def both():
            self.hold('stylus', self.tips['stylus'])
            time.sleep(0.002)
            wrench = wrenches.last(lambda wrench: wrench.wrench.force.z > 0.5)
            same = wrench and forces.last(lambda on: on.header.stamp == wrench.header.stamp)
            return (wrench, same) if same else None

        wrench, on_tissue = wait_until(both, 'wrench and vertex forces of one stamp')
        self.assertEqual((on_tissue.organ, on_tissue.tool), (self.organ, 'stylus'))
        self.assertEqual((on_tissue.topology, on_tissue.header.frame_id), (1, FRAME))
        for axis in 'xyz':
            total = sum(getattr(force, axis) for force in on_tissue.forces)
            self.assertAlmostEqual(total, -getattr(wrench.wrench.force, axis), delta=1e-6)

    def test_the_proxys_contacts_are_published(self):
        self.send_sheet()
        self.stab('needle', 0.01)

        def touched():
            self.hold('needle', self.tips['needle'])
            time.sleep(0.002)
            return self.contacts.last(
                lambda answer: answer.organ == self.organ
                and answer.tool == 'needle'
                and answer.status == ContactArray.OK
                and answer.contacts
            )

        answer = wait_until(touched, 'contacts')
        self.assertEqual((answer.header.frame_id, answer.topology), (FRAME, 1))
        contact = answer.contacts[0]
        self.assertAlmostEqual(contact.depth, -CLEARANCE, delta=1e-6)
        self.assertAlmostEqual(contact.normal.z, -1.0, delta=1e-6)

    def test_when_poses_stop_the_force_fades(self):
        self.send_sheet()
        self.stab('needle', 0.02)
        del self.states['needle'].messages[:]
        state = wait_until(
            lambda: self.states['needle'].last(
                lambda state: state.state == ProxyState.NO_ANSWER
                and 'pose_timeout_sec' in state.message
                and state.wrench.force.z == 0.0
            ),
            'the force is gone',
        )
        fading = [
            other.wrench.force.z
            for other in self.states['needle'].messages
            if other.state == ProxyState.NO_ANSWER and other.message == state.message
        ]
        self.assertEqual(fading, sorted(fading, reverse=True), 'the force must only fall')
        wait_until(
            lambda: self.diagnostics.last(
                lambda message: any(
                    'pose_timeout_sec' in status.message for status in message.status
                )
            ),
            'the reason on /diagnostics',
        )
        # The force comes back.
        self.stab('needle', 0.02)

    def test_without_an_organ_there_is_no_answer(self):
        self.send_sheet()
        self.stab('needle', 0.02)
        self.assertTrue(rospy.ServiceProxy(NODE + '/remove_organ', RemoveOrgan)(self.organ).success)
        state = self.hold_until(
            'needle',
            (X, Y, -0.02),
            lambda state: state.state == ProxyState.NO_ANSWER and state.wrench.force.z == 0.0,
            'no answer',
        )
        self.assertIn('there is no organ', state.message)

    def test_a_hand_that_jumps_has_its_proxy_placed_anew(self):
        self.send_sheet()
        self.stab('needle', 0.02)
        del self.states['needle'].messages[:]
        self.hold_until(
            'needle',
            (X + 0.03, Y, 0.15),
            lambda state: state.state == ProxyState.FREE and state.wrench.force.z == 0.0,
            'free after the jump',
        )
        placed = [state for state in self.states['needle'].messages if state.placed_anew]
        self.assertEqual(len(placed), 1)
        self.assertNotEqual(placed[0].message, '')

    def test_reset_places_proxies_anew(self):
        self.send_sheet()
        self.stab('needle', 0.001)
        del self.states['needle'].messages[:]
        rospy.ServiceProxy(NODE + '/reset', Empty)()
        self.hold_until(
            'needle',
            (X, Y, 0.03),
            lambda _: any(state.placed_anew for state in self.states['needle'].messages),
            'placed anew',
        )

    def test_a_tool_without_links_says_so(self):
        state = wait_until(self.states['grasper'].last, 'the state of the grasper')
        self.assertEqual(state.state, ProxyState.NO_ANSWER)
        self.assertIn('no_such_robot', state.message)
        self.assertEqual((state.hand.orientation.w, state.proxy.orientation.w), (1.0, 1.0))

    def test_parameters_can_be_changed(self):
        self.send_sheet()
        self.stab('needle', 0.02)
        self.assertEqual(self.set_number('max_force', 1.5), 1.5)
        state = self.hold_until(
            'needle', (X, Y, -0.02), lambda state: state.clipped, 'the force is clipped'
        )
        self.assertAlmostEqual(state.wrench.force.z, 1.5, delta=1e-6)
        self.assertEqual(self.set_number('max_force', -1.0), 1.5, 'an illegal value is refused')
        self.set_number('max_force', math.inf)

    def test_a_needle_pierces_at_the_puncture_force(self):
        self.send_sheet()
        self.set_number('puncture_force', 3.0)
        self.set_number('friction', 0.5)
        try:
            depth = 2.9 / STIFFNESS - RADIUS['needle'] - CLEARANCE
            self.assertEqual(self.stab('needle', depth).state, ProxyState.TOUCHING)
            self.move('needle', (X, Y, -0.03))
            state = self.hold_until(
                'needle',
                (X, Y, -0.03),
                lambda state: state.state == ProxyState.PUNCTURED,
                'punctured',
            )
            self.assertAlmostEqual(state.wrench.force.z, 0.5, delta=0.05)
            self.assertLess(state.proxy.position.z, -0.02)
            self.move('needle', (X, Y, 0.03))
            self.hold_until(
                'needle', (X, Y, 0.03), lambda state: state.state == ProxyState.FREE, 'pulled out'
            )
        finally:
            self.set_number('puncture_force', 0.0)
            self.set_number('friction', 0.0)

    def test_an_organ_in_another_frame_is_where_tf_says(self):
        self.send_sheet()
        raised = 'raised_frame'
        self.tf.send_resting((FRAME, raised, scenes.Pose((0, 0, 0, 1), (0.0, 0.0, 0.01))))
        name = self.organ + '_raised'
        self.send_sheet(name, raised)
        try:
            wrenches = Log('%s/%s/needle/wrench' % (NODE, name), WrenchStamped)
            self.hold_until(
                'needle', (X, Y, 0.04), lambda state: state.state == ProxyState.FREE, 'in the air'
            )
            self.move('needle', (X, Y, -0.01))
            expected = self.spring('needle', -0.01) + STIFFNESS * 0.01
            self.hold_until(
                'needle',
                (X, Y, -0.01),
                lambda state: abs(state.wrench.force.z - expected) < 1e-3
                and state.header.frame_id == FRAME,
                'the force of the raised organ',
            )
            wait_until(
                lambda: wrenches.last(lambda wrench: abs(wrench.wrench.force.z - expected) < 1e-3),
                'its wrench',
            )
        finally:
            rospy.ServiceProxy(NODE + '/remove_organ', RemoveOrgan)(name)
            wait_until(lambda: name not in self.organs(), 'removal')

    def check_age_is_told(self, frame, tip):
        """Of a hand whose poses come, the frame of an organ is too old."""
        state = self.hold_until(
            'needle',
            tip,
            lambda state: state.state == ProxyState.NO_ANSWER
            and "frame '%s' is " % frame in state.message
            and state.wrench.force.z == 0.0,
            'the frame is too old',
        )
        self.assertIn('(frame_timeout_sec)', state.message)

    def test_the_frame_of_the_proxies_may_be_the_one_that_is_too_old(self):
        frame = 'own_frame'
        pose = scenes.Pose((0, 0, 0, 1), (0.0, 0.0, -0.01))
        self.tf.send((FRAME, frame, pose, rospy.Time.now()))
        self.send_sheet(frame=frame)

        def is_followed(state):
            self.tf.send((FRAME, frame, pose, rospy.Time.now()))
            return state.state == ProxyState.FREE and state.header.frame_id == frame

        for _ in range(2):  # After the silence, it goes on.
            self.hold_until('needle', (X, Y, 0.03), is_followed, 'the needle in the air')
            self.check_age_is_told(frame, (X, Y, 0.03))

    def test_an_organ_that_rises_into_a_hand_pushes_it_until_its_frame_is_too_old(self):
        self.send_sheet()
        name = self.organ + '_rising'
        tip = (X, Y, 0.05)
        self.tf.send_resting(
            *((FRAME, 'pin_' + end, scenes.Pose((0, 0, 0, 1), at)) for end, at in (('trocar', TROCAR), ('tip', tip)))
        )

        def raise_to(height):
            pose = scenes.Pose((0, 0, 0, 1), (0.0, 0.0, height))
            self.tf.send((FRAME, 'rising_frame', pose, rospy.Time.now()))
            time.sleep(0.002)

        def reaches(height, condition, what):
            """Keeps the organ there until the condition holds for the last state of the pin."""

            def holds():
                raise_to(height)
                state = self.states['pin'].last()
                return state and condition(state)

            wait_until(holds, lambda: '%s; the last state is %s' % (what, self.states['pin'].last()))

        raise_to(0.03)
        self.send_sheet(name, 'rising_frame')
        expected = self.spring('pin', 0.0)
        try:
            for _ in range(2):  # After the silence, it goes on.
                reaches(0.03, lambda state: state.state == ProxyState.FREE, 'the organ below the pin')
                for i in range(1, 20):
                    raise_to(0.03 + 1e-3 * i)
                reaches(
                    tip[2],
                    lambda state: state.state == ProxyState.TOUCHING
                    and abs(state.wrench.force.z - expected) < 1e-3,
                    'the force of the organ on the pin',
                )
                states = self.states['pin'].messages
                wait_until(
                    lambda: states[-1].state == ProxyState.NO_ANSWER and states[-1].wrench.force.z == 0.0,
                    'the force is gone, because the organ is silent',
                )
                answered = max(i for i, s in enumerate(states) if s.state != ProxyState.NO_ANSWER)
                lost = states[answered + 1 :]
                self.assertIn("frame 'rising_frame' is ", lost[0].message)
                self.assertIn('(frame_timeout_sec)', lost[0].message)
                forces = [state.wrench.force.z for state in lost]
                self.assertAlmostEqual(forces[0], expected, delta=1e-3, msg='it fades from where it was')
                self.assertEqual(forces, sorted(forces, reverse=True), 'the force must only fall')
                self.check_age_is_told('rising_frame', tip)
                wait_until(
                    lambda: self.diagnostics.last(
                        lambda message: any(
                            "frame 'rising_frame'" in status.message for status in message.status
                        )
                    ),
                    'the reason on /diagnostics',
                )
        finally:
            rospy.ServiceProxy(NODE + '/remove_organ', RemoveOrgan)(name)
            wait_until(lambda: name not in self.organs(), 'removal')

    def test_a_trocar_in_tissue_is_no_answer(self):
        self.send_sheet()
        self.stab('needle', 0.02)
        trocar = [(FRAME, 'needle_trocar', scenes.Pose((0, 0, 0, 1), at)) for at in (TROCAR, (0.02, -0.01, 0.0))]
        self.tf.send_resting(trocar[1])
        try:
            state = self.hold_until(
                'needle',
                (X, Y, -0.02),
                lambda state: state.state == ProxyState.NO_ANSWER and state.wrench.force.z == 0.0,
                'no answer',
            )
            self.assertIn('the trocar is in tissue', state.message)
            self.assertFalse(state.placed_anew)
            answer = wait_until(
                lambda: self.contacts.last(
                    lambda answer: answer.tool == 'needle' and 'the trocar is in tissue' in answer.message
                ),
                'contacts that say so',
            )
            self.assertNotEqual(answer.status, ContactArray.OK)
            del self.proxies.messages[:]
            self.hold_until(
                'needle',
                (X, Y, -0.021),
                lambda state: state.header.stamp > answer.header.stamp,
                'a later state',
            )
            self.assertEqual(self.proxies.messages, [])
        finally:
            self.tf.send_resting(trocar[0])

    def test_a_tool_that_is_removed_lets_go(self):
        self.send_sheet()
        wrenches = Log('%s/%s/needle/wrench' % (NODE, self.organ), WrenchStamped)
        self.stab('needle', 0.02)
        self.hold_until(
            'needle',
            (X, Y, -0.02),
            lambda _: wrenches.last(lambda wrench: wrench.wrench.force.z > 1.0),
            'the wrench',
        )
        tools = rospy.get_param(NODE + '/tools')
        rospy.set_param(NODE + '/tools', [tool for tool in tools if tool['name'] != 'needle'])
        try:
            self.assertTrue(rospy.ServiceProxy(NODE + '/reload_tools', Trigger)().success)
            wait_until(lambda: wrenches.messages[-1].wrench.force.z == 0.0, 'the last wrench')
            last = self.states['needle'].last()
            self.assertEqual((last.state, last.wrench.force.z), (ProxyState.NO_ANSWER, 0.0))
            self.assertIn('removed', last.message)
        finally:
            rospy.set_param(NODE + '/tools', tools)
            rospy.ServiceProxy(NODE + '/reload_tools', Trigger)()

    def test_a_reload_that_fails_leaves_the_hands_as_they_were(self):
        self.send_sheet()
        self.stab('needle', 0.02)
        tools = rospy.get_param(NODE + '/tools')
        # On this topic the node already hears messages of another type.
        broken = [dict(tool) for tool in tools]
        broken[0]['tip_pose_topic'] = NODE + '/organ_mesh'
        rospy.set_param(NODE + '/tools', broken)
        try:
            answer = rospy.ServiceProxy(NODE + '/reload_tools', Trigger)()
            self.assertFalse(answer.success, answer.message)
            self.stab('needle', 0.01)
        finally:
            rospy.set_param(NODE + '/tools', tools)
            rospy.ServiceProxy(NODE + '/reload_tools', Trigger)()

    def test_reloaded_tools_keep_their_proxies(self):
        self.send_sheet()
        self.stab('needle', 0.02)
        tools = rospy.get_param(NODE + '/tools')
        others = [tool for tool in tools[::-1] if tool['name'] != 'probe']  # In another order.
        rospy.set_param(NODE + '/tools', others)
        try:
            answer = rospy.ServiceProxy(NODE + '/reload_tools', Trigger)()
            self.assertTrue(answer.success, answer.message)
            self.assertIn("removed: 'probe'", answer.message)
            del self.states['needle'].messages[:]
            state = self.hold_until('needle', (X, Y, -0.02), lambda state: True, 'a state')
            self.assertFalse(state.placed_anew)
            self.stab('needle', 0.01)
        finally:
            rospy.set_param(NODE + '/tools', tools)
            rospy.ServiceProxy(NODE + '/reload_tools', Trigger)()


if __name__ == '__main__':
    rospy.init_node('haptic_proxy_test')
    rostest.rosrun('organ_collision', 'haptic_proxy', HapticProxyTest, sys.argv)
