#!/usr/bin/python3
"""pose_adapter.py: poses in each kind of message, what it refuses, drops and repeats, and what it says of it."""

import math
import sys

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
import genpy.dynamic
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped, Transform, TransformStamped
from organ_collision.msg import ContactArray
import rospy
from rosgraph_msgs.msg import Log as LogLine
import rostest
from tf2_msgs.msg import TFMessage

from support import scenes
from support.node_client import Log, NodeClient, is_heard, wait_until
from support.processes import NodeStarter

ADAPTER = '/poses'


def foreign(name, fields, like):
    """A message of a package that is not installed. `like` has all messages that are in it."""
    parts = like._full_text.partition('=' * 80)
    return genpy.dynamic.generate_dynamic(name, '\n'.join([*fields, parts[1]]) + parts[2])[name]


ODOMETRY = foreign('other_msgs/Odometry', ['std_msgs/Header header', 'string child_frame_id',
                                           'geometry_msgs/PoseWithCovariance pose'], PoseWithCovarianceStamped)
BODY = foreign('other_msgs/Body', ['std_msgs/Header header', 'string name', 'geometry_msgs/Pose pose',
                                   'float32[] joints'], PoseStamped)
BARE = foreign('other_msgs/Bare', ['geometry_msgs/Transform[] all', 'geometry_msgs/Transform pose'], TransformStamped)


def fill(pose, place, rotation=(0.0, 0.0, 0.0, 1.0)):
    """Sets a Pose or a Transform."""
    names = ('position', 'orientation') if hasattr(pose, 'position') else ('translation', 'rotation')
    for name, values in zip(names, (place, rotation)):
        for axis, value in zip('xyzw', values):
            setattr(getattr(pose, name), axis, value)
    return pose


def pose(place, stamp=None, rotation=(0.0, 0.0, 0.0, 1.0), frame='world'):
    message = PoseStamped()
    message.header.frame_id, message.header.stamp = frame, stamp or rospy.Time.now()
    fill(message.pose, place, rotation)
    return message


def place(transform):
    return (transform.translation.x, transform.translation.y, transform.translation.z)


