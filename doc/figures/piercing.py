"""Ties go to the pair nearest the tip; where the axis pierces, the normal is the face's own."""

import matplotlib.pyplot as plt
import numpy as np

import style

RADIUS = 0.3


def shaft(axes, trocar, tip):
    along = (tip - trocar) / np.linalg.norm(tip - trocar)
    angle = np.arctan2(along[1], along[0])
    turn = np.linspace(-np.pi / 2, np.pi / 2, 40) + angle
    cap = tip + RADIUS * np.stack([np.cos(turn), np.sin(turn)], 1)
    across = RADIUS * np.array([along[1], -along[0]])
    axes.add_patch(plt.Polygon(np.concatenate([[trocar + across], cap, [trocar - across]]),
                               fc=style.TOOL, alpha=0.25, lw=0))
    axes.plot(*np.stack([trocar, tip]).T, color=style.TOOL, lw=2)
    axes.plot(*tip, 'o', color=style.TOOL, ms=4)


def draw_tie(axes):
    style.drawing(axes, 'A tie: all pairs have one separation vector')
    shaft(axes, np.array([-0.6, 0.0]), np.array([2.0, 0.0]))
    axes.plot([0.2, 1.5], [0.75, 0.75], color=style.FACE, lw=3)
    for x in np.linspace(0.2, 1.5, 6):
        style.arrow(axes, (x, 0), (x, 0.75), style.TEXT if x == 1.5 else style.GUIDE,
                    width=1.8 if x == 1.5 else 0.8)
    style.label(axes, (1.55, 0.8), 'the pair nearest\nthe tip is reported')
    style.label(axes, (2.05, -0.12), 'tip', style.TOOL)
    style.label(axes, (0.2, 0.83), 'face', style.FACE)
    axes.set_xlim(-0.7, 3.0)
    axes.set_ylim(-0.6, 1.4)


def draw_piercing(axes):
    style.drawing(axes, 'The axis pierces the face')
    trocar, tip = np.array([-0.9, 1.5]), np.array([0.55, -0.75])
    shaft(axes, trocar, tip)
    axes.plot([-1.4, 1.6], [0, 0], color=style.FACE, lw=3)
    crossing = trocar + (trocar[1] / (trocar[1] - tip[1])) * (tip - trocar)
    axes.plot(*crossing, 'o', color=style.TEXT, ms=5)
    style.label(axes, crossing + [0.45, 0.12], 'point')
    style.arrow(axes, (-1.1, 0), (-1.1, -0.5), style.TEXT)
    style.label(axes, (-1.35, -0.35), 'n')
    foot = tip[1] - RADIUS
    style.arrow(axes, (1.15, 0), (1.15, foot), style.BOUND, '<->')
    axes.plot([0.3, 1.25], [foot, foot], '--', color=style.GUIDE, lw=0.8)
    style.label(axes, (1.22, 0.5 * foot), 'depth =\nn·(tip − point) + s', style.BOUND,
                va='center')
    style.label(axes, tip + [0.06, 0.05], 'tip', style.TOOL)
    axes.set_xlim(-1.5, 2.9)


def draw():
    figure, (tie, piercing) = style.panels(2, 3.1)
    draw_tie(tie)
    draw_piercing(piercing)
    return figure
