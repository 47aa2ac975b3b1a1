"""Which faces a search measures, and how a leg is halved until the smallest distance is known."""

import matplotlib.pyplot as plt
import numpy as np

import style

LIMIT_BELOW_BEST = 0.02  # kApproach, enlarged to be visible


def draw_boxes(axes):
    style.drawing(axes, 'Groups of faces in the axes of the box')
    box = np.array([0.9, 0.25])
    axes.add_patch(plt.Rectangle(-box, *(2 * box), ec=style.TOOL, fc=style.TOOL, alpha=0.25))
    style.label(axes, (-0.8, -0.07), 'box around the part', style.TOOL)
    groups = [((-1.3, 0.75), (-0.5, 1.15)), ((-0.4, 1.05), (0.5, 1.5)), ((1.5, 0.7), (2.3, 1.3))]
    for low, high in groups:
        low, high = np.array(low), np.array(high)
        axes.add_patch(plt.Rectangle(low, *(high - low), ec=style.FACE, fc='none', lw=1.5))
        gap = np.maximum(0, np.maximum(low - box, -high - box))
        near = np.clip(0.5 * (low + high), -box, box)
        near = np.where(gap > 0, np.sign(0.5 * (low + high)) * box, near)
        style.arrow(axes, near, near + np.sign(low + high) * gap, style.BOUND)
        style.label(axes, near + 0.5 * gap + [0.06, -0.05], f'{np.linalg.norm(gap):.2f}',
                    style.BOUND)
    style.label(axes, (-1.3, 1.6), 'the nearest group is first; its faces set the bound',
                style.TEXT)
    axes.set_xlim(-1.5, 2.5)
    axes.set_ylim(-0.5, 1.8)


def distance(time):
    """A point that passes two corners of a face."""
    place = np.array([-1.2 + 2.6 * time, 0.55 - 0.25 * time])
    corners = [np.array([-0.35, 0.0]), np.array([0.25, -0.02])]
    share = np.clip((place - corners[0]) @ (corners[1] - corners[0]) /
                    ((corners[1] - corners[0]) @ (corners[1] - corners[0])), 0, 1)
    return np.linalg.norm(place - corners[0] - share * (corners[1] - corners[0]))


SPEED = np.hypot(2.6, 0.25)


def halved(begin, end, best):
    """Intervals with a lower bound of the distance, by the speed alone, and the best distance."""
    bound = 0.5 * (distance(begin) + distance(end) - SPEED * (end - begin))
    if bound > best[0] - LIMIT_BELOW_BEST:
        return [(begin, end, bound)]
    middle = 0.5 * (begin + end)
    best[0] = min(best[0], distance(middle))
    halves = [(begin, middle), (middle, end)]
    if distance(begin) >= distance(end):
        halves.reverse()
    return [interval for half in halves for interval in halved(*half, best)]


def draw_halving(axes):
    axes.set_title('Halving until every interval is above the limit', color=style.TEXT)
    times = np.linspace(0, 1, 400)
    axes.plot(times, [distance(t) for t in times], color=style.TOOL, lw=2)
    best = [min(distance(0.0), distance(1.0))]
    for begin, end, bound in halved(0.0, 1.0, best):
        axes.plot([begin, end], [bound, bound], color=style.BOUND, lw=2)
        axes.plot([begin, end], [distance(begin), distance(end)], 'o', color=style.TOOL, ms=3)
    axes.axhline(best[0] - LIMIT_BELOW_BEST, color=style.GUIDE, ls='--', lw=1)
    style.label(axes, (0.01, best[0] - LIMIT_BELOW_BEST - 0.055), 'limit = best − kApproach',
                style.GUIDE)
    style.label(axes, (0.1, 0.85), 'distance', style.TOOL)
    style.label(axes, (0.78, 0.5), 'bounds by the speed', style.BOUND)
    axes.set_xlabel('time')
    axes.set_ylim(0.2, 1.1)
    axes.set_yticks([])


def draw():
    figure, (boxes, halving) = style.panels(2, 3.0)
    draw_boxes(boxes)
    draw_halving(halving)
    return figure
