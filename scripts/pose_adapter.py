#!/usr/bin/python3
"""Turns poses in messages of any type into transforms on TF, or into geometry_msgs/PoseStamped.

The type need not be installed here: its definition comes with the connection. See launch/pose_adapter.launch.

Parameters
  ~sources                list of sources, each with
      topic         the messages with the pose
      field         the pose in them: a Pose or a Transform, such as pose, pose.pose or transform; default: pose
      child_frame   TF gets the pose as the transform of this frame. Or:
      pose_topic    the pose is published on this topic, for a tool's tip_pose_topic
      frame         the frame that the pose is in, if the messages do not name it
      scale         [m] length of the sender's unit; default: 1
      repeat_sec    [s] how long the last pose of a silent sender is repeated with new stamps; default: 0.5; 0: never
  ~rate                   [Hz] how often a pose is repeated; default: 100
  ~diagnostic_period_sec  [s] between messages on /diagnostics; default: 1
"""

import argparse
import math
import threading
import time

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
import genpy.dynamic
from geometry_msgs.msg import PoseStamped, TransformStamped
from organ_collision.poses import checked_pose
import rospy
from tf2_msgs.msg import TFMessage

KEYS = {'topic', 'field', 'frame', 'scale', 'child_frame', 'pose_topic', 'repeat_sec'}
LATEST = 4294967000  # [s] the latest stamp that the nodes take
QUIET = 1.0  # [s] between two warnings about one source
NESTING = 4  # levels of fields in which poses are looked for, to name them


class Refusal(Exception):
    """What is wrong with a message or a parameter."""


def number(row, key, default, least):
    value = row.get(key, default)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not least <= value < math.inf:
        raise Refusal('%s is %r; must be a finite number of at least %g' % (key, value, least))
    return float(value)


def name(row, key, default=None):
    value = row.get(key, default)
    if not isinstance(value, str) or not value.strip('/'):
        raise Refusal('%s is %r; must be a name' % (key, value))
    return value


def parts(value):
    """The place and the rotation of a Pose or a Transform. None: it is neither."""
    for place, rotation in (('position', 'orientation'), ('translation', 'rotation')):
        if hasattr(value, place) and hasattr(value, rotation):
            return getattr(value, place), getattr(value, rotation)
    return None


def poses_in(message, prefix='', depth=NESTING):
    """The names of all fields that are poses."""
    found = []
    for field in getattr(message, '__slots__', ()) if depth else ():
        value = getattr(message, field)
        found += [prefix + field] if parts(value) else poses_in(value, prefix + field + '.', depth - 1)
    return found


def pose_of(message, field):
    """The place and the rotation in a field of a message, as numbers; the rotation has the norm 1."""
    value = message
    for part in field.split('.'):
        value = getattr(value, part, None)
    if parts(value) is None:
        there = poses_in(message)
        raise Refusal('%s has no pose %r; it has %s'
                      % (message._type, field, ', '.join(there) if there else 'no pose, only ' + fields_of(message)))
    try:
        return checked_pose(*parts(value))
    except ValueError as wrong:
        raise Refusal('%s %s' % (field, wrong))


def fields_of(message):
    return ', '.join(message.__slots__) or 'nothing'


class Reader:
    """Reads messages of a type that is known by its definition alone."""

    def __init__(self):
        self.types = {}  # by name and checksum

    def read(self, message):
        """The message that the bytes of an AnyMsg are. Its type may change from sender to sender."""
        header = message._connection_header
        key = header.get('type'), header.get('md5sum')
        try:
            if key not in self.types:
                self.types[key] = genpy.dynamic.generate_dynamic(key[0], header.get('message_definition', ''))[key[0]]
        except Exception as error:  # genpy and genmsg raise many kinds.
            raise Refusal('the definition of %s cannot be read: %s' % (key[0], str(error).split('\n')[0]))
        try:
            return self.types[key]().deserialize(message._buff)
        except genpy.DeserializationError as error:
            raise Refusal('a message is no %s: %s' % (key[0], error))


