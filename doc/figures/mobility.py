"""How a tool's displacement moves the place of a contact: a shaft through a trocar, and a free tool."""

import matplotlib.pyplot as plt
import numpy as np

import style


def draw_face(axes, at, normal):
    along = np.array([-normal[1], normal[0]])
    ends = np.array([at - 4 * along, at + 4 * along])
    axes.plot(*ends.T, color=style.FACE, lw=2.5)


def draw_trocar(axes):
    style.drawing(axes, 'Through a trocar: the place s moves by s d')
    trocar, tip, displacement = np.array([-14.0, 8.0]), np.array([12.0, 0.0]), np.array([0.8, 5.0])
    place = 0.6
    for end, style_of_line in ((tip, '-'), (tip + displacement, '--')):
        axes.plot(*np.array([trocar, end]).T, style_of_line, color=style.TOOL, lw=2.2)
    contact = trocar + place * (tip - trocar)
    normal = np.array([0.3, 0.95]) / np.hypot(0.3, 0.95)
    draw_face(axes, contact + 6 * normal, normal)
    style.arrow(axes, tip, tip + displacement, style.BOUND, '->', 1.6)
    style.arrow(axes, contact, contact + place * displacement, style.BOUND, '->', 1.6)
    style.arrow(axes, contact, contact + 6 * normal, style.TEXT, '->', 1.0)
    axes.plot(*trocar, 'o', color=style.TEXT, ms=5)
    style.label(axes, trocar + [0, 1.2], 'trocar', style.TEXT, ha='center')
    style.label(axes, tip + 0.5 * displacement + [0.9, -1], 'd', style.BOUND)
    style.label(axes, contact + [-1.0, -1.9], 's', style.TEXT)
    style.label(axes, contact + 4.2 * normal + [-1.3, 0], 'n', style.TEXT)
    axes.set_xlim(-17, 16)
    axes.set_ylim(-2, 13)


def draw_free(axes):
    style.drawing(axes, 'Free: the place moves by v + ω × r')
    center, angle = np.array([-4.0, 3.0]), 0.35
    corners = np.array([[-9, -2], [9, -2], [9, 2], [-9, 2]], float)

    def placed(turn, shift):
        rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
        return corners @ rotation.T + center + shift

    axes.add_patch(plt.Polygon(placed(0, 0), fc=style.TOOL, alpha=0.35, ec=style.TOOL, lw=1.5))
    axes.add_patch(plt.Polygon(placed(angle, np.array([1.0, 1.0])), fill=False, ec=style.TOOL, ls='--', lw=1.5))
    contact, moved = placed(0, 0)[2], placed(angle, np.array([1.0, 1.0]))[2]
    normal = np.array([0.0, 1.0])
    draw_face(axes, contact + 6.2 * normal, normal)
    style.arrow(axes, center, contact, style.GUIDE, '->', 1.2)
    style.arrow(axes, center, center + [1, 1], style.BOUND, '->', 1.6)
    style.arrow(axes, contact, moved, style.BOUND, '->', 1.6)
    axes.plot(*center, 'o', color=style.TEXT, ms=5)
    style.label(axes, center + [-0.7, 0], 'centre', style.TEXT, ha='right', va='center')
    style.label(axes, center + [1.3, 1.4], 'v', style.BOUND)
    style.label(axes, 0.5 * (center + contact) + [1.5, -1.2], 'r', style.GUIDE)
    axes.set_xlim(-16, 14)
    axes.set_ylim(-5, 14)


def draw():
    figure, (left, right) = style.panels(2, 2.9)
    draw_trocar(left)
    draw_free(right)
    return figure
