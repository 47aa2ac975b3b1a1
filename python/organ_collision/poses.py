"""What counts as a pose in a message of another program."""

import math

SMALLEST_TURN = 1e-3  # norm of a quaternion below which it has no direction


def checked_pose(place, turn):
    """Place (x, y, z) and quaternion (x, y, z, w) of a Point or Vector3 and a Quaternion, the latter with the norm 1.

    Raises ValueError, whose text goes on after the name of the pose, if a number is not finite, or if the quaternion has
    no direction.
    """
    place, turn = (place.x, place.y, place.z), (turn.x, turn.y, turn.z, turn.w)
    norm = math.hypot(*turn)
    if not all(map(math.isfinite, place + turn)):
        raise ValueError('is not finite: place %s, rotation %s' % (place, turn))
    if not SMALLEST_TURN <= norm < math.inf:
        raise ValueError('has no rotation: the quaternion is %s' % (turn,))
    return place, tuple(part / norm for part in turn)
