#!/usr/bin/python3
"""Starts RViz so that it shows the organs and tools of a collision node. Nothing needs to be edited: the fixed frame
is that of the first organ, and the camera and the grid fit the size of the organs.

Usage: view.py [--fixed-frame FRAME] [--save FILE] [TOPIC]

  TOPIC          the markers of the node; default: /organ_collision/markers
  --fixed-frame  another fixed frame, to which TF connects the organs; empty: that of the first organ
  --save FILE    writes the RViz configuration to FILE instead of starting RViz
"""

import argparse
import math
import os
import sys
import tempfile
import threading

import numpy
import roslib.packages
import rospy
import tf2_ros
from visualization_msgs.msg import MarkerArray
import yaml

CONFIGURATION = 'config/organ_collision.rviz'
DISTANCE = 1.5  # of the camera from the organs, as a share of their diagonal
TEXT_ROOM = 0.12  # the camera looks so far above the centre, because the status stands above the organ
CELLS = 6  # of the grid, along that diagonal
PATIENCE = 5.0  # [s] for a transform


class FirstPicture:
    """The organs of the first complete picture: the first one's frame, and the corners of all that
    are in this frame."""

    def __init__(self, topic):
        self.frame, self.corners = None, []
        self.complete = threading.Event()
        self.subscriber = rospy.Subscriber(topic, MarkerArray, self.on_markers, queue_size=4000)

    def on_markers(self, array):
        for marker in array.markers:
            if self.complete.is_set() or marker.action != marker.ADD:
                continue
            if marker.ns.startswith('surface/'):
                self.frame = self.frame or marker.header.frame_id
                if marker.header.frame_id == self.frame:
                    points = numpy.array([(p.x, p.y, p.z) for p in marker.points])
                    self.corners += [points.min(axis=0), points.max(axis=0)]
            elif marker.ns == 'status':  # comes after all surfaces
                self.frame = self.frame or marker.header.frame_id
                self.complete.set()

    def wait(self, topic):
        while not self.complete.wait(0.1):
            rospy.loginfo_throttle(10.0, 'waiting for the first organ on %s' % topic)
            if rospy.is_shutdown():
                sys.exit()
        self.subscriber.unregister()


def rotation(q):
    x, y, z, w = q.x, q.y, q.z, q.w
    return numpy.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def box_in(fixed_frame, frame, corners):
    """The lowest and highest corner of the organs, in the fixed frame."""
    low, high = numpy.min(corners, axis=0), numpy.max(corners, axis=0)
    if fixed_frame == frame:
        return low, high
    transforms = tf2_ros.Buffer()
    listener = tf2_ros.TransformListener(transforms)
    try:
        found = transforms.lookup_transform(fixed_frame, frame, rospy.Time(0), rospy.Duration(PATIENCE)).transform
    except tf2_ros.TransformException as error:
        sys.exit("view.py: TF does not connect the fixed frame '%s' with the organ's frame '%s': %s; name another one, "
                 'or none' % (fixed_frame, frame, error))
    finally:
        listener.unregister()
    moved = [rotation(found.rotation) @ numpy.array([(low, high)[i >> axis & 1][axis] for axis in range(3)])
             + (found.translation.x, found.translation.y, found.translation.z) for i in range(8)]
    return numpy.min(moved, axis=0), numpy.max(moved, axis=0)


def round_length(length):
    """The largest of ... 0.1, 0.2, 0.5, 1, 2, 5 ... that is not longer."""
    decade = 10.0 ** math.floor(math.log10(length))
    return max(step * decade for step in (1, 2, 5) if step * decade <= length * (1 + 1e-9))


def fit(configuration, low, high):
    """Points the camera at the box, and puts the grid under it."""
    manager = configuration['Visualization Manager']
    view = manager['Views']['Current']
    centre, size = (low + high) / 2, float(numpy.linalg.norm(high - low)) or 1.0
    view['Focal Point'] = dict(zip('XYZ', map(float, centre + (0, 0, TEXT_ROOM * size))))
    view['Distance'] = DISTANCE * size
    view['Near Clip Distance'] = size / 100
    for display in manager['Displays']:
        if display['Class'] == 'rviz/Grid':
            display['Cell Size'] = round_length(size / CELLS)
            display['Offset'] = dict(zip('XYZ', map(float, (centre[0], centre[1], low[2] - 0.05 * size))))
        elif display['Class'] == 'rviz/TF':
            display['Marker Scale'] = 0.3 * size


def main():
    arguments = rospy.myargv()[1:]
    parser = argparse.ArgumentParser(prog='view.py', description=__doc__.split('\n\n')[0])
    parser.add_argument('topic', nargs='?', default='/organ_collision/markers', metavar='TOPIC')
    parser.add_argument('--fixed-frame', default='', metavar='FRAME')
    parser.add_argument('--save', metavar='FILE')
    options = parser.parse_args(arguments)

    # Without the signal handler of rospy: that one may wait for ever for what the main thread was doing.
    rospy.init_node('view', anonymous=True, disable_signals=True)
    topic = rospy.resolve_name(options.topic)
    with open(os.path.join(roslib.packages.get_pkg_dir('organ_collision'), CONFIGURATION)) as text:
        configuration = yaml.safe_load(text)
    picture = FirstPicture(topic)
    picture.wait(topic)
    manager = configuration['Visualization Manager']
    manager['Global Options']['Fixed Frame'] = fixed_frame = options.fixed_frame or picture.frame
    for display in manager['Displays']:
        if display['Name'] == 'Organs and tools':
            display['Marker Topic'] = topic
    if picture.corners:
        fit(configuration, *box_in(fixed_frame, picture.frame, picture.corners))

    path = options.save or tempfile.mkstemp(prefix='organ_collision_', suffix='.rviz')[1]
    with open(path, 'w') as text:
        yaml.safe_dump(configuration, text)
    if options.save:
        return
    rviz = roslib.packages.find_node('rviz', 'rviz')
    if not rviz:
        sys.exit('view.py: RViz is not installed; install the package rviz')
    rospy.signal_shutdown('RViz takes over')
    os.execv(rviz[0], ['rviz', '-d', path] + [a for a in sys.argv[1:] if ':=' in a])


if __name__ == '__main__':
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)
