"""The box of a leg: planes across the axes that the link's box has half way."""

import matplotlib.pyplot as plt
import numpy as np

import style

HALF = np.array([0.9, 0.25])
START, END = (np.array([0.0, 0.0]), 0.0), (np.array([0.6, 1.3]), 0.7)  # centre and angle
RADIUS = 0.08
FACE_START, FACE_END = np.array([[1.3, 2.5], [2.2, 2.1]]), np.array([[0.9, 1.75], [1.75, 1.35]])
ARM = np.linalg.norm(HALF)
DEVIATION = ARM * (END[1] - START[1])**2 / 8


def turn(angle):
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def corners(time):
    centre = START[0] + time * (END[0] - START[0])
    box = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * HALF
    return centre + box @ turn(START[1] + time * (END[1] - START[1])).T


def draw_box(axes):
    style.drawing(axes, 'The link\'s box on one leg')
    half_way = turn(0.5 * (START[1] + END[1]))
    for time, alpha in ((0, 0.35), (0.25, 0.1), (0.5, 0.1), (0.75, 0.1), (1, 0.35)):
        axes.add_patch(plt.Polygon(corners(time), fc=style.TOOL, alpha=alpha, lw=0))
    both = np.concatenate([corners(0), corners(1)]) @ half_way
    low = both.min(0) - RADIUS - DEVIATION
    high = both.max(0) + RADIUS + DEVIATION
    outline = np.array([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]])
    axes.add_patch(plt.Polygon(outline @ half_way.T, fill=False, ec=style.BOUND, lw=1.8))
    middle = START[0] + 0.5 * (END[0] - START[0])
    for i in range(2):
        style.arrow(axes, middle, middle + 0.55 * half_way[:, i], style.BOUND)
    style.label(axes, middle + 0.62 * half_way[:, 0] - [0.3, 0.42], 'axes half way', style.BOUND)
    style.label(axes, START[0] - [0.8, 0.07], 'start', style.TOOL)
    style.label(axes, END[0] + [-0.65, -0.45], 'end', style.TOOL)
    for face, line in ((FACE_START, '-'), (FACE_END, '--')):
        axes.plot(*face.T, line, color=style.FACE, lw=2.2)
    style.label(axes, FACE_START[1] + [0.05, 0.0], 'face, start', style.FACE)
    style.label(axes, FACE_END[1] + [0.05, 0.0], 'face, end', style.FACE)
    axes.set_xlim(-1.9, 3.2)


def gap(time, axis):
    face = (FACE_START + time * (FACE_END - FACE_START)) @ axis
    return face.min() - (corners(time) @ axis).max() - RADIUS


def draw_gap(axes):
    axis = turn(0.5 * (START[1] + END[1]))[:, 1]
    times = np.linspace(0, 1, 200)
    axes.plot(times, [gap(time, axis) for time in times], color=style.TOOL,
              label='true gap − radius')
    ends = [gap(0, axis) - DEVIATION, gap(1, axis) - DEVIATION]
    axes.plot([0, 1], ends, 'o--', color=style.BOUND, ms=4,
              label='straight line between the ends,\nless the chord deviation')
    axes.axhline(0, color=style.GUIDE, lw=0.8)
    clear = ends[0] / (ends[0] - ends[1])
    axes.plot(clear, 0, 'v', color=style.BOUND)
    style.label(axes, (clear - 0.02, -0.12), 'clear until', style.BOUND, ha='right')
    axes.set_xlabel('time of the leg')
    axes.set_ylabel('gap along one axis [m]')
    axes.set_title('Why two values bound the gap', color=style.TEXT)
    axes.legend(frameon=False)


def draw():
    figure, (box, gaps) = style.panels(2, 3.7, [1.15, 1])
    draw_box(box)
    draw_gap(gaps)
    return figure
