"""The conservative wedge of a swept shaft, by the formulas of conservative_volume.cpp."""

import matplotlib.pyplot as plt
import numpy as np

import style

RADIUS = 0.12
START, END = np.array([-0.55, 1.3]), np.array([0.75, 1.3])  # the tips; x along the step, z the view


def unit(vector):
    return vector / np.linalg.norm(vector)


def wedge():
    """Eye, depth of the near and the far plane from the eye, and the slopes of both sides."""
    a, b = unit(START), unit(END)
    eye = -unit(a + b) * 2 / np.linalg.norm(b - a) * RADIUS
    near, far = -eye[1] - RADIUS, START[1] - eye[1] + RADIUS
    return eye, near, far, a[0] / a[1], b[0] / b[1]


def capsule(axes, start, end):
    along = np.arctan2(*(end - start)[::-1])
    turn = np.linspace(-np.pi / 2, np.pi / 2, 40)
    cap = [centre + RADIUS * np.stack([np.cos(along + flip + turn), np.sin(along + flip + turn)], 1)
           for centre, flip in ((end, 0), (start, np.pi))]
    axes.add_patch(plt.Polygon(np.concatenate(cap), fc=style.TOOL, alpha=0.25, lw=0))


def draw_top(axes):
    style.drawing(axes, 'In the plane of the motion')
    eye, near, far, left, right = wedge()
    trocar = np.zeros(2)
    axes.add_patch(plt.Polygon([trocar, START, END], fc=style.TOOL, alpha=0.12, lw=0))
    for tip in (START, END):
        capsule(axes, trocar, tip)
        axes.plot(*np.stack([trocar, tip]).T, color=style.TOOL, lw=1.6)
    for slope in (left, right):
        sides = np.array([eye, eye + np.array([slope, 1]) * near, eye + np.array([slope, 1]) * far])
        axes.plot(*sides[:2].T, ':', color=style.BOUND, lw=1)
        axes.plot(*sides[1:].T, color=style.BOUND, lw=1.8)
    for depth in (near, far):
        axes.plot([eye[0] + left * depth, eye[0] + right * depth], [eye[1] + depth] * 2,
                  color=style.BOUND, lw=1.8)
    u = np.array([RADIUS, 0])
    for tip, sign in ((START, -1), (END, 1)):
        axes.plot(*np.stack([sign * u, tip + sign * u]).T, '--', color=style.FACE, lw=1.2)
    axes.plot(*np.stack([START - u, END + u]).T, '--', color=style.FACE, lw=1.2)
    middle = 0.55 * END
    outward = unit(np.array([END[1], -END[0]]))
    style.arrow(axes, middle, middle + RADIUS * outward, style.BOUND)
    style.label(axes, middle + RADIUS * outward + [0.04, -0.05], 's', style.BOUND)
    for place, text, shift in ((trocar, 'P₀', (0.03, 0.06)), (START, 'P', (0.02, -0.13)),
                               (END, "P'", (-0.13, -0.13)), (eye, 'eye E', (0.05, -0.03))):
        axes.plot(*place, 'o', color=style.TEXT, ms=4)
        style.label(axes, place + np.array(shift), text)
    style.label(axes, (-1.6, 0.1), 'dashed: the 1999 volume.\nIts sides are moved by\n'
                "s along PP', and it ends\nflat at PP'.", style.FACE)
    style.label(axes, (0.55, 0.15), 'solid: the conservative\nwedge, moved by s\nat right angles',
                style.BOUND)
    style.label(axes, (0.1, START[1] + RADIUS + 0.04), 'far', style.BOUND)
    style.label(axes, (eye[0] + right * near + 0.04, -RADIUS - 0.06), 'near', style.BOUND)
    axes.set_xlim(-1.6, 1.5)


def draw_side(axes):
    style.drawing(axes, 'From the side')
    eye, near, far, _, _ = wedge()
    z = np.array([eye[1] + near, eye[1] + far])
    for sign in (-1, 1):
        axes.plot(sign * RADIUS * np.array([0, 1, far / near]), [eye[1], z[0], z[1]], ':',
                  color=style.GUIDE, lw=1.2)
        axes.plot([sign * RADIUS] * 2, z, color=style.BOUND, lw=1.8)
    for depth in z:
        axes.plot([-RADIUS, RADIUS], [depth] * 2, color=style.BOUND, lw=1.8)
    capsule(axes, np.zeros(2), np.array([0, START[1]]))
    axes.plot([0, 0], [0, START[1]], color=style.TOOL, lw=1.6)
    axes.plot(0, eye[1], 'o', color=style.TEXT, ms=4)
    style.label(axes, (0.05, eye[1] - 0.05), 'E')
    style.label(axes, (RADIUS + 0.06, 0.72), 'user planes\ny = ±s', style.BOUND)
    style.label(axes, (RADIUS + 0.06, 1.05), "the frustum's\nown top\nand bottom", style.GUIDE)
    axes.set_xlim(-0.75, 1.15)


def draw():
    figure, (top, side) = style.panels(2, 4.4, [1.5, 1])
    draw_top(top)
    draw_side(side)
    return figure
