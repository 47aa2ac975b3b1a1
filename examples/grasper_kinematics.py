"""Where the links of urdf/grasper.urdf are, and which joints bring its tip to a point. Lengths in metres, angles in
radians. A pose is a quaternion (x, y, z, w) and a position."""

import math

JOINTS = ('grasper_yaw', 'grasper_pitch', 'grasper_insertion', 'grasper_roll', 'grasper_wrist', 'grasper_jaw')
LIMITS = ((-1.2, 1.2), (-1.2, 1.2), (0.0, 0.25), (-3.1, 3.1), (-1.4, 1.4), (0.0, 0.8))
LINKS = ('grasper_shaft', 'grasper_wrist', 'grasper_left_jaw', 'grasper_right_jaw')
JAW_AXIS = 0.009  # from the wrist
TIP = 0.029       # of the closed jaws, from the wrist


def turn(axis, angle):
    """A rotation about the x, y or z axis (0, 1, 2)."""
    quaternion = [0.0, 0.0, 0.0, math.cos(angle / 2)]
    quaternion[axis] = math.sin(angle / 2)
    return tuple(quaternion), (0.0, 0.0, 0.0)


def along_z(distance):
    return (0.0, 0.0, 0.0, 1.0), (0.0, 0.0, distance)


def product(a, b):
    """Of two quaternions."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def applied(pose, point):
    """A point of the pose's frame, in the frame around it."""
    (x, y, z, w), position = pose
    turned = product(product((x, y, z, w), (*point, 0.0)), (-x, -y, -z, w))
    return tuple(p + t for p, t in zip(position, turned))


def chain(*poses):
    rotation, position = poses[0]
    for pose in poses[1:]:
        position = applied((rotation, position), pose[1])
        rotation = product(rotation, pose[0])
    return rotation, position


def link_poses(trocar, joints):
    """The poses of LINKS in the frame in which the pose `trocar` is given."""
    yaw, pitch, insertion, roll, wrist, jaw = joints
    shaft = chain(trocar, turn(1, yaw), turn(0, pitch), along_z(insertion), turn(2, roll))
    wrist = chain(shaft, turn(0, wrist))
    left = chain(wrist, along_z(JAW_AXIS), turn(1, jaw))
    right = chain(wrist, along_z(JAW_AXIS), turn(2, math.pi), turn(1, jaw))
    return shaft, wrist, left, right


def tip(trocar, joints):
    return applied(link_poses(trocar, joints)[1], (0.0, 0.0, TIP))


def joints_for(trocar, point, roll, wrist, jaw):
    """The joints that bring the tip to a point, with this roll, wrist and jaw. None: there are none."""
    (x, y, z, w), position = trocar
    inverse = (-x, -y, -z, w), (0.0, 0.0, 0.0)
    target = applied(inverse, [p - t for p, t in zip(point, position)])
    # The tip in the frame that yaw and pitch turn: the wrist bends it away from the axis of the shaft.
    aside_x, aside_y, ahead = applied(chain(turn(2, roll), turn(0, wrist)), (0.0, 0.0, TIP))
    depth_squared = sum(t * t for t in target) - aside_x**2 - aside_y**2
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