class PoseAdapterTest(NodeStarter):
    @classmethod
    def setUpClass(cls):
        cls.publishers, cls.log = {}, Log('/rosout', LogLine).wait_for_publisher()
        cls.transforms, cls.diagnostics = Log('/tf', TFMessage), Log('/diagnostics', DiagnosticArray)

    @classmethod
    def publish(cls, topic, message):
        publisher = cls.publishers.setdefault(topic, rospy.Publisher(topic, type(message), queue_size=100))
        wait_until(lambda: is_heard(publisher, ADAPTER), '%s to listen to %s' % (ADAPTER, topic))
        publisher.publish(message)

    def of(self, child):
        """All transforms of a frame."""
        return [t for message in self.transforms.messages for t in message.transforms if t.child_frame_id == child]

    def wait_for_place(self, child, expected):
        found = wait_until(lambda: [t for t in self.of(child) if math.dist(place(t.transform), expected) < 1e-9],
                           lambda: '%s at %s' % (child, expected))[0]
        return found

    def has_line(self, *words):
        return self.log.select(lambda line: all(word in line.msg for word in words))

    def publish_until(self, topic, message, words):
        """Publishes until a line has the topic and the words. The adapter logs one line a second about each source."""
        wait_until(lambda: self.publish(topic, message) or rospy.sleep(0.05) or self.has_line(topic, *words),
                   lambda: 'a line with %s' % (words,))

    def status(self, topic):
        """What the adapter said last about a source."""
        found = [status for message in self.diagnostics.messages for status in message.status
                 if status.name == 'poses: ' + topic]
        return found[-1] if found else DiagnosticStatus()

    def count(self, topic, key):
        return int(dict((pair.key, pair.value) for pair in self.status(topic).values).get(key, 0))

    def test_poses_in_messages_of_each_type(self):
        """The frame of the message, and its stamp; if it has none, the frame of the parameter, and the time."""
        stamp, turn = rospy.Time.now(), (0.0, 0.6, 0.0, 0.8)
        self.publish('/sim/pose', pose((1, 2, 3), stamp, turn))
        found = self.wait_for_place('pose_tip', (1, 2, 3))
        self.assertEqual((found.header.frame_id, found.header.stamp), ('world', stamp))
        self.assertEqual((found.transform.rotation.y, found.transform.rotation.w), (0.6, 0.8))
        moved = TransformStamped()
        moved.header.frame_id, moved.header.stamp = 'world', stamp
        fill(moved.transform, (4, 5, 6))
        self.publish('/sim/transform', moved)
        self.wait_for_place('transform_tip', (4, 5, 6))
        sent = Log('/odometry_tip', PoseStamped).wait_for_publisher()
        odometry = ODOMETRY()
        odometry.header.frame_id, odometry.header.stamp = 'odom', stamp
        fill(odometry.pose.pose, (7, 8, 9))
        self.publish('/sim/odometry', odometry)
        first = wait_until(lambda: sent.messages, 'a pose')[0]
        self.assertEqual((first.header.frame_id, first.header.stamp, first.pose.position.x), ('odom', stamp, 7))
        tracked = PoseWithCovarianceStamped()
        tracked.header.frame_id, tracked.header.stamp = 'tracker', stamp
        fill(tracked.pose.pose, (100, 0, 0))
        self.publish('/sim/covariance', tracked)
        self.wait_for_place('covariance_tip', (0.1, 0, 0))
        body = BODY(name='hook')
        body.header.stamp = stamp
        fill(body.pose, (1, -1, 0), (0, 0, 0, 2))
        self.publish('/sim/body', body)
        found = self.wait_for_place('body_tip', (0.01, -0.01, 0))
        self.assertEqual((found.header.frame_id, found.transform.rotation.w), ('sim_world', 1))
        before = rospy.Time.now()
        self.publish('/sim/bare', BARE(pose=fill(Transform(), (0, 0, 1))))
        self.assertGreaterEqual(self.wait_for_place('bare_tip', (0, 0, 1)).header.stamp, before)

    def test_refused_messages_leave_the_next_one_alone(self):
        for wrong, words in ((pose((math.nan, 0, 0)), ('not finite', 'nan')),
                             (pose((0, 0, 0), rotation=(0, 0, 0, 0)), ('no rotation',)),
                             (pose((0, 0, 0), frame=''), ("frame ''",)),
                             (pose((0, 0, 0), frame='pose_tip'), ("frame 'pose_tip'",))):
            self.publish_until('/sim/pose', wrong, words)
        self.publish('/sim/pose', pose((0, 0, 17)))
        self.wait_for_place('pose_tip', (0, 0, 17))
        wait_until(lambda: self.count('/sim/pose', 'refused') >= 4, 'four refused messages')

    def test_stamps_that_repeat_or_go_back_are_dropped_and_counted(self):
        stamp = rospy.Time.now()
        for x, offset in ((30, 0), (31, 0), (32, -1), (33, 1)):
            self.publish('/sim/covariance', self.covariance(1000 * x, stamp + rospy.Duration(0, 1000 * offset)))
        self.wait_for_place('covariance_tip', (33, 0, 0))
        self.assertFalse([t for t in self.of('covariance_tip') if t.transform.translation.x in (31.0, 32.0)])
        wait_until(lambda: self.count('/sim/covariance', 'same stamp') == 1 and
                   self.count('/sim/covariance', 'older stamp') == 1, 'two dropped messages')

    @staticmethod
    def covariance(x, stamp):
        message = PoseWithCovarianceStamped()
        message.header.frame_id, message.header.stamp = 'tracker', stamp
        fill(message.pose.pose, (x, 0, 0))
        return message

    def test_a_silent_sender_is_repeated_for_a_while(self):
        """With new stamps, which rise. Then it is silent, and the diagnostics say so. Its next pose ends that."""
        start = rospy.Time.now()
        self.publish('/sim/tracker', pose((0, 0, 50), start))
        wait_until(lambda: 'silent' in self.status('/sim/tracker').message, 'silence')
        self.assertEqual(self.status('/sim/tracker').level, DiagnosticStatus.ERROR)
        stamps = [t.header.stamp for t in self.of('tracker_tip')]
        self.assertGreater(len(stamps), 3)
        self.assertEqual(stamps, sorted(set(stamps)))
        # The stamps go on as time does, until the end of repeat_sec and of one pause of the adapter.
        self.assertGreater((stamps[-1] - start).to_sec(), 0.5)
        rospy.sleep(0.3)
        self.assertEqual(len(self.of('tracker_tip')), len(stamps))
        self.publish('/sim/tracker', pose((0, 0, 51)))
        self.wait_for_place('tracker_tip', (0, 0, 51))
        wait_until(lambda: self.status('/sim/tracker').message == 'poses come', 'poses again')

    @staticmethod
    def body(x, stamp):
        body = BODY()
        body.header.stamp = stamp
        fill(body.pose, (x, 0, 0))
        return body

    def test_shapes_are_answered_while_a_tracker_rests(self):
        """A tool sends one pose and then rests. Shapes get no transform, until the pose is repeated."""
        tool = {'name': 'stylus', 'trocar_frame': 'tissue', 'tip_frame': 'tip', 'radius': 0.005,
                'tip_pose_topic': '/resting_tip'}
        self.start('/repeated', {'tools': [tool]})
        node, sheet = NodeClient('/repeated', frame='tissue'), scenes.sheet(0.2, 1, 0.05)
        node.bring('sheet', sheet, rospy.Time.now())

        def answers(status):
            rospy.sleep(0.02)
            node.send_vertices('sheet', sheet, rospy.Time.now())
            return node.contacts.of('sheet', 'stylus', status=status)

        wait_until(lambda: answers(ContactArray.NO_TRANSFORM), 'an answer NO_TRANSFORM')
        self.publish('/sim/resting', pose((0.01, 0.0, 0.047), frame='tissue'))
        found = wait_until(lambda: len(answers(ContactArray.OK)) >= 20 and answers(ContactArray.OK), 'answers OK')
        self.assertTrue(all(answer.contacts for answer in found))

    def test_parameters_that_are_refused(self):
        good = {'topic': 'a', 'child_frame': 'b'}
        for row, words in (({**good, 'scale': 0}, ('[0]', 'scale', '0')), ({**good, 'scael': 1}, ('scael', 'scale')),
                           ({'topic': 'a'}, ('child_frame', 'pose_topic')), ({'child_frame': 'b'}, ('topic', 'None')),
                           ({**good, 'repeat_sec': -1}, ('repeat_sec', '-1')), ('a', ("'a'",)),
                           ({**good, 'pose_topic': 'c'}, ('one of both',)), ({**good, 'scale': True}, ('scale', 'True'))):
            process = self.start('/wrong', {'sources': [row]}, 'pose_adapter.py')
            self.assert_refused(process, words)
        self.assert_refused(self.start('/wrong', {'sources': []}, 'pose_adapter.py'), ('list of sources',))
        self.assert_refused(self.start('/wrong', {'rate': 0, 'sources': [good]}, 'pose_adapter.py'), ('rate is 0',))


if __name__ == '__main__':
    rospy.init_node('pose_adapter_test')
    rostest.rosrun('organ_collision', 'pose_adapter', PoseAdapterTest, sys.argv)
