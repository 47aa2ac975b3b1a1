"""The mesh of a robot's link, read from its STL file, and a naive search for the faces it
pierces."""

import struct

from . import oracle


def overlap(a, b):
    """Whether the bounding boxes of two lists of points overlap."""
    return all(min(p) <= max(q) and min(q) <= max(p) for p, q in zip(zip(*a), zip(*b)))


class RigidMesh:
    """A list of triangles with three corners each [m]."""

    def __init__(self, triangles):
        self.triangles = triangles

    @classmethod
    def from_stl(cls, path, unit=1.0):
        """Reads a binary STL file. `unit`: the file's unit of length [m]."""
        with open(path, 'rb') as file:
            data = file.read()
        count = struct.unpack_from('<I', data, 80)[0]
        assert len(data) == 84 + 50 * count, path
        triangles = []
        for i in range(count):
            n = [unit * c for c in struct.unpack_from('<9f', data, 84 + 50 * i + 12)]
            triangles.append((tuple(n[0:3]), tuple(n[3:6]), tuple(n[6:9])))
        return cls(triangles)

    def at(self, pose):
        return RigidMesh([tuple(pose.apply(corner) for corner in t) for t in self.triangles])

    def edges(self):
        """All edges; an edge that several triangles share appears once."""
        return {tuple(sorted((t[i], t[i - 1]))) for t in self.triangles for i in range(3)}

    def distance(self, point):
        """The distance of a point from the surface [m]."""
        return min(oracle.nearest((point, point), t).distance for t in self.triangles)

    def faces_pierced(self, organ):
        """The numbers of the organ's faces that an edge of this mesh pierces."""
        edges = self.edges()
        corners = [corner for triangle in self.triangles for corner in triangle]
        near = [i for i in range(len(organ.faces)) if overlap(organ.face(i), corners)]
        return {i for i in near if any(self._pierces(edge, organ.face(i)) for edge in edges)}

    @staticmethod
    def _pierces(edge, face):
        return overlap(edge, face) and oracle.nearest(edge, face).distance <= oracle.PIERCED
