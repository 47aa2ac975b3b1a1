"""On which side of a surface a point is, and where an axis pierces it, computed naively in double
precision. Axes, faces and motions are as in oracle.py."""

from collections import namedtuple
import math

from .oracle import barycentric
from .vectors import cross, dot, length, lerp, sub

Crossing = namedtuple('Crossing', 'face barycentric shaft point direction')


def winding_number(mesh, point):
    """The sum of the solid angles of all faces of a closed surface, divided by that of a sphere.
    The formula for one face is that of van Oosterom and Strackee (1983)."""
    total = 0.0
    for i in range(len(mesh.faces)):
        a, b, c = (sub(corner, point) for corner in mesh.face(i))
        la, lb, lc = length(a), length(b), length(c)
        denominator = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb
        total += 2 * math.atan2(dot(a, cross(b, c)), denominator)
    return round(total / (4 * math.pi))


def crossings(mesh, axis):
    """The crossings from trocar to tip. The axis must meet no edge and no corner."""
    trocar, tip = axis
    along = sub(tip, trocar)
    found = []
    for i in range(len(mesh.faces)):
        face = mesh.face(i)
        normal = cross(sub(face[1], face[0]), sub(face[2], face[0]))
        if dot(normal, along) == 0.0:
            continue
        shaft = dot(normal, sub(face[0], trocar)) / dot(normal, along)
        point = lerp(trocar, tip, shaft)
        weights = barycentric(point, face)
        if 0 < shaft < 1 and min(weights) > 0:
            direction = 1 if dot(normal, along) < 0 else -1
            found.append(Crossing(i, weights, shaft, point, direction))
    return sorted(found, key=lambda crossing: crossing.shaft)


def length_inside(mesh, axis):
    """The length of the axis where the winding number is not zero."""
    winding, inside, since = winding_number(mesh, axis[0]), 0.0, 0.0
    for crossing in crossings(mesh, axis):
        if winding != 0:
            inside += crossing.shaft - since
        winding, since = winding + crossing.direction, crossing.shaft
    if winding != 0:
        inside += 1.0 - since
    return inside * length(sub(axis[1], axis[0]))
