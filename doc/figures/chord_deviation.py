"""A rotating point against its chord, and how far the rim of a disc reaches along a direction."""

import matplotlib.pyplot as plt
import numpy as np

import style

ANGLE = 1.2
RADIUS = 1.0


def on_arc(s):
    return RADIUS * np.stack([np.cos(ANGLE * (s - 0.5)), np.sin(ANGLE * (s - 0.5))], -1)


def on_chord(s):
    ends = on_arc(np.array([0.0, 1.0]))
    return ends[0] + s[..., None] * (ends[1] - ends[0])


def draw_arc(axes):
    style.drawing(axes, 'A point turns by α')
    s = np.linspace(0, 1, 100)
    axes.plot(*on_arc(s).T, color=style.TOOL, lw=2)
    axes.plot(*on_chord(s).T, '--', color=style.BOUND, lw=1.5)
    few = np.linspace(0, 1, 7)
    for a, b in zip(on_arc(few), on_chord(few)):
        axes.plot(*np.stack([a, b]).T, color=style.FACE, lw=1)
    for end in on_arc(np.array([0.0, 1.0])):
        axes.plot([0, end[0]], [0, end[1]], color=style.GUIDE, lw=0.8)
    axes.plot(0, 0, 'o', color=style.TEXT, ms=4)
    style.label(axes, (-0.02, 0.06), 'axis', ha='right')
    style.label(axes, (0.2, 0.0), 'α')
    style.label(axes, (0.42, 0.32), 'ρ')
    style.label(axes, (1.02, 0.0), 'arc', style.TOOL)
    style.label(axes, (0.8, -0.06), 'chord', style.BOUND, ha='right')
    axes.set_xlim(-0.25, 1.25)


def draw_deviation(axes):
    s = np.linspace(0, 1, 200)
    deviation = np.linalg.norm(on_arc(s) - on_chord(s), axis=1)
    axes.plot(s, deviation, color=style.FACE, label='deviation')
    axes.plot(s, 4 * s * (1 - s) * RADIUS * ANGLE**2 / 8, '--', color=style.BOUND,
              label='bound:\n4 s (1 − s) ρ α² / 8')
    axes.set_xlabel('s, the share of the time')
    axes.set_ylabel('deviation / ρ')
    axes.set_title('Same place in time (α = 1.2)', color=style.TEXT)
    axes.legend(frameon=False, loc='lower center')


def draw_rim(axes):
    style.drawing(axes, 'Support value of a cylinder')
    tilt, radius, half = np.radians(25), 0.45, 0.8
    along, across = np.array([np.cos(tilt), np.sin(tilt)]), np.array([-np.sin(tilt), np.cos(tilt)])
    corners = [half * along + radius * across, half * along - radius * across,
               -half * along - radius * across, -half * along + radius * across]
    axes.add_patch(plt.Polygon(corners, fc=style.TOOL, alpha=0.25, ec=style.TOOL))
    centre, top = half * along, corners[0]
    axes.plot(*np.stack([-half * along, centre]).T, 'o-', color=style.TOOL, ms=4)
    style.arrow(axes, centre, top, style.FACE)
    axes.axhline(top[1], 0.05, 0.95, color=style.BOUND, ls='--')
    axes.axhline(centre[1], 0.3, 0.95, color=style.GUIDE, ls=':')
    place = 1.05
    style.arrow(axes, (place, centre[1]), (place, top[1]), style.BOUND, '<->')
    middle = 0.5 * (centre[1] + top[1])
    style.label(axes, (place + 0.05, middle), '|Rᵀn|', style.BOUND, va='center')
    style.label(axes, centre + [0.06, -0.1], 'c', style.TOOL)
    style.arrow(axes, (-0.85, top[1] - 0.5), (-0.85, top[1] - 0.15), style.TEXT)
    style.label(axes, (-0.8, top[1] - 0.4), 'n')
    style.label(axes, (-0.8, top[1] + 0.06), 'n·c + |Rᵀn|', style.BOUND)
    axes.set_xlim(-1.25, 1.5)
    axes.set_ylim(-1.0, top[1] + 0.35)


def draw():
    figure, (arc, deviation, rim) = style.panels(3, 3.2, [1, 1.1, 1.1])
    draw_arc(arc)
    draw_deviation(deviation)
    draw_rim(rim)
    return figure
