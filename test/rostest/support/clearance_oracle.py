"""The distance between a tool and an organ, computed naively for each face in double precision.

Axes, faces and motions are as in oracle.py. Distances are between surfaces [m]: from a face to the
axis, minus the radius.
"""

from .oracle import nearest
from .vectors import length, lerp, sub

TOLERANCE = 5e-7  # [m] of least distances


def distances(mesh, axis, radius):
    """The distance of each face."""
    return [nearest(axis, mesh.face(i)).distance - radius for i in range(len(mesh.faces))]


def least_distance(face, motion, radius):
    """The least distance of a resting face during a step in which the axis moves from motion[0] to
    motion[1]. Halves intervals of time until none can be lower: the distance changes at most as
    fast as the faster end of the axis moves."""

    def at(time):
        axis = tuple(lerp(a, b, time) for a, b in zip(*motion))
        return nearest(axis, face).distance - radius

    speed = max(length(sub(b, a)) for a, b in zip(*motion))
    least = min(at(0.0), at(1.0))
    intervals = [(0.0, 1.0)]
    while intervals:
        start, end = intervals.pop()
        middle = (start + end) / 2
        distance = at(middle)
        least = min(least, distance)
        if distance - speed * (end - start) / 2 < least - TOLERANCE:
            intervals += [(start, middle), (middle, end)]
    return least


def least_distances(mesh, motion, radius):
    """The least distance of each face during the step."""
    return [least_distance(mesh.face(i), motion, radius) for i in range(len(mesh.faces))]
