#!/usr/bin/python3
"""Connects a hand that speaks CRTK, the interface of surgical robots and haptic devices, with haptic_proxy: from
measured_cp of the device to the pose of the tool, and from the wrench of the tool to servo_cf of the device.

Topics, to be remapped
  measured_cp   geometry_msgs/PoseStamped, of the arm that carries the tool. Invalid ones have the stamp 0, numbers that
                are not finite, or a quaternion without direction
  pose          the valid ones of them, with quaternions of norm 1, for tip_pose_topic
  wrench        of haptic_proxy: HAPTIC_PROXY/TOOL/wrench, in the axes of the tip, its torque about the tip. Or a wrench
                in a frame of TF
  servo_cf      geometry_msgs/WrenchStamped, of the arm that the hand holds. CRTK says by the name of the topic what
                its axes are, and about which point its torque is: body/servo_cf or spatial/servo_cf

Parameters
  ~axes           tip: those of the tip, as for body/servo_cf; base: those of the frame of measured_cp, as for
                  spatial/servo_cf; or any frame that TF connects with that of the wrench, or else with that of
                  measured_cp. Default: tip
  ~torque_about   tip, or axes: the origin of that frame, as for spatial/servo_cf; default: tip
  ~max_force      [N] of what is sent; default: 2
  ~max_torque     [N m] of what is sent, and about the tip; default: 0, no torque. About the origin of axes, the force has
                  a torque of its own: where that is larger, the force shrinks with it, so set a limit there
  ~force_scale    [1] of force and torque; default: 1
  ~rate           [Hz] at which servo_cf is sent again while no new wrench comes; default: 0, never
  ~timeout        [s] without a wrench, after which the force becomes zero within 10 ms; default: 0.1
"""

import argparse
import math
import signal
import threading
import time

from geometry_msgs.msg import PoseStamped, Quaternion, Vector3, Wrench as WrenchMessage, WrenchStamped
from organ_collision.poses import checked_pose
from PyKDL import Frame, Rotation, Vector, Wrench
import rospy
from std_msgs.msg import Bool, Header
import tf2_ros

LET_GO = (0.8, 0.6, 0.4, 0.2, 0.0)  # shares of the last wrench, 2 ms apart
FAREWELL = 0.2  # [s] in which the last messages leave


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


def frame(place, turn):
    """Raises ValueError."""
    place, turn = checked_pose(place, turn)
    return Frame(Rotation.Quaternion(*turn), Vector(*place))


def share_of(vector, most):
    """By which factor the vector shrinks to at most this length."""
    return 1.0 if vector.Norm() <= most else most / vector.Norm()


class Hand:
    def __init__(self):
        self.axes, self.torque_about = text('~axes', 'tip'), text('~torque_about', 'tip')
        if self.torque_about not in ('tip', 'axes'):
            raise SystemExit('~torque_about is %r; must be tip or axes' % self.torque_about)
        self.max_force, self.max_torque = number('~max_force', 2.0, 0.0), number('~max_torque', 0.0, 0.0)
        self.scale, self.timeout = number('~force_scale', 1.0, 0.0), number('~timeout', 0.1, 0.01)
        rate = number('~rate', 0.0, 0.0)
        self.period = 1.0 / rate if rate else math.inf
        if self.torque_about == 'axes' and not self.max_torque:
            rospy.logwarn('~max_torque is 0: with ~torque_about axes, no force is sent. Set ~max_torque')
        self.arm = '', None  # the frame of measured_cp, and the tip's pose in it
        self.felt, self.sent = None, (-math.inf, Wrench(), '')  # when the last wrench came; when, what and where was sent
        self.has_ended = False
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
        rospy.on_shutdown(self.end)

    def move(self, message):
        if not message.header.stamp:
            return
        try:
            T_base_tip = frame(message.pose.position, message.pose.orientation)
        except ValueError as wrong:
            return rospy.logwarn_throttle(1, 'no pose of the hand: the pose %s' % wrong)
        self.arm = message.header.frame_id, T_base_tip
        message.pose.orientation = Quaternion(*T_base_tip.M.GetQuaternion())
        self.pose.publish(message)

    def feel(self, message):
        f, t = message.wrench.force, message.wrench.torque
        try:
            name, T_axes_tip = self.place_of(message.header.frame_id)
            wrench = self.limited(Wrench(Vector(f.x, f.y, f.z), Vector(t.x, t.y, t.z)) * self.scale, T_axes_tip)
        except (tf2_ros.TransformException, ValueError) as error:
            return rospy.logwarn_throttle(1, 'no force on the hand: %s' % error)
        with self.lock:
            self.felt = time.monotonic()
            self.send(wrench, name)

    def limited(self, wrench, T_axes_tip):
        """A wrench about the tip, turned into the axes, within the limits. Raises ValueError if it is not finite."""
        wrench = T_axes_tip.M * wrench
        wrench = Wrench(wrench.force * share_of(wrench.force, self.max_force),
                        wrench.torque * share_of(wrench.torque, self.max_torque))
        if self.torque_about == 'axes':  # The force keeps its line.
            wrench = Frame(T_axes_tip.p) * wrench
            wrench = wrench * share_of(wrench.torque, self.max_torque)
        if not all(map(math.isfinite, (*wrench.force, *wrench.torque))):
            raise ValueError('the wrench is not finite')
        return wrench

    def place_of(self, tip):
        """The name of the frame of the axes, and the pose of the wrench's frame in it."""
        if self.axes == 'tip':
            return tip, Frame()
        base, T_base_tip = self.arm
        if self.axes != 'base' and (not T_base_tip or self.transforms.can_transform(self.axes, tip, rospy.Time())):
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
                self.send(last * share if share else Wrench(), name)
                time.sleep(0.002)

    def end(self):
        """Lets go for good: no wrench that waits for the lock is sent afterwards. Returns when the zero has left."""
        with self.lock:
            if not self.has_ended:
                self.let_go()
                self.has_ended = True
                time.sleep(FAREWELL)

    def send(self, wrench, name):
        if self.has_ended:
            return
        self.sent = time.monotonic(), wrench, name
        message = WrenchMessage(Vector3(*wrench.force), Vector3(*wrench.torque))
        self.force.publish(WrenchStamped(Header(0, rospy.Time.now(), name), message))


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.parse_args(rospy.myargv()[1:])  # --help
    # rospy's handler would let go within what it interrupts, which may be the sending of a force.
    rospy.init_node('crtk_hand', disable_signals=True)
    signals = []
    for number_of_signal in signal.SIGINT, signal.SIGTERM:
        signal.signal(number_of_signal, lambda number_of_signal, _: signals.append(number_of_signal))
    hand = Hand()
    while not rospy.is_shutdown() and not signals:
        hand.watch()
        time.sleep(min(0.002, hand.period / 2))  # Not rospy's clock, which a simulator may stop.
    hand.end()
    rospy.signal_shutdown('a signal came')


if __name__ == '__main__':
    main()
