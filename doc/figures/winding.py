"""The order of a face's corners decides which way its normal points, and what `behind` means."""

import matplotlib.pyplot as plt
import numpy as np

import style


def project(point):
    """A view from the side and above."""
    x, y, z = point
    return np.array([x + 0.45 * y, 0.35 * y + z])


def draw_face(axes):
    style.drawing(axes, 'Right-hand rule')
    corners = np.array([[0, 0, 0], [2.2, 0, 0], [0.9, 2.0, 0]])
    flat = np.array([project(corner) for corner in corners])
    axes.add_patch(plt.Polygon(flat, fc=style.FACE, alpha=0.25, ec=style.FACE))
    for i, corner in enumerate(flat):
        style.label(axes, corner + [[-0.2, -0.08], [0.08, -0.08], [0.05, 0.08]][i], str(i))
    middle = corners.mean(0)
    for i in range(3):
        a, b = 0.35 * middle + 0.65 * corners[i], 0.35 * middle + 0.65 * corners[(i + 1) % 3]
        style.arrow(axes, project(a), project(b), style.GUIDE)
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    normal /= np.linalg.norm(normal)
    style.arrow(axes, project(middle), project(middle + normal), style.BOUND, width=2)
    style.label(axes, project(middle + normal) + [0.08, 0], 'outward normal', style.BOUND)
    axes.set_xlim(-0.5, 3.6)
    axes.set_ylim(-0.4, 1.7)


def draw_behind(axes):
    style.drawing(axes, 'Inner side, outer side, `behind`')
    angles = np.linspace(np.radians(20), np.radians(160), 8)
    surface = np.stack([2 * np.cos(angles), 1.2 * np.sin(angles)], 1)
    axes.plot(*surface.T, '-', color=style.FACE, lw=2)
    axes.fill_between(surface[:, 0], surface[:, 1], -0.1, color=style.FACE, alpha=0.08, lw=0)
    for a, b in zip(surface, surface[1:]):
        way = b - a
        normal = np.array([way[1], -way[0]]) / np.linalg.norm(way)
        style.arrow(axes, 0.5 * (a + b), 0.5 * (a + b) + 0.28 * normal, style.BOUND)
    style.label(axes, (0, 0.25), 'inner side of the organ', style.FACE, ha='center')
    for place, text in (((-1.2, 1.75), 'behind = false'), ((-0.6, 0.75), 'behind = true')):
        axes.plot(*place, 'o', color=style.TOOL, ms=6)
        style.label(axes, np.array(place) + [0.12, -0.05], text, style.TOOL)
    style.label(axes, (0, -0.35), 'dots: axis(shaft), the place on the tool nearest to the point',
                style.TOOL, ha='center')
    axes.set_xlim(-2.2, 2.2)


def draw():
    figure, (face, behind) = style.panels(2, 2.8)
    draw_face(face)
    draw_behind(behind)
    return figure
