"""An ordinary touch: the words of one contact, and what behind means."""

import numpy as np

import style
from shaft_view import RADIUS, contact, crossing, draw_faces, draw_shaft, measure

SHEET = [np.array([x, 0.0]) for x in (-30.0, -18.0, -6.0, 6.0, 18.0, 30.0)]


def touched_faces(trocar, tip):
    faces = list(zip(SHEET[:-1], SHEET[1:]))
    return [i for i, face in enumerate(faces)
            if crossing(trocar, tip, face) is not None or contact(trocar, tip, face)[3] >= 0]


def draw_contact(axes):
    trocar, tip = np.array([-9.0, 42.0]), np.array([0.0, 3.0])
    style.drawing(axes, 'An ordinary touch: 2 mm deep')
    draw_shaft(axes, trocar, tip)
    draw_faces(axes, SHEET, touched_faces(trocar, tip))
    on_axis, point, normal, depth = contact(trocar, tip, SHEET[2:4])
    style.label(axes, trocar + [6.5, 0], 'trocar', style.TOOL, va='center')
    style.label(axes, tip + [6.0, 2.0], 'tip: the place on\nthe axis nearest the face', style.TOOL,
                va='bottom')
    across = RADIUS * np.array([-39.0, -9.0]) / np.hypot(39, 9)
    middle = 0.45 * trocar + 0.55 * tip
    style.arrow(axes, middle, middle + across, style.TOOL)
    style.label(axes, middle + across + [-1, 0], 'radius 5 mm', style.TOOL, ha='right', va='center')
    axes.plot(*point, 'o', color=style.TEXT, ms=4)
    style.arrow(axes, on_axis, point, style.BOUND, width=1.6)
    style.arrow(axes, point, point + 13 * normal, style.BOUND, width=1.6)
    style.label(axes, point + [1.5, -11], 'normal: from the axis to the point.\n'
                'The tissue must go along it', style.BOUND)
    style.label(axes, [-31, 4.5], 'the point: the place\non the face nearest\nthe axis', va='bottom')
    style.arrow(axes, [-20, 4], point + [-0.9, 0.3], style.GUIDE, width=0.8)
    lowest = tip - [0, RADIUS]
    axes.plot([-13, 0], [lowest[1]] * 2, ':', color=style.GUIDE, lw=1)
    measure(axes, [-11, 0], [-11, lowest[1]], f'depth\n{depth:.0f} mm', [-1, -5.6], ha='right')
    axes.set_xlim(-32, 32)
    axes.set_ylim(-16, 48)


def draw_pierced(axes):
    style.drawing(axes, 'Pressed deeper: the tip is past the face')
    trocar, tip = np.array([-9.0, 42.0]), np.array([0.0, -8.0])
    draw_shaft(axes, trocar, tip)
    draw_faces(axes, SHEET, touched_faces(trocar, tip))
    _, point, normal, depth = contact(trocar, tip, SHEET[2:4])
    axes.plot(*point, 'o', color=style.TEXT, ms=4)
    style.arrow(axes, point, point + 17 * normal, style.BOUND, width=1.6)
    style.label(axes, point + [1.8, -18.5], 'normal: that of the face,\ntowards the tip', style.BOUND)
    for x in (-24.0, 24.0):
        style.arrow(axes, [x, 0], [x, 8], style.FACE)
    style.label(axes, [24, 9], 'outside', style.FACE, ha='center')
    style.label(axes, [24, -4], 'inside', style.FACE, ha='center')
    lowest = tip - [0, RADIUS]
    axes.plot([-14, 0], [lowest[1]] * 2, ':', color=style.GUIDE, lw=1)
    measure(axes, [-12, 0], [-12, lowest[1]], f'depth\n{depth:.0f} mm', [-1, -2.0], ha='right')
    style.label(axes, point + [7, 24], 'the axis pierces the face, so\ndepth is measured from the tip',
                va='bottom')
    axes.set_xlim(-32, 36)
    axes.set_ylim(-22, 48)


def draw_behind(axes):
    style.drawing(axes, 'Under the face: behind is true')
    trocar, tip = np.array([-46.0, 14.0]), np.array([14.0, -3.0])
    sheet = [np.array([x, 0.0]) for x in (6.0, 18.0, 30.0)]
    draw_shaft(axes, trocar, tip)
    draw_faces(axes, sheet, [0])
    _, point, normal, _ = contact(trocar, tip, sheet[0:2])
    axes.plot(*point, 'o', color=style.TEXT, ms=4)
    style.arrow(axes, point, point + 15 * normal, style.BOUND, width=1.6)
    style.label(axes, point + [-1, 17], 'normal: from the axis to the\npoint, here to the outside', style.BOUND,
                ha='center')
    style.arrow(axes, [26, 0], [26, 8], style.FACE)
    style.label(axes, [27.5, 5], 'outside', style.FACE)
    style.label(axes, [24, -5], 'inside', style.FACE)
    style.label(axes, tip + [-6, -8], 'the nearest place on the axis\nis on the inner side', style.TOOL,
                ha='center', va='top')
    axes.set_xlim(-62, 54)
    axes.set_ylim(-16, 24)


def draw():
    figure, (ordinary, pierced, behind) = style.two_and_one(6.4, (1, 0.62))
    draw_contact(ordinary)
    draw_pierced(pierced)
    draw_behind(behind)
    return figure
