#!/usr/bin/python3
"""Connects a hand that speaks CRTK, the interface of surgical robots and haptic devices, with haptic_proxy: from
measured_cp of the device to the pose of the tool, and from the wrench of the tool to servo_cf of the device.

Topics, to be remapped
  measured_cp   geometry_msgs/PoseStamped, of the arm that carries the tool. Invalid ones have the stamp 0
  pose          the valid ones of them, for tip_pose_topic
  wrench        of haptic_proxy: HAPTIC_PROXY/TOOL/wrench, in the axes of the tip, its torque about the tip. Or a wrench
                in a frame of TF
  servo_cf      geometry_msgs/WrenchStamped, of the arm that the hand holds. CRTK says by the name of the topic what
                its axes are, and about which point its torque is: body/servo_cf or spatial/servo_cf

Parameters
  ~axes           tip: those of the tip, as for body/servo_cf; base: those of the frame of measured_cp, as for
                  spatial/servo_cf; or any frame that TF connects with that of the wrench, or else with that of
                  measured_cp. Default: tip
  ~torque_about   tip, or axes: the origin of that frame, as for spatial/servo_cf; default: tip
  ~max_force      [N] default: 2
  ~max_torque     [N m] default: 0, no torque
  ~force_scale    [1] of force and torque; default: 1
  ~rate           [Hz] at which servo_cf is sent again while no new wrench comes; default: 0, never
  ~timeout        [s] without a wrench, after which the force becomes zero within 10 ms; default: 0.1
"""

import argparse
import math
import threading
import time

from geometry_msgs.msg import PoseStamped, Vector3, Wrench as WrenchMessage, WrenchStamped
from PyKDL import Frame, Rotation, Vector, Wrench
import rospy
from std_msgs.msg import Bool, Header
import tf2_ros

LET_GO = (0.8, 0.6, 0.4, 0.2, 0.0)  # shares of the last wrench, 2 ms apart


def number(name, default, least):
    value = rospy.get_param(name, default)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not least <= value < math.inf:
        raise SystemExit('%s is %r; must be a number of at least %g' % (rospy.resolve_name(name), value, least))
    return value


def text(name, default):
    value = rospy.get_param(name, default)
    if not isinstance(value, str) or not value:
        raise SystemExit('%s is %r; must be a name' % (rospy.resolve_name(name), value))
    return value


def frame(place, rotation):
    return Frame(Rotation.Quaternion(rotation.x, rotation.y, rotation.z, rotation.w), Vector(place.x, place.y, place.z))


def limited(vector, most):
    """The vector, shortened to at most this length."""
    return vector if vector.Norm() <= most else vector * (most / vector.Norm())


class Hand:
    def __init__(self):
        self.axes, self.torque_about = text('~axes', 'tip'), text('~torque_about', 'tip')
        if self.torque_about not in ('tip', 'axes'):
            raise SystemExit('~torque_about is %r; must be tip or axes' % self.torque_about)
        self.max_force, self.max_torque = number('~max_force', 2.0, 0.0), number('~max_torque', 0.0, 0.0)
        self.scale, self.timeout = number('~force_scale', 1.0, 0.0), number('~timeout', 0.1, 0.01)
        rate = number('~rate', 0.0, 0.0)
        self.period = 1.0 / rate if rate else math.inf
        self.base, self.tip = '', None  # the frame of measured_cp, and the tip's pose in it
        self.felt, self.sent = None, (-math.inf, Wrench(), '')  # when the last wrench came; when, what and where was sent
        self.lock = threading.RLock()
        self.transforms = tf2_ros.Buffer()
        self.listener = tf2_ros.TransformListener(self.transforms)
        # Each step of letting go leaves, also where the socket is slow: the force must not jump.
        self.force = rospy.Publisher('servo_cf', WrenchStamped, queue_size=len(LET_GO), tcp_nodelay=True)
        self.pose = rospy.Publisher('pose', PoseStamped, queue_size=100, tcp_nodelay=True)
        # The body/servo_cf of a dVRK is in the axes of the base if it was told so.
        self.absolute = rospy.Publisher('set_cf_orientation_absolute', Bool, queue_size=1, latch=True)
        self.absolute.publish(self.axes != 'tip')
        self.subscribers = [rospy.Subscriber('measured_cp', PoseStamped, self.move, queue_size=100, tcp_nodelay=True),
                            rospy.Subscriber('wrench', WrenchStamped, self.feel, queue_size=1, tcp_nodelay=True)]
        rospy.on_shutdown(self.let_go)

    def move(self, message):
        if message.header.stamp:
            self.base, self.tip = message.header.frame_id, frame(message.pose.position, message.pose.orientation)
            self.pose.publish(message)

    def feel(self, message):
        try:
            name, T_axes_tip = self.place_of(message.header.frame_id)
        except tf2_ros.TransformException as error:
            return rospy.logwarn_throttle(1, 'no force on the hand: %s' % error)
        f, t = message.wrench.force, message.wrench.torque
        wrench = Wrench(Vector(f.x, f.y, f.z), Vector(t.x, t.y, t.z)) * self.scale
        if not math.isfinite(wrench.force.Norm() + wrench.torque.Norm()):
            return rospy.logwarn_throttle(1, 'no force on the hand: the wrench is not finite')
        wrench = Wrench(limited(wrench.force, self.max_force), limited(wrench.torque, self.max_torque))
        with self.lock:
            self.felt = time.monotonic()
            # A rotation turns both parts. A frame also moves the point of the torque, to its origin.
            self.send((T_axes_tip if self.torque_about == 'axes' else T_axes_tip.M) * wrench, name)

    def place_of(self, tip):
        """The name of the frame of the axes, and the pose of the wrench's frame in it."""
        if self.axes == 'tip':
            return tip, Frame()
        base, T_base_tip = self.base, self.tip
        if self.axes != 'base' and (not self.tip or self.transforms.can_transform(self.axes, tip, rospy.Time())):
            base, T_base_tip = tip, Frame()
        if not T_base_tip:
            raise tf2_ros.TransformException('no valid pose on %s' % rospy.resolve_name('measured_cp'))
        if self.axes in ('base', base):
            return base, T_base_tip
        transform = self.transforms.lookup_transform(self.axes, base, rospy.Time()).transform
        return self.axes, frame(transform.translation, transform.rotation) * T_base_tip

    def watch(self):
        """Lets go if no wrench comes any more, and sends the last one again if it is time."""
        with self.lock:
            if self.felt is None:
                return
            if time.monotonic() - self.felt > self.timeout:
                rospy.logwarn('no force on the hand: no wrench for %g s' % self.timeout)
                self.let_go()
            elif time.monotonic() - self.sent[0] >= self.period:
                self.send(*self.sent[1:])

    def let_go(self):
        with self.lock:
            self.felt = None
            _, last, name = self.sent
            for share in LET_GO if name else ():
                self.send(last * share, name)
                time.sleep(0.002)

    def send(self, wrench, name):
        self.sent = time.monotonic(), wrench, name
        message = WrenchMessage(Vector3(*wrench.force), Vector3(*wrench.torque))
        self.force.publish(WrenchStamped(Header(0, rospy.Time.now(), name), message))


if __name__ == '__main__':
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.parse_args(rospy.myargv()[1:])  # --help
    rospy.init_node('crtk_hand')
    hand = Hand()
    while not rospy.is_shutdown():
        hand.watch()
        time.sleep(min(0.002, hand.period / 2))  # Not rospy's clock, which a simulator may stop.
