"""The joints and poses of a robot, as TF tells them."""

import rospy
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage
import tf2_ros

from . import scenes


class RobotLog:
    """All transforms and joint states since the start. On a busy machine, a tf2_ros.TransformListener would drop
    some."""

    def __init__(self):
        self.states = []
        self.transforms = tf2_ros.Buffer(rospy.Duration(1000.0))
        self.subscribers = [
            rospy.Subscriber('/tf', TFMessage, self._add, queue_size=10000),
            rospy.Subscriber('/tf_static', TFMessage, self._add, True, queue_size=100),
            rospy.Subscriber('/joint_states', JointState, self.states.append, queue_size=10000),
        ]

    def _add(self, message, resting=False):
        add = self.transforms.set_transform_static if resting else self.transforms.set_transform
        for transform in message.transforms:
            add(transform, 'test')

    def close(self):
        for subscriber in self.subscribers:
            subscriber.unregister()

    def knows(self, parent, frames, *stamps):
        return all(self.transforms.can_transform(parent, frame, stamp) for frame in frames for stamp in stamps)

    def pose(self, parent, frame, stamp):
        transform = self.transforms.lookup_transform(parent, frame, stamp).transform
        r, t = transform.rotation, transform.translation
        return scenes.Pose((r.x, r.y, r.z, r.w), (t.x, t.y, t.z))
