#!/usr/bin/python3
"""snapshot writes pictures that show what a topic's markers describe, and says why it cannot."""

import os
import subprocess
import sys
import tempfile
import unittest

from PIL import Image
import rospy
import rostest
from visualization_msgs.msg import Marker, MarkerArray

from support import scenes
from support.node_client import NodeClient, TfSender, wait_until
from support.processes import program
from support.vectors import dot, lerp, sub

SIZE = (200, 150)
TARGET, TO_EYE, DISTANCE = (0.0, 0.0, 0.02), (0.0, -0.8, 0.6), 0.3
CAMERA = ['--size=%dx%d' % SIZE, '--target=%g,%g,%g' % TARGET, '--view=%g,%g,%g' % TO_EYE, '--distance=%g' % DISTANCE]
WHITE = (255, 255, 255)
HALF_HEIGHT = 0.41405  # tangent of half of RViz's field of view, 0.785 rad


def pixel(image, point):
    """The colour of the pixel that shows a point of the fixed frame."""
    right, up = (1.0, 0.0, 0.0), (0.0, 0.6, 0.8)
    seen = sub(point, TARGET)
    scale = 0.5 * SIZE[1] / (HALF_HEIGHT * (DISTANCE - dot(seen, TO_EYE)))
    return image.getpixel((int(0.5 * SIZE[0] + scale * dot(seen, right)), int(0.5 * SIZE[1] - scale * dot(seen, up))))


def difference(a, b):
    return max(abs(first - second) for first, second in zip(a, b))


class SnapshotTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.file = os.path.join(self.folder.name, 'frame.png')

    def run_snapshot(self, *options, **environment):
        return subprocess.run([program('snapshot'), '--output=' + self.file, *options], text=True, timeout=60,
                              env={**os.environ, **environment}, stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def picture(self, name):
        with Image.open(os.path.join(self.folder.name, name)) as image:
            self.assertEqual((image.size, image.mode), (SIZE, 'RGB'))
            return image.copy()

    def test_shows_the_scene_of_the_node(self):
        """In the organ's frame, and in another one, in which it is turned."""
        node, sheet, tf = NodeClient(), scenes.sheet(0.1, 4), TfSender()
        tf.wait_for(node)
        tf.send_resting(('liver_frame', 'probe_trocar', (0.013, 0.007, 0.12)),
                        ('liver_frame', 'probe_tip', (0.013, 0.007, 0.0045)),
                        ('world', 'liver_frame', scenes.Pose((0.0, 0.0, 1.0, 1.0), (0.0, 0.0, 0.0))))
        node.send_mesh('sheet', sheet, rospy.Time.now())
        touch = wait_until(lambda: node.contacts.select(lambda answer: answer.contacts), 'a contact')[0]
        pictures = []
        for options, names in (([], ['frame.png']), (['--frames=2', '--rate=2', '--frame=world', '--after=0'],
                                                     ['frame_0001.png', 'frame_0002.png'])):
            done = self.run_snapshot('--background=#ffffff', '--timeout=40', *CAMERA, *options)
            self.assertEqual((done.returncode, done.stderr), (0, ''))
            pictures += [self.picture(name) for name in names]
        image = pictures[0]
        face = sheet.face(touch.contacts[0].face)
        centroid = tuple(sum(c) / 3 for c in zip(*face))
        uncovered = min(face, key=lambda corner: (corner[1], -corner[0]))  # the tool is not in front
        touched = pixel(image, lerp(centroid, uncovered, 0.6))
        shaft, untouched = pixel(image, (0.013, 0.003, 0.06)), pixel(image, (-0.035, -0.035, 0.0))
        self.assertEqual(pixel(image, (-0.06, 0.007, 0.06)), WHITE)
        self.assertGreater(difference(shaft, WHITE), 30)
        self.assertLess(max(shaft) - min(shaft), 40, 'a tool is grey')
        self.assertGreater(max(touched) - min(touched), 80, 'a touched face has a vivid colour')
        self.assertGreater(difference(untouched, WHITE), 60, 'the organ is not white')
        self.assertGreater(difference(untouched, touched), 60, 'touched faces stand out')
        for turned in pictures[1:]:  # by a quarter
            self.assertGreater(difference(pixel(turned, (-0.007, 0.009, 0.06)), WHITE), 30)
            self.assertEqual(pixel(turned, (-0.06, 0.013, 0.06)), WHITE)
        node.close()

    def test_says_in_one_line_why_there_is_no_picture(self):
        cube = Marker(type=Marker.CUBE)
        cube.header.frame_id = 'table'
        cube.scale.x = cube.scale.y = cube.scale.z = cube.pose.orientation.w = cube.color.a = 1.0
        for topic, markers in (('/cubes', [cube]), ('/empty', [])):
            publisher = rospy.Publisher(topic, MarkerArray, queue_size=1, latch=True)
            publisher.publish(markers)
            self.addCleanup(publisher.unregister)
        nowhere = {'ROS_MASTER_URI': 'http://localhost:1'}
        for expected, options, environment in (
            ('no node publishes /nothing', ['--topic=/nothing'], {}),
            ('no marker came within the timeout on /empty', ['--topic=/empty'], {}),
            ("frame 'table' have no transform", ['--topic=/cubes', '--frame=moon'], {}),
            ('there is no ROS master at http://localhost:1', [], nowhere),
        ):
            done = self.run_snapshot('--timeout=1', *options, **environment)
            self.assertEqual(done.returncode, 1, done)
            self.assertIn(expected, done.stderr)
            self.assertEqual(done.stderr.count('\n'), 1, done.stderr)
            self.assertFalse(os.path.exists(self.file))


if __name__ == '__main__':
    rospy.init_node('snapshot_test')
    rostest.rosrun('organ_collision', 'snapshot', SnapshotTest, sys.argv)