class Source:
    """One row of `sources`: the poses of one topic."""

    def __init__(self, row, period, transforms):
        if not isinstance(row, dict):
            raise Refusal('%r is no group of keys' % (row,))
        if set(row) - KEYS:
            raise Refusal('%s: unknown; there are %s' % (', '.join(sorted(set(row) - KEYS)), ', '.join(sorted(KEYS))))
        self.topic, self.field = rospy.resolve_name(name(row, 'topic')), name(row, 'field', 'pose')
        self.frame = name(row, 'frame').lstrip('/') if 'frame' in row else ''
        self.scale = number(row, 'scale', 1.0, 1e-9)
        self.repeat_sec = number(row, 'repeat_sec', 0.5, 0.0)
        if ('child_frame' in row) == ('pose_topic' in row):
            raise Refusal('needs child_frame or pose_topic, one of both')
        self.child = name(row, 'child_frame').lstrip('/') if 'child_frame' in row else ''
        self.out = transforms if self.child else rospy.Publisher(name(row, 'pose_topic'), PoseStamped, queue_size=100)
        self.period, self.reader, self.lock = period, Reader(), threading.Lock()
        self.counts = dict.fromkeys(('received', 'sent', 'repeated', 'same stamp', 'older stamp', 'late', 'refused'), 0)
        self.stamp, self.sent = rospy.Time(), rospy.Time()  # of the sender's last pose, and of what was sent last
        self.pose = self.arrival = self.heard = None  # the last pose: frame, place and rotation; when it came
        self.wrong, self.warned = '', -math.inf
        self.subscriber = rospy.Subscriber(self.topic, rospy.AnyMsg, self.on_message, queue_size=100, tcp_nodelay=True)

    def on_message(self, message):
        with self.lock:
            self.counts['received'] += 1
            try:
                self.take(self.reader.read(message))
            except Refusal as refusal:
                self.counts['refused'] += 1
                self.warn(str(refusal))

    def take(self, message):
        header, now = getattr(message, 'header', None), rospy.Time.now()
        place, rotation = pose_of(message, self.field)
        frame = getattr(header, 'frame_id', '').lstrip('/') or self.frame
        if not frame or frame == self.child:
            raise Refusal('the messages name the frame %r; set `frame`' % frame)
        stamp = getattr(header, 'stamp', rospy.Time()) or now
        if stamp.secs > LATEST:
            raise Refusal('the stamp %d s is beyond what TF can take; at most %d s are allowed' % (stamp.secs, LATEST))
        if stamp <= self.stamp:
            if not self.starts_again(now):
                self.counts['same stamp' if stamp == self.stamp else 'older stamp'] += 1
                return
            self.sent = rospy.Time()
        self.stamp, self.arrival, self.heard, self.wrong = stamp, now, time.monotonic(), ''
        self.pose = frame, tuple(self.scale * part for part in place), rotation
        if stamp > self.sent:
            self.send(stamp)
        elif stamp + self.period > self.sent:  # A repeated pose overtook this one, which comes right after it.
            self.send(self.sent + rospy.Duration(0, 1))
        else:
            self.counts['late'] += 1  # The next one may be in time.

    def starts_again(self, now):
        """Whether older stamps are those of a sender that began anew: time stepped back, or none was newer for long."""
        return now < self.arrival or time.monotonic() - self.heard > max(self.repeat_sec, 1.0)

    def send(self, stamp):
        self.sent = stamp
        frame, place, rotation = self.pose
        message = TransformStamped() if self.child else PoseStamped()
        message.header.frame_id, message.header.stamp = frame, stamp
        to_place, to_rotation = parts(message.transform if self.child else message.pose)
        to_place.x, to_place.y, to_place.z = place
        to_rotation.x, to_rotation.y, to_rotation.z, to_rotation.w = rotation
        if self.child:
            message.child_frame_id = self.child
            message = TFMessage([message])
        self.out.publish(message)
        self.counts['sent'] += 1

    def repeat(self):
        """Sends the last pose again if its sender is silent, but only for a while: a dead tracker must look dead."""
        with self.lock:
            now = rospy.Time.now()
            if self.pose is None or time.monotonic() - self.heard > self.repeat_sec:
                return
            if now < self.arrival:
                return
            stamp = self.stamp + (now - self.arrival)
            if stamp.secs <= LATEST and stamp - self.sent >= self.period:
                self.send(stamp)
                self.counts['repeated'] += 1

    def warn(self, wrong):
        self.wrong = wrong
        if time.monotonic() - self.warned > QUIET:
            self.warned = time.monotonic()
            rospy.logwarn('%s: %s', self.topic, wrong)

    def status(self):
        with self.lock:
            silent = None if self.heard is None else time.monotonic() - self.heard
            level, text = DiagnosticStatus.OK, 'poses come'
            if self.wrong:
                level, text = DiagnosticStatus.ERROR, self.wrong
            elif silent is None:
                level, text = DiagnosticStatus.WARN, 'no message yet'
            elif silent > max(self.repeat_sec, 0.5):
                level, text = DiagnosticStatus.ERROR, 'silent for %.1f s' % silent
            values = [KeyValue(key, str(count)) for key, count in self.counts.items()]
            return DiagnosticStatus(level, '%s: %s' % (rospy.get_name().lstrip('/'), self.topic), text, '', values)


def sources(rows, period, transforms):
    if not isinstance(rows, list) or not rows:
        raise Refusal('must be a list of sources')
    made = []
    for i, row in enumerate(rows):
        try:
            made.append(Source(row, period, transforms))
        except Refusal as refusal:
            raise Refusal('[%d]: %s' % (i, refusal))
    return made


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.parse_args(rospy.myargv()[1:])
    rospy.init_node('pose_adapter')
    given = rospy.get_param('~')
    try:
        period = 1.0 / number(given, 'rate', 100.0, 0.1)
        diagnostic_period = number(given, 'diagnostic_period_sec', 1.0, 0.01)
        transforms = rospy.Publisher('/tf', TFMessage, queue_size=1000)
        made = sources(given.get('sources'), rospy.Duration(period), transforms)
    except Refusal as refusal:
        raise SystemExit('%s: %s' % (rospy.resolve_name('~sources'), refusal))
    diagnostics = rospy.Publisher('/diagnostics', DiagnosticArray, queue_size=10)
    due = 0.0
    while not rospy.is_shutdown():
        for source in made:
            source.repeat()
        if time.monotonic() >= due:
            due = time.monotonic() + diagnostic_period
            array = DiagnosticArray(status=[source.status() for source in made])
            array.header.stamp = rospy.Time.now()
            diagnostics.publish(array)
        time.sleep(period / 2)  # in wall time: a simulator may stop ROS time


if __name__ == '__main__':
    main()
