#!/usr/bin/python3
"""Starts RViz so that it shows the organs and tools of a collision node. Nothing needs to be edited: the fixed frame
is that of the first organ, and the camera and the grid fit the size of the organs, also when other organs come.

Usage: view.py [--fixed-frame FRAME] [--view YAW,PITCH] [--save FILE | --picture FILE [--size WxH]] [TOPIC]

  TOPIC             the markers of the node; default: /organ_collision/markers
  --fixed-frame     another fixed frame, to which TF connects the organs; empty: that of the first organ
  --view YAW,PITCH  where the viewer is, seen from the organs: azimuth and elevation in degrees; write --view=-90,30
  --save FILE       writes the RViz configuration to FILE instead of starting RViz
  --picture FILE    writes a picture of RViz to FILE, such as liver.png, and ends. It needs no display, but the programs
                    Xvfb and import (Debian: xvfb, imagemagick). If the scene moves, this takes half a minute
  --size WxH        of the picture in pixels; default: 1280x800
"""

import argparse
import itertools
import math
import os
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time

import numpy
from PyKDL import Frame, Rotation, Vector
import roslib.packages
import rospy
from std_msgs.msg import Bool, String
import tf2_ros
import yaml

CONFIGURATION = 'config/organ_collision.rviz'
DISTANCE = 1.6  # of the camera from the organs, as a share of their diagonal
TEXT_ROOM = 0.15  # the camera looks so far below the centre, because the status stands below the organ
CELLS = 6  # of the grid, along that diagonal
PATIENCE = 5.0  # [s] for a transform, and for RViz
START = 60.0  # [s] for the start of RViz in software
# RViz has drawn all if its picture has not changed for STILL [s]. The picture of a scene that moves is the third one.
STILL, PICTURES = 8.0, 3
# The view is fitted anew if the organs' centre has moved by more than this share of their diagonal, or if the diagonal
# has changed by more than this factor. A deformation changes less.
MOVED, GROWN = 0.5, 1.5
END_OF_SCENE = struct.pack('<I6s', 6, b'status')  # a namespace of the message that follows all surfaces


class SendFilePath:
    """The type of RViz's services that save and load its configuration. Debian does not have its Python module. These
    messages have the same fields as its request and its response."""

    _type, _md5sum = 'rviz/SendFilePath', '*'
    _request_class, _response_class = String, Bool


class Organs:
    """The organs on the topic, as boxes. Reads the bytes of the messages, because rospy is too slow for large
    surfaces."""

    def __init__(self, topic):
        self.boxes = {}  # of each surface, by number of the marker: frame, corners, and when they expire
        self.frame = None
        self.are_complete = threading.Event()
        self.subscriber = rospy.Subscriber(topic, rospy.AnyMsg, self.on_markers, queue_size=4000)

    def on_markers(self, message):
        """A surface comes first in a message, and the status in a message that follows all surfaces, or in the same."""
        array = message._buff
        if struct.unpack_from('<I', array)[0] == 0:
            return
        frame, at = text_at(array, 4 + 12)
        name, at = text_at(array, at)
        number, _, action = struct.unpack_from('<3i', array, at)
        if name.startswith('surface/') and action == 0:
            lifetime, _, _, count = struct.unpack_from('<iiBI', array, at + 108)
            points = numpy.frombuffer(array, '<f8', 3 * count, at + 121).reshape(-1, 3)
            if number == 0:  # The markers of a surface come in turn, and replace all that came before.
                self.boxes[name] = {}
            if name in self.boxes:
                box = frame, points.min(axis=0), points.max(axis=0), time.monotonic() + lifetime
                self.boxes[name][number] = box
        if END_OF_SCENE in array:
            self.frame = self.frame or frame
            self.are_complete.set()

    def wait(self, topic):
        while not self.are_complete.wait(0.1):
            rospy.loginfo_throttle(10.0, 'waiting for the first organ on %s' % topic)
            if rospy.is_shutdown():
                sys.exit()

    def box(self):
        """The frame of the first organ, and the lowest and highest corners of all organs in it, or no corners."""
        boxes = [box for surface in list(self.boxes.values()) for box in list(surface.values())
                 if box[3] > time.monotonic()]
        if not boxes:
            return self.frame, None
        corners = [corner for frame, *corners, _ in boxes if frame == boxes[0][0] for corner in corners]
        return boxes[0][0], (numpy.min(corners, axis=0), numpy.max(corners, axis=0))


