"""Meshes and rigid poses for the tests. Lengths are in metres, and frames are right-handed.

A mesh rounds its vertices to 32-bit floats, as in the messages, so that the node and the test work with the same
numbers."""

import math
import struct


def float32(value):
    return struct.unpack('f', struct.pack('f', value))[0]


class Mesh:
    """Any set of triangles: `vertices` as (x, y, z), `faces` as three vertex indices whose normal by the right-hand
    rule points outward."""

    def __init__(self, vertices, faces):
        self.vertices = [tuple(float32(c) for c in v) for v in vertices]
        self.faces = [tuple(f) for f in faces]

    def moved(self, move):
        """The same faces, with every vertex v moved to move(v)."""
        return Mesh([move(v) for v in self.vertices], self.faces)

    def face(self, number):
        """The three corners of a face."""
        return [self.vertices[i] for i in self.faces[number]]

    def flat_vertices(self):
        return [c for v in self.vertices for c in v]

    def flat_faces(self):
        return [i for f in self.faces for i in f]


def sheet(size=0.1, cells=4, z=0.0):
    """A square sheet around (0, 0, z) with 2 * cells * cells faces and its normal along +z."""
    n = cells + 1
    vertices = [(size * (i / cells - 0.5), size * (j / cells - 0.5), z) for j in range(n) for i in range(n)]
    faces = []
    for j in range(cells):
        for i in range(cells):
            a, b, c, d = j * n + i, j * n + i + 1, (j + 1) * n + i + 1, (j + 1) * n + i
            faces += [(a, b, c), (a, c, d)]
    return Mesh(vertices, faces)


def one_face(z=0.0):
    """One large face around the z axis, with its normal along +z."""
    return Mesh([(-0.06, -0.05, z), (0.07, -0.04, z), (0.01, 0.08, z)], [(0, 1, 2)])


def box(size=(0.06, 0.05, 0.04)):
    """A closed box of 12 faces around the origin."""
    vertices = [(size[0] * (i & 1) - size[0] / 2, size[1] * (i >> 1 & 1) - size[1] / 2,
                 size[2] * (i >> 2) - size[2] / 2)
                for i in range(8)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return Mesh(vertices, [f for a, b, c, d in quads for f in ((a, b, c), (a, c, d))])


def liver():
    """A closed, lobed surface of 1224 faces, about 0.2 m long: 36 meridians, 17 rings, two poles."""
    meridians, rings = 36, 17

    def point(polar, azimuth):
        lobe = 1.0 + 0.25 * math.cos(azimuth) * math.sin(polar) + 0.08 * math.sin(3 * azimuth + polar)
        return (0.10 * lobe * math.sin(polar) * math.cos(azimuth), 0.06 * lobe * math.sin(polar) * math.sin(azimuth),
                0.035 * lobe * math.cos(polar))

    vertices = [point(0.0, 0.0)]
    for ring in range(rings):
        for meridian in range(meridians):
            vertices.append(point(math.pi * (ring + 1) / (rings + 1), 2 * math.pi * meridian / meridians))
    vertices.append(point(math.pi, 0.0))

    def at(ring, meridian):
        return 1 + ring * meridians + meridian % meridians

    faces = []
    for m in range(meridians):
        faces.append((0, at(0, m), at(0, m + 1)))
        faces.append((len(vertices) - 1, at(rings - 1, m + 1), at(rings - 1, m)))
        for ring in range(rings - 1):
            a, b, c, d = at(ring, m), at(ring + 1, m), at(ring + 1, m + 1), at(ring, m + 1)
            faces += [(a, b, c), (a, c, d)]
    return Mesh(vertices, faces)


class Pose:
    """A rigid transform T_target_source, from a quaternion (x, y, z, w) of any length and a translation."""

    def __init__(self, rotation, translation):
        length = math.sqrt(sum(c * c for c in rotation))
        self.rotation = tuple(c / length for c in rotation)
        self.translation = tuple(translation)

    def apply(self, p):
        x, y, z, w = self.rotation
        rows = (
            (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
        )
        return tuple(sum(r * c for r, c in zip(row, p)) + t for row, t in zip(rows, self.translation))

    def inverse(self):
        x, y, z, w = self.rotation
        back = Pose((-x, -y, -z, w), (0.0, 0.0, 0.0))
        return Pose(back.rotation, [-c for c in back.apply(self.translation)])


def at(translation):
    """The pose of a frame that is not turned."""
    return Pose((0.0, 0.0, 0.0, 1.0), translation)
