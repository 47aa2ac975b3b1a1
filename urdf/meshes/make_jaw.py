#!/usr/bin/python3
"""Writes the jaw of a grasper to standard output, as binary STL: a closed mesh of 500 faces [m].

The joint is at the origin and its axis is y. The jaw points along z. Its toothed side faces -x.

Usage: make_jaw.py > jaw.stl
"""

import math
import struct
import sys

LENGTH = 0.020
HALF_WIDTH = 0.002  # at the joint; half of it at the tip
THICKNESS = 0.0022  # at the joint; half of it at the tip
BOW = 0.0005  # by which the middle bends away from the other jaw
GAP = 0.0001  # between a closed jaw and the middle plane
TOOTH = 0.0004
SECTIONS = 21


def section(i):
    """The 12 corners of a section, anticlockwise seen from the tip: a half ellipse and the toothed
    side. A fan around the first corner covers the section without overlap."""
    share = i / (SECTIONS - 1)
    taper = 1 - 0.5 * share**2
    toothed = i % 2 == 1
    x, z = GAP + BOW * math.sin(math.pi * share), LENGTH * share
    arc = [
        (
            x + taper * THICKNESS * math.cos(math.radians(angle)),
            taper * HALF_WIDTH * math.sin(math.radians(angle)),
            z,
        )
        for angle in range(-90, 91, 30)
    ]
    grip = [
        (x + (TOOTH if toothed else 0.0), taper * HALF_WIDTH * k / 3, z) for k in range(2, -3, -1)
    ]
    return arc[3:] + grip + arc[:3]


def triangles():
    """All triangles, anticlockwise seen from outside."""
    sections = [section(i) for i in range(SECTIONS)]
    for low, high in zip(sections, sections[1:]):
        for k, a in enumerate(low):
            n = (k + 1) % len(low)
            yield a, low[n], high[n]
            yield a, high[n], high[k]
    first, last = sections[0], sections[-1]
    for k in range(1, len(first) - 1):
        yield first[0], first[k + 1], first[k]
        yield last[0], last[k], last[k + 1]


def normal(a, b, c):
    u, v = [[q - p for p, q in zip(a, corner)] for corner in (b, c)]
    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    length = math.sqrt(sum(x * x for x in n))
    return [x / length for x in n]


def main():
    # Coordinates are rounded so that every machine writes the same bytes.
    rounded = [[[round(x, 7) for x in corner] for corner in face] for face in triangles()]
    out = sys.stdout.buffer
    out.write(struct.pack('<80sI', b'jaw of a grasper, made by make_jaw.py', len(rounded)))
    for face in rounded:
        numbers = normal(*face) + [x for corner in face for x in corner]
        out.write(struct.pack('<12fH', *numbers, 0))


if __name__ == '__main__':
    main()
