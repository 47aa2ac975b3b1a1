"""Why a contact of a fast sweep may be deep, or have a normal that points sideways."""

import numpy as np

import style
from shaft_view import RADIUS, contact, draw_faces, draw_shaft, measure, separation

TROCAR = np.array([0.0, 100.0])
SHEET = [np.array([x, 0.0]) for x in (-50.0, 0.0, 50.0)]


def first_touch(face, start, end):
    """The earliest fraction at which the shaft touches the face."""
    for fraction in np.linspace(0, 1, 100001):
        tip = start + fraction * (end - start)
        if contact(TROCAR, tip, face)[3] >= 0:
            return fraction
    raise AssertionError('no touch')


def draw_pierced(axes):
    style.drawing(axes, 'The shaft is already through one face:\nit also touches the edge of the next one')
    tip = np.array([-6.0, -50.0])
    draw_shaft(axes, TROCAR, tip)
    draw_faces(axes, SHEET, [0, 1])
    _, point, normal, depth = contact(TROCAR, tip, SHEET[0:2])
    axes.plot(*point, 'o', color=style.TEXT, ms=4)
    style.arrow(axes, point, point + 30 * normal, style.BOUND, width=1.8)
    style.label(axes, point + [-8, -26], 'normal of\nthe left face', style.BOUND, ha='right')
    on_axis, corner, sideways, shallow = contact(TROCAR, tip, SHEET[1:3])
    axes.plot(*corner, 'o', color=style.TEXT, ms=4)
    style.arrow(axes, on_axis, on_axis + 30 * sideways, style.BOUND, width=1.8)
    style.label(axes, corner + [8, 8], f'normal of the right face:\n{shallow:.0f} mm deep', style.BOUND)
    low = tip[1] - RADIUS
    axes.plot([-62, tip[0]], [low, low], ':', color=style.GUIDE, lw=1)
    measure(axes, [-58, 0], [-58, low], f'{depth:.0f} mm', [-2, 0], ha='right', va='center')
    style.label(axes, tip + [9, -2], 'tip', style.TOOL)
    style.label(axes, TROCAR + [8, 0], 'trocar', style.TOOL, va='center')
    axes.set_xlim(-92, 68)
    axes.set_ylim(-70, 112)


def draw_from_the_side(axes):
    start, end = np.array([-110.0, -50.0]), np.array([-42.0, -50.0])
    fraction = first_touch(SHEET[0:2], start, end)
    touch = start + fraction * (end - start)
    style.drawing(axes, 'The shaft comes from the side within one step:\nit first touches the edge, normal sideways')
    draw_shaft(axes, TROCAR, start, 0.08, '--')
    draw_shaft(axes, TROCAR, touch, 0.12, '--')
    draw_shaft(axes, TROCAR, end)
    draw_faces(axes, SHEET, [0])
    on_axis, point = separation(TROCAR, touch, SHEET[0:2])
    normal = (point - on_axis) / np.linalg.norm(point - on_axis)
    place = np.linalg.norm(on_axis - TROCAR) / np.linalg.norm(touch - TROCAR)
    depth = RADIUS - normal @ (point - (TROCAR + place * (end - TROCAR)))
    style.arrow(axes, on_axis, on_axis + 32 * normal, style.BOUND, width=1.8)
    style.label(axes, on_axis + 34 * normal, 'normal, at first touch', style.BOUND, va='center')
    axes.plot(*point, 'o', color=style.TEXT, ms=4)
    for tip, shift, text, side in ((start, 5, 'start', 'right'),
                                   (touch, 0, f'first touch,\nfraction {fraction:.1f}', 'center'),
                                   (end, -14, f'end: {depth:.0f} mm deep\nalong this normal', 'left')):
        style.label(axes, tip + [shift, -10], text, style.TOOL, ha=side, va='top')
    style.label(axes, TROCAR + [8, 0], 'trocar', style.TOOL, va='center')
    axes.set_xlim(-140, 62)
    axes.set_ylim(-92, 112)


def draw():
    figure, (pierced, side) = style.panels(2, 4.6, [0.75, 1])
    draw_pierced(pierced)
    draw_from_the_side(side)
    return figure
