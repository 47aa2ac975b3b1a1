#!/usr/bin/python3
"""In place of a dVRK: publishes what the CRTK topics of two PSMs say while they dip open jaws into tissue."""

import argparse
import math

from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion
from PyKDL import Frame, Rotation, Vector
import rospy
from sensor_msgs.msg import JointState
from std_msgs.msg import Header

# Each arm's remote centre, and the place that its instrument points at, in the frame of the camera [m]. The axes of
# this frame point left, up, and away from the camera.
ARMS = {'PSM1': (Vector(-0.12, 0.09, 0.06), Vector(-0.035, -0.01, 0.115)),
        'PSM2': (Vector(0.12, 0.09, 0.06), Vector(0.035, -0.01, 0.115))}

# The kinematics of a PSM with a Large Needle Driver: Denavit-Hartenberg parameters after Craig (a, alpha, d, theta).
# At zero, the joint of the wrist's yaw is OFFSET metres before the remote centre.
JOINTS = ('yaw', 'pitch', 'insertion', 'roll', 'wrist_pitch', 'wrist_yaw')
RIGHT = math.pi / 2
TIP = Frame(Rotation(0, -1, 0, 0, 0, 1, -1, 0, 0))
OFFSET = 0.4318 - 0.4162 - 0.0091


def forward_kinematics(yaw, pitch, insertion, roll, wrist_pitch, wrist_yaw):
    """The pose of the tip in the frame of the remote centre: local/measured_cp."""
    links = [(0, RIGHT, 0, yaw + RIGHT), (0, -RIGHT, 0, pitch - RIGHT), (0, RIGHT, insertion - 0.4318, 0),
             (0, 0, 0.4162, roll), (0, -RIGHT, 0, wrist_pitch - RIGHT), (0.0091, -RIGHT, 0, wrist_yaw - RIGHT)]
    pose = Frame()
    for a, alpha, d, theta in links:
        pose *= Frame.DH_Craig1989(a, alpha, d, theta)
    return pose * TIP


def base_pose(remote_centre, target):
    """The pose of an arm in the camera's frame. With all joints at zero, the instrument points along -z."""
    z = remote_centre - target
    x = Vector(0, 1, 0) * z
    z.Normalize()
    x.Normalize()
    return Frame(Rotation(x, z * x, z), remote_centre)


def joints_at(seconds, reach):
    """All joints and the jaw's angle, of an arm whose target is `reach` metres from its remote centre."""
    def wave(centre, amplitude, period):
        return centre + amplitude * math.sin(2 * math.pi * seconds / period)
    return [wave(0, 0.02, 7), wave(0, 0.02, 5), wave(OFFSET + reach - 0.012, 0.012, 3), wave(0, 0.5, 11),
            wave(0, 0.2, 4), wave(0, 0.2, 6)], wave(0.5, 0.5, 2)


def pose_message(header, pose):
    return PoseStamped(header, Pose(Point(*pose.p), Quaternion(*pose.M.GetQuaternion())))


class Arm:
    def __init__(self, name, remote_centre, target):
        self.base, self.frame = base_pose(remote_centre, target), name + '_base'
        self.reach = (target - remote_centre).Norm()
        self.pose = rospy.Publisher(name + '/local/measured_cp', PoseStamped, queue_size=10)
        self.base_pose = rospy.Publisher('SUJ/' + name + '/measured_cp', PoseStamped, queue_size=10)
        self.joints = rospy.Publisher(name + '/measured_js', JointState, queue_size=10)
        self.jaw = rospy.Publisher(name + '/jaw/measured_js', JointState, queue_size=10)

    def publish(self, now):
        joints, jaw = joints_at(now.to_sec() % 1000, self.reach)
        self.joints.publish(JointState(header=Header(stamp=now), name=JOINTS, position=joints))
        self.jaw.publish(JointState(header=Header(stamp=now), name=['jaw'], position=[jaw]))
        self.base_pose.publish(pose_message(Header(0, now, 'ECM'), self.base))
        self.pose.publish(pose_message(Header(0, now, self.frame), forward_kinematics(*joints)))


if __name__ == '__main__':
    argparse.ArgumentParser(description=__doc__).parse_args(rospy.myargv()[1:])  # --help
    rospy.init_node('dvrk_robot')
    arms = [Arm(name, *places) for name, places in ARMS.items()]

    def publish(_):
        for arm in arms:
            arm.publish(rospy.Time.now())

    # In a thread of its own: when the main thread published, the program did not always end at SIGINT.
    rospy.Timer(rospy.Duration(0.01), publish)
    rospy.spin()
