"""Winding numbers along an axis, and an axis through a corner that is moved by an infinitesimal."""

import matplotlib.pyplot as plt
import numpy as np

import style


def polygon(centre, radius, corners, turn):
    angles = turn + np.linspace(0, 2 * np.pi, corners, endpoint=False)
    return centre + radius * np.stack([np.cos(angles), np.sin(angles)], 1)


def crossings(corners, height):
    """Where the line y = height, from left to right, crosses a counterclockwise polygon."""
    for a, b in zip(corners, np.roll(corners, -1, axis=0)):
        if (a[1] > height) != (b[1] > height):
            x = a[0] + (height - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
            yield x, 1 if a[1] > height else -1


def draw_windings(axes):
    style.drawing(axes, 'Winding numbers along the axis')
    # The cavity is a surface that is turned over.
    bodies = [(polygon((0, 0), 1.6, 9, 0.2), 1), (polygon((-0.3, 0.05), 0.6, 6, 0.3), -1),
              (polygon((1.9, 0.1), 0.9, 7, 0.1), 1)]
    for corners, sign in bodies:
        axes.add_patch(plt.Polygon(corners, fc=style.FACE if sign > 0 else 'white',
                                   alpha=0.12 if sign > 0 else 1.0, lw=0))
    for corners, _ in bodies:
        axes.add_patch(plt.Polygon(corners, fill=False, ec=style.FACE, lw=1.5))
    trocar, tip = -2.3, 2.2
    found = sorted((x, sign * way) for corners, sign in bodies for x, way in crossings(corners, 0.0)
                   if trocar < x < tip)
    winding, start = 0, trocar
    for x, way in found + [(tip, 0)]:
        axes.plot([start, x], [0, 0], color=style.TOOL, lw=3.5 if winding else 1.2)
        style.label(axes, (0.5 * (start + x), 0.12), str(winding), style.TOOL, ha='center')
        if way:
            style.label(axes, (x, -0.3), f'{way:+d}'.replace('-', '−'), style.BOUND, ha='center')
        winding, start = winding + way, x
    for x, text in ((trocar, 'trocar'), (tip, 'tip')):
        axes.plot(x, 0, 'o', color=style.TOOL, ms=5)
        style.label(axes, (x, -0.62), text, style.TOOL, ha='center')
    axes.set_xlim(-2.7, 3.0)
    axes.set_ylim(-1.8, 1.8)


def draw_displacement(axes):
    style.drawing(axes, 'An axis through a corner, moved by δ')
    surface = np.array([[-1.6, -0.9], [-0.7, -0.35], [0.0, 0.3], [0.8, -0.3], [1.6, -0.9]])
    axes.plot(*surface.T, '-', color=style.FACE, lw=2)
    axes.fill_between(surface[:, 0], surface[:, 1], -1.1, color=style.FACE, alpha=0.08, lw=0)
    corner = surface[2]
    axes.plot([-1.7, 1.7], [corner[1]] * 2, '-', color=style.TOOL)
    style.label(axes, (1.78, corner[1] - 0.04), 'axis', style.TOOL)
    for shift, text in ((0.26, 'moved up: crosses nothing'), (-0.26, 'moved down: +1, then −1')):
        axes.plot([-1.7, 1.7], [corner[1] + shift] * 2, '--', color=style.GUIDE)
        style.label(axes, (1.78, corner[1] + shift - 0.04), text, style.GUIDE)
    for x, text in crossings(surface[::-1], corner[1] - 0.26):
        axes.plot(x, corner[1] - 0.26, 'o', color=style.BOUND, ms=5)
        style.label(axes, (x - 0.1, corner[1] - 0.56), f'{text:+d}'.replace('-', '−'), style.BOUND)
    style.label(axes, (0, -0.8), 'inner side', style.FACE, ha='center')
    axes.set_xlim(-1.8, 3.9)
    axes.set_ylim(-1.2, 1.0)


def draw():
    figure, (windings, displacement) = style.panels(2, 2.9)
    draw_windings(windings)
    draw_displacement(displacement)
    return figure
