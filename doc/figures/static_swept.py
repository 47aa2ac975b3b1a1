"""Static and swept: a tool that jumps over a thin organ between two answers."""

import matplotlib.pyplot as plt
import numpy as np

import style
from shaft_view import RADIUS, draw_faces, draw_shaft, separation

TROCAR = np.array([0.0, 70.0])
START, END = np.array([-34.0, 4.0]), np.array([36.0, 4.0])
RIDGE = [np.array(place) for place in ((-12.0, -6.0), (-7.0, 8.0), (0.0, 15.0), (7.0, 8.0), (12.0, -6.0))]


def touched(tips):
    faces = list(zip(RIDGE[:-1], RIDGE[1:]))
    distance = [min(np.linalg.norm(np.subtract(*separation(TROCAR, tip, face))) for tip in tips)
                for face in faces]
    return [i for i, d in enumerate(distance) if d <= RADIUS]


def draw_panel(axes, title, tips, swept):
    style.drawing(axes, title)
    if swept:
        axes.add_patch(plt.Polygon([TROCAR, START, END], fc=style.TOOL, alpha=0.13, lw=0))
    draw_shaft(axes, TROCAR, START, 0.1, '--')
    draw_shaft(axes, TROCAR, END)
    faces = touched(tips)
    draw_faces(axes, RIDGE, faces)
    style.label(axes, START - [0, 9], 'tip at the\nlast answer', style.TOOL, ha='center', va='top')
    style.label(axes, END - [0, 9], 'tip now', style.TOOL, ha='center', va='top')
    style.label(axes, TROCAR + [8, 0], 'trocar', style.TOOL, va='center')
    style.label(axes, [0, -12], f'{len(faces)} faces touched', style.FACE, ha='center', va='top')
    if swept:
        style.arrow(axes, START + [8, -2], END - [8, 2], style.GUIDE)
        for fraction in (0.25, 0.5, 0.75):
            style.label(axes, START + fraction * (END - START) + [0, -5.5], f'{fraction}', style.GUIDE,
                        ha='center')
    axes.set_xlim(-52, 52)
    axes.set_ylim(-24, 78)


def draw():
    figure, (static, swept) = style.panels(2, 4.2)
    draw_panel(static, 'Static: where the tool is now', [END], False)
    draw_panel(swept, 'Swept: all that it passed, fraction 0 to 1',
               [START + t * (END - START) for t in np.linspace(0, 1, 501)], True)
    return figure