def text_at(array, at):
    """The text at a place of a message, and the place behind it."""
    begin = at + 4
    end = begin + struct.unpack_from('<I', array, at)[0]
    return array[begin:end].decode(), end


def box_in(fixed_frame, frame, corners):
    """The lowest and highest corner of the organs, in the fixed frame."""
    low, high = corners
    if fixed_frame == frame:
        return low, high
    transforms = tf2_ros.Buffer()
    listener = tf2_ros.TransformListener(transforms)
    try:
        found = transforms.lookup_transform(fixed_frame, frame, rospy.Time(0), rospy.Duration(PATIENCE)).transform
    finally:
        listener.unregister()
    q, p = found.rotation, found.translation
    pose = Frame(Rotation.Quaternion(q.x, q.y, q.z, q.w), Vector(p.x, p.y, p.z))
    moved = [list(pose * Vector(*corner)) for corner in itertools.product(*zip(low, high))]
    return numpy.min(moved, axis=0), numpy.max(moved, axis=0)


def round_length(length):
    """The largest of ... 0.1, 0.2, 0.5, 1, 2, 5 ... that is not longer."""
    decade = 10.0 ** math.floor(math.log10(length))
    return max(step * decade for step in (1, 2, 5) if step * decade <= length * (1 + 1e-9))


def size_of(box):
    return float(numpy.linalg.norm(box[1] - box[0])) or 1.0


def is_other(box, shown):
    """Whether a view that fits the box `shown` does not fit this one."""
    if box is None or shown is None:
        return box is not shown
    way = numpy.linalg.norm(numpy.add(*box) - numpy.add(*shown)) / 2
    return way > MOVED * size_of(shown) or not 1 / GROWN < size_of(box) / size_of(shown) < GROWN


def fit(configuration, fixed_frame, box):
    """Points the camera at the box, and puts the grid under it."""
    manager = configuration['Visualization Manager']
    manager['Global Options']['Fixed Frame'] = fixed_frame
    if box is None:
        return
    view = manager['Views']['Current']
    low, high = box
    centre, size = (low + high) / 2, size_of(box)
    view['Focal Point'] = dict(zip('XYZ', map(float, centre - (0, 0, TEXT_ROOM * size))))
    view['Distance'] = DISTANCE * size
    view['Near Clip Distance'] = size / 100
    for display in manager['Displays']:
        if display['Class'] == 'rviz/Grid':
            display['Cell Size'] = round_length(size / CELLS)
            display['Offset'] = dict(zip('XYZ', map(float, (centre[0], centre[1], low[2] - 0.05 * size))))
        elif display['Class'] == 'rviz/TF':
            display['Marker Scale'] = 0.3 * size


class View:
    """An RViz whose configuration fits the organs."""

    def __init__(self, organs, topic, fixed_frame, path, angles=None):
        """`angles`: yaw and pitch of the camera [degrees]."""
        self.organs, self.wanted_frame, self.path, self.shown = organs, fixed_frame, path, None
        with open(os.path.join(roslib.packages.get_pkg_dir('organ_collision'), CONFIGURATION)) as text:
            configuration = yaml.safe_load(text)
        manager = configuration['Visualization Manager']
        for display in manager['Displays']:
            if display['Name'] == 'Organs and tools':
                display['Marker Topic'] = topic
        if angles:
            manager['Views']['Current'].update(zip(('Yaw', 'Pitch'), map(math.radians, angles)))
        self.write(configuration)

    def write(self, configuration):
        """Writes the file: the configuration with frame, camera and grid for the organs that are there."""
        frame, box = self.organs.box()
        fixed_frame = self.wanted_frame or frame
        fit(configuration, fixed_frame, box and box_in(fixed_frame, frame, box))
        self.shown = frame, box
        with open(self.path, 'w') as text:
            yaml.safe_dump(configuration, text)

    def show(self, rviz):
        """Runs RViz until somebody closes it."""
        name = rospy.get_name() + '_window'
        process = subprocess.Popen(command(rviz, self.path))
        try:
            while process.poll() is None:
                time.sleep(1.0)
                self.follow(name)
        finally:
            process.terminate()
            process.wait()
        return process.returncode

    def follow(self, name):
        """If there are other organs, RViz gets a view that fits them. All its other settings stay as they are."""
        frame, box = self.organs.box()
        if box is None or frame == self.shown[0] and not is_other(box, self.shown[1]):
            return
        time.sleep(1.0)  # A large surface comes in several messages.
        try:
            self.call(name + '/save_config')
            with open(self.path) as text:
                configuration = yaml.safe_load(text)
            self.write(configuration)
            self.call(name + '/load_config_discarding_changes')
        except (rospy.ROSException, rospy.ServiceException, tf2_ros.TransformException) as error:
            rospy.logwarn_throttle(10.0, 'the view does not fit the organs: %s' % error)

    def call(self, service):
        rospy.wait_for_service(service, PATIENCE)
        rospy.ServiceProxy(service, SendFilePath)(String(self.path))


