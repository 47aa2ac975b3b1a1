#!/usr/bin/python3
"""The arm of guarded_arm.launch follows its path around the moving liver: no link comes nearer than 3 mm, by a distance
that shares nothing with the package. Without rows, it goes through the liver. Time passes only when all nodes have answered, so
that a busy machine changes nothing."""

import importlib.util
import os
import signal
import sys
import threading
from xml.etree import ElementTree

from geometry_msgs.msg import PoseStamped
import numpy as np
from organ_collision.msg import OrganMesh, OrganVertices, ProxyState
import rospy
from rosgraph_msgs.msg import Clock
import rostest
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage
import tf2_ros

from support import capsules, scenes
from support.launch_case import PACKAGE, LaunchCase
from support.node_client import Log, wait_until
from support.processes import process_of

STEP, SHAPES = rospy.Duration(0, 4000000), 31.25  # of the clock; [Hz] of the liver, whose simulator has 8 steps for each
LEAST = 0.003  # [m]
BEFORE, BEHIND = -0.04, 0.095  # [m] y of the tip in the liver's frame: the path turns before and behind the liver
LONG = 100.0  # [s]


def example():
    path = os.path.join(PACKAGE, 'examples', 'guarded_arm.py')
    spec = importlib.util.spec_from_file_location('guarded_arm', path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


EXAMPLE = example()


class Scene:
    """What the nodes send, and the time that passes for them."""

    def __init__(self):
        self.now = max(rospy.Time(1), rospy.Time.now())
        self.clock = rospy.Publisher('/clock', Clock, queue_size=1)
        self.joints, self.states = Log('/joint_states', JointState), Log('/haptic_proxy/arm/state', ProxyState)
        self.mesh, self.shapes = (Log('/organ_collision/organ_' + topic, kind) for topic, kind in (
            ('mesh', OrganMesh), ('vertices', OrganVertices)))
        self.hand, self.frames = Log('/palpator/hand', PoseStamped), tf2_ros.Buffer(rospy.Duration(1000.0))
        self.moves, self.counted = 0, 0  # of the arm, among so many of its messages
        self.begun, self.passing = threading.Event(), threading.Thread(target=self.pass_by, daemon=True)
        self.passing.start()
        self.tf = [rospy.Subscriber('/tf', TFMessage, self.place, queue_size=10000),
                   rospy.Subscriber('/tf_static', TFMessage, self.place, True, queue_size=100)]

    def place(self, message, resting=False):
        add = self.frames.set_transform_static if resting else self.frames.set_transform
        for transform in message.transforms:
            if transform.child_frame_id.startswith('arm'):
                add(transform, 'test')

    def close(self):
        self.begun.set()
        self.passing.join()
        for log in (self.joints, self.states, self.mesh, self.shapes, self.hand):
            log.subscriber.unregister()
        for subscriber in self.tf:
            subscriber.unregister()

    def stamp(self, log):
        message = log.messages[-1] if log.messages else None
        return message.header.stamp if message else rospy.Time()

    def step(self, answers=True):
        """Lets time pass until the simulator and the arm have moved on and, if `answers`, haptic_proxy has answered."""
        self.now += STEP
        self.clock.publish(self.now)
        hand, arm = self.now - 2 * STEP, self.now - 2 * STEP - rospy.Duration(1.0 / EXAMPLE.RATE)
        wait_until(lambda: self.stamp(self.hand) >= hand and self.stamp(self.joints) >= arm and not (
            answers and self.stamp(self.states) < self.stamp(self.joints)),
                   lambda: 'nodes at %s: %s, %s, %s' % (self.now, *map(self.stamp, (self.hand, self.joints, self.states))), LONG)

    def pass_by(self):
        """Lets time pass while nodes start, whatever they do."""
        while not self.begun.wait(0.01):
            self.now += STEP
            self.clock.publish(self.now)

    def begin(self):
        """From the first motion of the arm on, time waits for the nodes."""
        wait_until(lambda: self.hand.messages and self.steps_of_arm() > 0, lambda: 'motion of the arm; %s' % self.states.last(), LONG)
        self.begun.set()
        self.passing.join()
        self.first = len(self.shapes.messages)

    def steps_of_arm(self):
        """How often the arm has moved."""
        positions = [joints.position for joints in self.joints.messages[self.counted:]]
        self.moves += sum(a != b for a, b in zip(positions, positions[1:]))
        self.counted += max(0, len(positions) - 1)
        return self.moves

    def place_of(self, frame, stamp, point=(0.0, 0.0, 0.0)):
        """[m] a point of a frame at that time, in the frame of the liver."""
        transform = self.frames.lookup_transform('liver', frame, stamp).transform
        turn, origin = transform.rotation, transform.translation
        pose = scenes.Pose((turn.x, turn.y, turn.z, turn.w), (origin.x, origin.y, origin.z))
        return np.array(pose.apply(point))

    def tip(self):
        return self.place_of('arm_7', rospy.Time(), EXAMPLE.TIP)

    def distances(self):
        """[m] from the liver of each link, a row for each of its shapes."""
        faces = {mesh.topology: np.array(mesh.triangles).reshape(-1, 3) for mesh in self.mesh.messages}
        robot = ElementTree.parse(os.path.join(PACKAGE, 'urdf', 'arm.urdf'))
        capsule_of = {link.get('name'): [float(link.find('.//cylinder').get(key)) for key in ('length', 'radius')]
                      for link in robot.iter('link')}
        rows = []
        for shape in self.shapes.messages[self.first:]:
            stamp, corners = shape.header.stamp, np.array(shape.vertices).reshape(-1, 3)[faces[shape.topology]]
            if stamp <= self.stamp(self.joints):
                rows.append([])
                for link in ('arm_%d' % number for number in range(1, 8)):
                    length, radius = capsule_of[link]
                    ends = self.place_of(link, stamp), self.place_of(link, stamp, (0.0, 0.0, length))
                    rows[-1].append(capsules.distance(*ends, corners) - radius)
        return np.array(rows)


class GuardedArmTest(LaunchCase):
    def setUp(self):
        rospy.set_param('/liver_simulator/rate', SHAPES)
        self.scene = Scene()
        self.addCleanup(self.scene.close)

    def follow(self, laps):
        """Lets the arm follow its path. Returns the greatest y of the tip, and its last one."""
        farthest, steps = -np.inf, int(laps * EXAMPLE.LAP * EXAMPLE.RATE)
        while self.scene.steps_of_arm() < steps:
            for _ in range(4):
                self.scene.step()
            farthest = max(farthest, self.scene.tip()[1])
        return farthest, self.scene.tip()[1]

    def test_no_link_comes_near(self):
        with self.launched('examples/guarded_arm.launch', 'clear_params:=false') as launched:
            self.scene.begin()
            farthest, last = self.follow(1.1)
            self.assert_stops_without_rows()
        distances = self.scene.distances().min(axis=0)
        print('least distances of the links [mm]:', 1e3 * distances)
        self.assertGreater(distances.min(), LEAST)
        self.assertLess(distances[5:].max(), 0.01)  # Without the guard, these would have touched.
        self.assertGreater(farthest, BEHIND)
        self.assertLess(last, BEFORE)
        self.assertIn('the arm stands', launched.printed)

    def assert_stops_without_rows(self):
        process = process_of('/haptic_proxy')
        os.kill(process, signal.SIGSTOP)
        try:
            for _ in range(50):
                self.scene.step(answers=False)
            stands = self.scene.steps_of_arm()
            for _ in range(50):
                self.scene.step(answers=False)
            self.assertEqual(self.scene.steps_of_arm(), stands)
        finally:
            os.kill(process, signal.SIGCONT)
        wait_until(lambda: self.scene.step(answers=False) or self.scene.steps_of_arm() > stands, 'motion', LONG)


if __name__ == '__main__':
    rospy.init_node('guarded_arm_test')
    rostest.rosrun('organ_collision', 'guarded_arm', GuardedArmTest, sys.argv)
