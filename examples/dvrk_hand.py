#!/usr/bin/python3
"""Sends the force of the tissue on an instrument to the hand that moves it: from the wrench of haptic_proxy to the
servo_cf of a dVRK's MTM. Sends no torque. If no wrench arrives any more, the force becomes zero."""

import argparse
import math
import time

from geometry_msgs.msg import Vector3, Wrench, WrenchStamped
from PyKDL import Rotation, Vector
import rospy
from std_msgs.msg import Bool, Header
import tf2_ros


def positive(name, default):
    value = rospy.get_param(name, default)
    if not (isinstance(value, (int, float)) and 0 < value < math.inf):
        raise SystemExit('%s is %r; must be a positive number' % (rospy.resolve_name(name), value))
    return value


class Hand:
    def __init__(self):
        self.max_force = positive('~max_force', 2.0)  # [N]
        self.scale = positive('~force_scale', 1.0)
        self.timeout = positive('~timeout', 0.1)  # [s] without a wrench, after which the force is zero
        self.frame = rospy.get_param('~frame', 'ECM')  # The axes of the camera are those of the surgeon's display.
        self.last_wrench = None
        self.last_force = Vector()
        self.transforms = tf2_ros.Buffer()
        self.listener = tf2_ros.TransformListener(self.transforms)
        self.force = rospy.Publisher('servo_cf', WrenchStamped, queue_size=1)
        # Otherwise the dVRK takes forces in the frame of the hand's grip, which turns with the hand.
        self.absolute = rospy.Publisher('set_cf_orientation_absolute', Bool, queue_size=1, latch=True)
        self.absolute.publish(True)
        self.wrench = rospy.Subscriber('wrench', WrenchStamped, self.feel, queue_size=1)
        rospy.on_shutdown(self.release)

    def feel(self, wrench):
        try:
            transform = self.transforms.lookup_transform(self.frame, wrench.header.frame_id, rospy.Time())
        except tf2_ros.TransformException as error:
            return rospy.logwarn_throttle(1, 'no force on the hand: %s' % error)
        q, f = transform.transform.rotation, wrench.wrench.force
        force = self.scale * (Rotation.Quaternion(q.x, q.y, q.z, q.w) * Vector(f.x, f.y, f.z))
        size = force.Norm()
        if not math.isfinite(size):
            return rospy.logwarn_throttle(1, 'no force on the hand: the wrench is not finite')
        if size > self.max_force:
            force *= self.max_force / size
        self.last_wrench = time.monotonic()
        self.last_force = force
        self.send(force)

    def watch(self):
        if self.last_wrench is not None and time.monotonic() - self.last_wrench > self.timeout:
            self.last_wrench = None
            rospy.logwarn('no force on the hand: no wrench for %g s' % self.timeout)
            self.release()

    def release(self):
        """The force becomes zero within 10 ms."""
        for share in (0.8, 0.6, 0.4, 0.2, 0.0):
            self.send(share * self.last_force)
            time.sleep(0.002)
        self.last_force = Vector()

    def send(self, force):
        self.force.publish(WrenchStamped(Header(0, rospy.Time.now(), self.frame), Wrench(Vector3(*force), Vector3())))


if __name__ == '__main__':
    argparse.ArgumentParser(description=__doc__).parse_args(rospy.myargv()[1:])  # --help
    rospy.init_node('dvrk_hand')
    hand = Hand()
    while not rospy.is_shutdown():
        hand.watch()
        time.sleep(hand.timeout / 4)  # Not rospy's clock, which a simulator may stop.
