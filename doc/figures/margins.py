"""A face that moves is drawn half way; the volume grows by half its motion."""

import matplotlib.pyplot as plt
import numpy as np

import style

BEFORE = np.array([[0.3, 0.85], [1.3, 0.45]])
AFTER = np.array([[0.5, 0.33], [1.5, -0.05]])
RADIUS = 0.2
TIP = np.array([0.9, 0.0])


def capsule(radius):
    turn = np.linspace(-np.pi / 2, np.pi / 2, 50)
    cap = TIP + radius * np.stack([np.cos(turn), np.sin(turn)], 1)
    return np.concatenate([[[-0.6, -radius]], cap, [[-0.6, radius]]])


def draw():
    figure, (axes, boxes) = style.panels(2, 3.6, [1.25, 1])
    style.drawing(axes, 'Why half the motion suffices')
    half_way = 0.5 * (BEFORE + AFTER)
    move = 0.5 * np.linalg.norm(AFTER - BEFORE, axis=1).max()
    axes.add_patch(plt.Polygon(capsule(RADIUS), fc=style.TOOL, alpha=0.25, lw=0))
    axes.plot([-0.6, TIP[0]], [0, 0], color=style.TOOL, lw=1.6)
    axes.plot(*capsule(RADIUS + move).T, '--', color=style.BOUND, lw=1.5)
    for face, name, line in ((BEFORE, 'start', 1.0), (half_way, 'half way (drawn)', 2.4),
                             (AFTER, 'end', 1.0)):
        axes.plot(*face.T, '-o', color=style.FACE, ms=3, lw=line)
        style.label(axes, face[1] + [0.05, 0.0], name, style.FACE)
    for corner in range(2):
        style.arrow(axes, BEFORE[corner], AFTER[corner], style.GUIDE, width=0.8)
    style.label(axes, (-0.55, 0.04), 's', style.TOOL)
    text = 'grown by m, half of the\nlongest way of a corner'
    style.label(axes, (-0.55, -RADIUS - move - 0.06), text, style.BOUND, va='top')
    axes.set_xlim(-0.65, 2.05)

    boxes.set_title('Growth for rounding', color=style.TEXT)
    extent = np.logspace(-1, 2, 200)
    for ratio, line in ((10, '-'), (100, '--'), (1000, ':')):
        boxes.loglog(extent, 16 * 2.0**-24 * extent * ratio, line, color=style.FACE,
                     label=f'far plane in addition, far / near = {ratio}')
    boxes.loglog(extent, 1e-6 * extent, color=style.BOUND, lw=2, label='every plane: 1e-6 X')
    boxes.axhline(5e-3, color=style.TOOL, lw=1)
    style.label(boxes, (0.11, 6e-3), 'radius of a shaft', style.TOOL)
    boxes.set_ylim(1e-11, 1)
    for axis in (boxes.xaxis, boxes.yaxis):
        axis.set_major_formatter(style.power_of_ten)
    boxes.set_xlabel('X, the largest coordinate [m]')
    boxes.set_ylabel('growth [m]')
    boxes.legend(frameon=False, loc='lower right')
    return figure
