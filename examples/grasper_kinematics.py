"""Where the links of urdf/grasper.urdf are, and which joints bring its tip to a point. Lengths in metres, angles in
radians. Poses and points are Frames and Vectors of PyKDL."""

import math

from PyKDL import Frame, Rotation, Vector

JOINTS = ('grasper_yaw', 'grasper_pitch', 'grasper_insertion', 'grasper_roll', 'grasper_wrist', 'grasper_jaw')
LIMITS = ((-1.2, 1.2), (-1.2, 1.2), (0.0, 0.25), (-3.1, 3.1), (-1.4, 1.4), (0.0, 0.8))
LINKS = ('grasper_shaft', 'grasper_wrist', 'grasper_left_jaw', 'grasper_right_jaw')
JAW_AXIS = 0.009  # from the wrist
TIP = 0.029       # of the closed jaws, from the wrist


def link_poses(trocar, joints):
    """The poses of LINKS in the frame in which the pose `trocar` is given."""
    yaw, pitch, insertion, roll, wrist, jaw = joints
    axis = trocar * Frame(Rotation.RotY(yaw) * Rotation.RotX(pitch))
    shaft = axis * Frame(Rotation.RotZ(roll), Vector(0, 0, insertion))
    wrist = shaft * Frame(Rotation.RotX(wrist))
    left = wrist * Frame(Rotation.RotY(jaw), Vector(0, 0, JAW_AXIS))
    right = wrist * Frame(Rotation.RotZ(math.pi) * Rotation.RotY(jaw), Vector(0, 0, JAW_AXIS))
    return shaft, wrist, left, right


def tip(trocar, joints):
    return link_poses(trocar, joints)[1] * Vector(0, 0, TIP)


def joints_for(trocar, point, roll, wrist, jaw):
    """The joints that bring the tip to a point, with this roll, wrist and jaw. None: there are none."""
    target = trocar.Inverse() * point
    # The tip in the frame that yaw and pitch turn: the wrist bends it away from the axis of the shaft.
    aside_x, aside_y, ahead = Rotation.RotZ(roll) * Rotation.RotX(wrist) * Vector(0, 0, TIP)
    depth_squared = target.Norm()**2 - aside_x**2 - aside_y**2
    height = math.hypot(target[0], target[2])
    if depth_squared < 0.0 or abs(aside_x) > height:
        return None
    depth = math.sqrt(depth_squared)
    # Pitch turns the tip to the height of the target, yaw turns it to the target.
    pitch = math.acos(target[1] / math.hypot(aside_y, depth)) - math.atan2(depth, aside_y)
    ahead_turned = aside_y * math.sin(pitch) + depth * math.cos(pitch)
    yaw = math.atan2(target[0], target[2]) - math.atan2(aside_x, ahead_turned)
    joints = (yaw, pitch, depth - ahead, roll, wrist, jaw)
    return joints if all(low <= j <= high for j, (low, high) in zip(joints, LIMITS)) else None
