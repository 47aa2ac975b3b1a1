"""What the figures of doc/concepts.md share: shafts and faces seen from the side, and their contact.

Lengths are millimetres. A face is a segment here, from its left corner to its right one; its outer
side is above.
"""

import matplotlib.pyplot as plt
import numpy as np

import style

RADIUS = 5.0


def nearest(point, start, end):
    """The place on the segment that is nearest the point, in [0, 1]."""
    way = end - start
    return float(np.clip((point - start) @ way / (way @ way), 0, 1))


def crossing(trocar, tip, face):
    """Where the axis pierces the face, or None."""
    system = np.stack([tip - trocar, face[0] - face[1]], axis=1)
    if abs(np.linalg.det(system)) < 1e-12:
        return None
    along, across = np.linalg.solve(system, face[0] - trocar)
    return trocar + along * (tip - trocar) if 0 <= along <= 1 and 0 <= across <= 1 else None


def separation(trocar, tip, face):
    """Nearest points of axis and face that do not cross: (on the axis, on the face)."""
    pairs = [(end, face[0] + nearest(end, *face) * (face[1] - face[0])) for end in (trocar, tip)]
    pairs += [(trocar + nearest(corner, trocar, tip) * (tip - trocar), corner) for corner in face]
    return min(pairs, key=lambda pair: np.linalg.norm(pair[1] - pair[0]))


def contact(trocar, tip, face):
    """(on the axis, on the face, normal, depth) of a shaft at rest; see doc/concepts.md."""
    pierced = crossing(trocar, tip, face)
    if pierced is None:
        on_axis, on_face = separation(trocar, tip, face)
        distance = np.linalg.norm(on_face - on_axis)
        return on_axis, on_face, (on_face - on_axis) / distance, RADIUS - distance
    along = (face[1] - face[0]) / np.linalg.norm(face[1] - face[0])
    normal = np.array([-along[1], along[0]])
    normal *= np.sign(normal @ (tip - trocar))
    return pierced, pierced, normal, RADIUS + normal @ (tip - pierced)


def draw_shaft(axes, trocar, tip, strength=0.22, line='-'):
    """The capsule around the axis."""
    way = (tip - trocar) / np.linalg.norm(tip - trocar)
    start = np.arctan2(way[1], way[0]) - np.pi / 2
    turns = np.linspace(start, start + np.pi, 40)
    cap = RADIUS * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    axes.add_patch(plt.Polygon(np.concatenate([tip + cap, trocar - cap]), fc=style.TOOL,
                               alpha=strength, lw=0))
    axes.plot(*np.stack([trocar, tip]).T, line, color=style.TOOL, lw=1.6)


def draw_faces(axes, corners, touched=()):
    """A chain of faces; the touched ones are strong."""
    for i, face in enumerate(zip(corners[:-1], corners[1:])):
        strong = i in touched
        axes.plot(*np.stack(face).T, color=style.FACE, lw=3.5 if strong else 1.5,
                  alpha=1.0 if strong else 0.55, solid_capstyle='butt')
    axes.plot(*np.stack(corners).T, '.', color=style.FACE, ms=4)


def measure(axes, start, end, text, offset, **options):
    """A length with its text."""
    style.arrow(axes, start, end, style.TEXT, '<->', 1.0)
    style.label(axes, 0.5 * (np.asarray(start) + np.asarray(end)) + np.asarray(offset), text, **options)
