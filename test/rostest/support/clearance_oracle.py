"""The distance between a tool and an organ, computed naively for each face in double precision.

Axes, faces and motions are as in oracle.py. Distances are between surfaces [m]: from a face to the
axis, minus the radius.
"""

from .oracle import nearest
from .vectors import lerp

SAMPLES = 64  # of a step
GOLDEN = (5**0.5 - 1) / 2


def distances(mesh, axis, radius):
    """The distance of each face."""
    return [nearest(axis, mesh.face(i)).distance - radius for i in range(len(mesh.faces))]


def least_distance(face, motion, radius):
    """The least distance of a resting face during a step in which the axis moves from motion[0] to
    motion[1]: the best of evenly spread times, and of what golden-section search finds around each
    of them that is better than its neighbours."""

    def at(time):
        axis = tuple(lerp(a, b, time) for a, b in zip(*motion))
        return nearest(axis, face).distance - radius

    found = [at(i / SAMPLES) for i in range(SAMPLES + 1)]
    least = min(found)
    for i in range(SAMPLES + 1):
        low, high = max(0, i - 1), min(SAMPLES, i + 1)
        if found[i] <= min(found[low], found[high]):
            least = min(least, least_between(at, low / SAMPLES, high / SAMPLES))
    return least


def least_between(function, low, high):
    """The minimum of a function that falls and then rises."""
    left, right = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    at_left, at_right = function(left), function(right)
    while high - low > 1e-6:
        if at_left < at_right:
            high, right, at_right = right, left, at_left
            left = high - GOLDEN * (high - low)
            at_left = function(left)
        else:
            low, left, at_left = left, right, at_right
            right = low + GOLDEN * (high - low)
            at_right = function(right)
    return min(at_left, at_right)


def least_distances(mesh, motion, radius):
    """The least distance of each face during the step."""
    return [least_distance(mesh.face(i), motion, radius) for i in range(len(mesh.faces))]
