#!/usr/bin/python3
"""snapshot writes pictures that show what a topic's markers describe, and says why it cannot."""

import os
import subprocess
import sys
import tempfile
import unittest

from geometry_msgs.msg import Point
from PIL import Image
import rospy
import rostest
from visualization_msgs.msg import Marker, MarkerArray

from support import scenes, vectors
from support.node_client import NodeClient, TfSender, wait_until
from support.processes import program

SIZE = (200, 150)
TARGET, TO_EYE, DISTANCE = (0.0, 0.0, 0.02), (0.0, -0.8, 0.6), 0.3
CAMERA = ['--size=%dx%d' % SIZE, '--target=%g,%g,%g' % TARGET, '--view=%g,%g,%g' % TO_EYE, '--distance=%g' % DISTANCE]
WHITE = (255, 255, 255)
HALF_HEIGHT = 0.41405  # tangent of half of RViz's field of view, 0.785 rad


def pixel(image, point):
    """The colour of the pixel that shows a point of the fixed frame."""
    right, up = (1.0, 0.0, 0.0), (0.0, 0.6, 0.8)
    seen = vectors.sub(point, TARGET)
    scale = 0.5 * SIZE[1] / (HALF_HEIGHT * (DISTANCE - vectors.dot(seen, TO_EYE)))
    return image.getpixel((int(0.5 * SIZE[0] + scale * vectors.dot(seen, right)),
                           int(0.5 * SIZE[1] - scale * vectors.dot(seen, up))))


def difference(a, b):
    return max(abs(first - second) for first, second in zip(a, b))


def cube(frame, place, **named):
    """A marker: a green cube of 4 cm, whose colour has no light on it."""
    marker = Marker(type=Marker.CUBE, **named)
    marker.header.frame_id = frame
    marker.pose.position = Point(*place)
    marker.pose.orientation.w = 1.0
    marker.scale.x = marker.scale.y = marker.scale.z = 0.04
    marker.color.g = marker.color.a = 1.0
    return marker


class SnapshotTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.tf = TfSender()

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = os.path.join(folder.name, 'frame.png')

    def run_snapshot(self, *options, **environment):
        return subprocess.run([program('snapshot'), *options], env={**os.environ, **environment}, text=True, timeout=60,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def take(self, *options):
        """Takes pictures, with a timeout that suffices on a busy machine."""
        done = self.run_snapshot('--output', self.file, '--background=#ffffff', '--timeout=40', *CAMERA, *options)
        self.assertEqual((done.returncode, done.stderr), (0, ''))

    def picture(self, file=None):
        with Image.open(file or self.file) as image:
            self.assertEqual((image.size, image.mode), (SIZE, 'RGB'))
            return image.copy()

    def publish(self, topic, *markers):
        publisher = rospy.Publisher(topic, MarkerArray, queue_size=1, latch=True)
        publisher.publish(markers)
        self.addCleanup(publisher.unregister)

    def test_shows_the_scene_of_the_node(self):
        node, sheet = NodeClient(), scenes.sheet(0.1, 4)
        self.tf.wait_for(node)
        self.tf.send_resting(('liver_frame', 'probe_trocar', (0.013, 0.007, 0.12)),
                             ('liver_frame', 'probe_tip', (0.013, 0.007, 0.0045)))
        node.send_mesh('sheet', sheet, rospy.Time.now())
        touch = wait_until(lambda: node.contacts.select(lambda answer: answer.contacts), 'a contact')[0]
        self.take()
        image = self.picture()
        face = sheet.face(touch.contacts[0].face)
        centroid = vectors.scaled(vectors.add(vectors.add(*face[:2]), face[2]), 1 / 3)
        uncovered = min(face, key=lambda corner: (corner[1], -corner[0]))  # the tool is not in front
        touched = pixel(image, vectors.lerp(centroid, uncovered, 0.6))
        shaft, untouched = pixel(image, (0.013, 0.003, 0.06)), pixel(image, (-0.035, -0.035, 0.0))
        self.assertEqual(pixel(image, (-0.06, 0.007, 0.06)), WHITE)
        self.assertGreater(difference(shaft, WHITE), 30)
        self.assertLess(max(shaft) - min(shaft), 40, 'a tool is grey')
        self.assertGreater(max(touched) - min(touched), 80, 'a touched face has a vivid colour')
        self.assertGreater(difference(untouched, WHITE), 60, 'the organ is not white')
        self.assertGreater(difference(untouched, touched), 60, 'touched faces stand out')
        node.close()

    def test_several_topics_and_a_sequence(self):
        """Frames are placed by TF, and what was deleted is not shown."""
        self.tf.send_resting(('room', 'table', scenes.Pose((0.0, 0.0, 1.0, 1.0), (0.05, 0.0, 0.02))))  # a quarter turn
        gone = cube('room', (-0.02, 0.0, 0.02), id=1)
        self.publish('/right', cube('table', (0.03, 0.0, 0.0)))
        self.publish('/left', cube('room', (-0.08, 0.0, 0.02)), gone,
                     Marker(header=gone.header, id=1, action=Marker.DELETE))
        self.take('--topic=/left', '--topic=/right', '--frame=room', '--frames=2', '--rate=2', '--after=0')
        for number in (1, 2):
            image = self.picture(self.file.replace('.png', '_%04d.png' % number))
            for place in ((0.05, 0.03, 0.02), (-0.08, 0.0, 0.02)):
                red, green, blue = pixel(image, place)
                self.assertGreater(green, 100)
                self.assertLess(max(red, blue), 80)
            self.assertEqual(pixel(image, (-0.02, 0.0, 0.02)), WHITE)

    def test_says_in_one_line_why_there_is_no_picture(self):
        self.publish('/cubes', cube('table', (0.0, 0.0, 0.0)))
        self.publish('/empty')
        nowhere = {'ROS_MASTER_URI': 'http://localhost:1'}
        for expected, options, environment in (
            ('no node publishes /nothing', ['--topic=/nothing'], {}),
            ('no marker came within the timeout on /empty', ['--topic=/empty'], {}),
            ("frame 'table' have no transform", ['--topic=/cubes', '--frame=moon'], {}),
            ('--size is "big"', ['--size=big'], {}),
            ("cannot write '/no/folder/x.png'", ['--topic=/cubes', '--output=/no/folder/x.png'], {}),
            ('there is no ROS master at http://localhost:1', [], nowhere),
        ):
            output = [] if any('--output' in option for option in options) else ['--output=' + self.file]
            done = self.run_snapshot('--timeout=1', *output, *options, **environment)
            self.assertEqual(done.returncode, 2 if '--size' in expected else 1, done)
            self.assertIn(expected, done.stderr)
            self.assertEqual(done.stderr.count('\n'), 1, done.stderr)
            self.assertFalse(os.path.exists(self.file))


if __name__ == '__main__':
    rospy.init_node('snapshot_test')
    rostest.rosrun('organ_collision', 'snapshot', SnapshotTest, sys.argv)