def command(rviz, path, *options):
    """Starts RViz with a configuration, as the node NAME_window, where NAME is that of this node."""
    arguments = [a for a in sys.argv[1:] if ':=' in a and not a.startswith(('__name:=', '__log:='))]
    return [rviz, '-d', path, *options, '__name:=' + rospy.get_name().split('/')[-1] + '_window', *arguments]


def take_picture(rviz, path, size, output):
    """Writes a picture of RViz with a configuration, which gets this size of the window, in an X server that has no
    screen. Raises RuntimeError."""
    with open(path) as text:
        configuration = yaml.safe_load(text)
    configuration['Window Geometry'].update(zip(('Width', 'Height'), size))  # Nobody manages windows there.
    with open(path, 'w') as text:
        yaml.safe_dump(configuration, text)
    reader, writer = os.pipe()
    processes = []
    try:
        processes.append(subprocess.Popen(['Xvfb', '-displayfd', str(writer), '-screen', '0', '%dx%dx24' % size],
                                          pass_fds=[writer], stderr=subprocess.DEVNULL))
        os.close(writer)
        with os.fdopen(reader) as display:
            number = display.readline().strip()
        environment = {**os.environ, 'DISPLAY': ':' + number, 'LIBGL_ALWAYS_SOFTWARE': '1', 'QT_X11_NO_MITSHM': '1'}
        processes.append(subprocess.Popen(command(rviz, path, '--fullscreen'), env=environment,
                                          stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
        rospy.wait_for_service(rospy.get_name() + '_window/save_config', START)
        before = None
        for _ in range(PICTURES):
            time.sleep(STILL)
            subprocess.run(['import', '-window', 'root', '-strip', output], check=True, env=environment)
            with open(output, 'rb') as picture:
                before, last = picture.read(), before
            if before == last:
                break
    except (OSError, rospy.ROSException, subprocess.CalledProcessError) as error:
        raise RuntimeError('no picture of RViz: %s' % error) from error
    finally:
        for process in reversed(processes):
            process.terminate()
            process.wait()


def numbers(separator, kind):
    """Reads two numbers from an option's text."""
    def read(text):
        first, second = map(kind, text.split(separator))
        return first, second
    read.__name__ = 'two numbers with %r between them' % separator
    return read


def main():
    arguments = rospy.myargv()[1:]
    parser = argparse.ArgumentParser(prog='view.py', description=__doc__.split('\n\n')[0])
    parser.add_argument('topic', nargs='?', default='/organ_collision/markers', metavar='TOPIC')
    parser.add_argument('--fixed-frame', default='', metavar='FRAME')
    parser.add_argument('--view', metavar='YAW,PITCH', type=numbers(',', float))
    outputs = parser.add_mutually_exclusive_group()
    outputs.add_argument('--save', metavar='FILE')
    outputs.add_argument('--picture', metavar='FILE')
    parser.add_argument('--size', metavar='WxH', type=numbers('x', int), default=(1280, 800))
    options = parser.parse_args(arguments)

    # Without the signal handler of rospy: that one may wait for ever for what the main thread was doing.
    rospy.init_node('view', anonymous=True, disable_signals=True)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    topic = rospy.resolve_name(options.topic)
    organs = Organs(topic)
    organs.wait(topic)
    try:
        path = options.save or tempfile.mkstemp(prefix='organ_collision_', suffix='.rviz')[1]
        view = View(organs, topic, options.fixed_frame, path, options.view)
    except tf2_ros.TransformException as error:
        sys.exit("view.py: TF does not connect the fixed frame '%s' with the organ's frame '%s': %s; name another one, "
                 'or none' % (options.fixed_frame, organs.box()[0], error))
    if options.save:
        return
    rviz = roslib.packages.find_node('rviz', 'rviz')
    if not rviz:
        sys.exit('view.py: RViz is not installed; install the package rviz')
    if not options.picture:
        sys.exit(view.show(rviz[0]))
    try:
        take_picture(rviz[0], path, options.size, options.picture)
    except RuntimeError as error:
        sys.exit('view.py: %s' % error)


if __name__ == '__main__':
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)
