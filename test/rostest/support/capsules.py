"""The distance of capsules from a surface, by the exact distance of a segment from each triangle. It shares nothing with the
package."""

import numpy as np


def dot(a, b):
    return np.einsum('ij,ij->i', a, b)


def segment_distances(p, q, a, b):
    """[m] between the segment from p to q and each segment from a to b, n x 3 (Ericson, Real-Time Collision Detection,
    5.1.9)."""
    u, v, r = (q - p)[None, :], b - a, p - a
    uu, vv, uv, ur, vr = dot(u, u), dot(v, v), dot(u + 0 * v, v), dot(u + 0 * v, r), dot(v, r)
    slope = uu * vv - uv ** 2
    s = np.clip(np.divide(uv * vr - ur * vv, slope, out=np.zeros(len(a)), where=slope > 1e-12 * uu * vv), 0.0, 1.0)
    t = np.clip((uv * s + vr) / vv, 0.0, 1.0)
    s = np.clip((uv * t - ur) / uu, 0.0, 1.0)
    return np.linalg.norm(r + s[:, None] * u - t[:, None] * v, axis=1)


def distance(p, q, corners):
    """[m] of the segment from p to q from the nearest of the triangles, n x 3 x 3. Zero if it pierces one."""
    a, b, c = corners.swapaxes(0, 1)
    least = min(segment_distances(p, q, *ends).min() for ends in ((a, b), (b, c), (c, a)))
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    heights = dot(p - a, normal), dot(q - a, normal)
    share = np.divide(heights[0], heights[0] - heights[1], out=np.zeros(len(a)), where=heights[0] * heights[1] < 0)
    feet = (p - heights[0][:, None] * normal, heights[0]), (q - heights[1][:, None] * normal, heights[1]), (
        p + share[:, None] * (q - p), np.where(share > 0, 0.0, np.inf))
    for foot, height in feet:  # the ends over the triangles, and where the segment goes through their planes
        is_over = np.all([dot(np.cross(end - start, foot - start), normal) >= 0
                          for start, end in ((a, b), (b, c), (c, a))], axis=0)
        least = min(least, np.abs(height[is_over]).min(initial=np.inf))
    return least
