"""Blocks, sections and a cluster of an organ; step, legs and a span of a tool's path."""

import matplotlib.pyplot as plt
import numpy as np

import style

BLOCK = 8
SIDE = 32


def place_in_order(x, y):
    """The place of a vertex if the grid is halved again and again across its longest side."""
    return sum(((y >> bit & 1) << 2 * bit) | ((x >> bit & 1) << 2 * bit + 1) for bit in range(5))


def draw_organ(axes):
    style.drawing(axes, 'An organ of 32 x 32 vertices: 128 blocks in 8 sections')
    order = {(x, y): place_in_order(x, y) for x in range(SIDE) for y in range(SIDE)}
    block = {vertex: place // BLOCK for vertex, place in order.items()}
    faces = [corners for x in range(SIDE - 1) for y in range(SIDE - 1)
             for corners in (((x, y), (x + 1, y), (x + 1, y + 1)),
                             ((x, y), (x + 1, y + 1), (x, y + 1)))]
    chosen = block[(9, 13)]
    cluster = [face for face in faces if min(block[corner] for corner in face) == chosen]
    for face in cluster:
        axes.add_patch(plt.Polygon(face, fc=style.FACE, ec='white', alpha=0.5, lw=0.4))
    touched = {block[corner] for face in cluster for corner in face}
    points = np.array(list(order))
    axes.plot(points[:, 0], points[:, 1], '.', color=style.GUIDE, ms=1.6)
    for number in set(block.values()):
        own = np.array([vertex for vertex in block if block[vertex] == number])
        low, size = own.min(0) - 0.3, np.ptp(own, 0) + 0.6
        strong = number in touched
        axes.add_patch(plt.Rectangle(low, *size, fill=False, ec=style.TOOL if strong else '#c8c8c8',
                                     lw=1.6 if strong else 0.7))
    for corner in ((x, y) for x in (0, 16) for y in (0, 8, 16, 24)):
        axes.add_patch(plt.Rectangle(np.array(corner) - 0.48, 15.96, 7.96, fill=False,
                                     ec=style.BOUND, lw=1.8))
    style.label(axes, (32.6, 26), 'section:\n16 blocks', style.BOUND)
    style.label(axes, (32.6, 16), 'block: 8 vertices\n(blue: the blocks that\nhold the '
                'vertices of\nthe red cluster)', style.TOOL)
    style.label(axes, (32.6, 8), 'cluster: the faces\nwhose first vertex\nis in one block',
                style.FACE)
    axes.set_xlim(-1, 46)


def draw_tool(axes):
    style.drawing(axes, 'A part of a tool, and one step of its path')
    way = np.array([[0, 0], [1.5, 0.12], [3, -0.1], [4.4, 0.05], [6.2, 1.7]])
    axis = np.array([0.4, 2.6])
    radius = 0.33
    for place in (way[0], way[-1]):
        ends = np.stack([place, place + axis])
        across = radius * np.array([axis[1], -axis[0]]) / np.linalg.norm(axis)
        angle = np.degrees(np.arctan2(axis[1], axis[0]))
        axes.add_patch(plt.Polygon([ends[0] + across, ends[1] + across, ends[1] - across,
                                    ends[0] - across], fc=style.TOOL, alpha=0.2, lw=0))
        for end, turn in ((ends[0], 180), (ends[1], 0)):
            axes.add_patch(plt.matplotlib.patches.Wedge(end, radius, angle - 90 + turn,
                                                        angle + 90 + turn, fc=style.TOOL, alpha=0.2,
                                                        lw=0))
        axes.plot(*ends.T, color=style.TOOL, lw=2)
    style.arrow(axes, way[0] + 0.6 * axis, way[0] + 0.6 * axis + across, style.TOOL)
    style.label(axes, way[0] + 0.62 * axis + [0.4, 0], 'radius', style.TOOL)
    style.label(axes, way[0] + axis + [-0.3, 0.5], 'part = core + radius\ncore: here an axis',
                style.TOOL)
    axes.plot(*way.T, '-o', color=style.TEXT, ms=4, lw=1)
    axes.plot(*way[[0, 3]].T, '--', color=style.BOUND, lw=1.2)
    for i in range(4):
        style.label(axes, 0.5 * (way[i] + way[i + 1]) + [0, 0.13], f'leg {i + 1}', ha='center')
    style.arrow(axes, way[0] - [0, 0.75], [way[3][0], -0.75], style.BOUND, '|-|')
    style.label(axes, (2.2, -1.5), 'span: legs 1 to 3 stay near one chord', style.BOUND,
                ha='center')
    style.arrow(axes, way[0] - [0, 2.1], [way[-1][0], -2.1], style.TEXT, '|-|')
    style.label(axes, (3.1, -2.9), 'step: fraction 0 to 1; dots are waypoints', ha='center')
    axes.set_xlim(-0.8, 7.4)
    axes.set_ylim(-3.0, 4.6)


def draw():
    figure, (organ, tool) = style.panels(2, 3.7, [1.2, 1])
    draw_organ(organ)
    draw_tool(tool)
    return figure
