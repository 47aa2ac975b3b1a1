"""Hand, proxy, clearance and the planes that stop the proxy. Lengths are millimetres; the clearance is enlarged."""

import matplotlib.pyplot as plt
import numpy as np

import style

RADIUS, CLEARANCE = 3.0, 1.2


def draw_ball(axes, center, text, solid):
    axes.add_patch(plt.Circle(center, RADIUS, fc=style.TOOL, alpha=0.75 if solid else 0.2, lw=0))
    axes.add_patch(plt.Circle(center, RADIUS, fill=False, ec=style.TOOL, lw=1.2, ls='-' if solid else '--'))
    style.label(axes, center + [RADIUS + 0.7, 0], text, style.TOOL, va='center')


def draw_spring(axes, hand, proxy):
    way = proxy - hand
    across = np.array([-way[1], way[0]]) / np.linalg.norm(way)
    shares = np.linspace(0, 1, 15)
    bends = 0.7 * np.array([0, 0] + [1, -1] * 5 + [0] * 3)
    axes.plot(*(hand[:, None] + way[:, None] * shares + across[:, None] * bends), color=style.BOUND, lw=1.4)


def draw_tissue(axes, corners, bottom):
    corners = np.asarray(corners, float)
    ends = [[corners[-1][0], bottom], [corners[0][0], bottom]]
    axes.add_patch(plt.Polygon(np.concatenate([corners, ends]), fc=style.FACE, alpha=0.18, lw=0))
    axes.plot(*corners.T, color=style.FACE, lw=2)


def draw_flat(axes):
    style.drawing(axes, 'The proxy stops at the\nclearance; the spring\nis the force')
    hand, proxy = np.array([0.0, -6.5]), np.array([0.0, RADIUS + CLEARANCE])
    draw_tissue(axes, [[-12, 0], [14, 0]], -12)
    draw_ball(axes, hand, 'hand', False)
    draw_ball(axes, proxy, 'proxy', True)
    draw_spring(axes, hand, proxy)
    style.arrow(axes, [-6, 0], [-6, CLEARANCE], style.TEXT, '<->', 1.0)
    axes.plot([-7.5, 0], [CLEARANCE, CLEARANCE], ':', color=style.GUIDE, lw=1)
    style.label(axes, [-6.8, CLEARANCE + 0.4], 'clearance', style.TEXT, ha='center')
    axes.set_xlim(-15, 14)
    axes.set_ylim(-12, 10)


def nearest_beyond_planes(hand, planes):
    """The point nearest the hand on the outer side of two planes (normal, offset) that both hold it."""
    normals = np.array([normal for normal, _ in planes])
    missing = np.array([offset - normal @ hand for normal, offset in planes])
    return hand + normals.T @ np.linalg.solve(normals @ normals.T, missing)


def first_on_plane(start, end, plane):
    """Where the way from start to end meets the plane."""
    normal, offset = plane
    share = (offset - normal @ start) / (normal @ (end - start))
    return start + share * (end - start)


def draw_crease(axes):
    style.drawing(axes, 'Met faces are planes for the\ncentre. The proxy goes to the\nplace nearest the hand')
    left, right = np.array([-14.0, 7.0]), np.array([14.0, 4.0])
    draw_tissue(axes, [left, [0, 0], right], -12)
    planes = []
    for corner, turn in ((left, -1), (right, 1)):
        along = corner / np.linalg.norm(corner)
        normal = turn * np.array([-along[1], along[0]])
        planes.append((normal, RADIUS + CLEARANCE))
        line = np.stack([normal * (RADIUS + CLEARANCE) + share * along for share in (-4, 14)])
        axes.plot(*line.T, '--', color=style.GUIDE, lw=1)
    hand = np.array([3.0, -7.0])
    proxy = nearest_beyond_planes(hand, planes)
    start = np.array([13.0, 12.5])
    met = first_on_plane(start, hand, planes[1])
    axes.plot(*np.stack([start, met, proxy]).T, color=style.TOOL, lw=1.4)
    axes.plot(*start, 'o', color=style.TOOL, ms=4)
    style.label(axes, start + [-0.9, 0], 'last tick', style.TOOL, ha='right', va='center')
    draw_ball(axes, hand, 'hand', False)
    draw_ball(axes, proxy, '', True)
    style.label(axes, proxy + [-RADIUS - 0.4, 0.4], 'proxy', style.TOOL, ha='right')
    draw_spring(axes, hand, proxy)
    style.label(axes, [-13.8, 12.4], 'planes', style.GUIDE)
    axes.set_xlim(-15, 16)
    axes.set_ylim(-12, 14)


def draw_thin(axes):
    style.drawing(axes, 'The hand is through thin\ntissue. The proxy is not,\nand pulls it back')
    hand, proxy = np.array([1.0, -8.5]), np.array([1.0, RADIUS + CLEARANCE])
    draw_tissue(axes, [[-12, 0], [14, 0]], -2)
    axes.plot([-12, 14], [-2, -2], color=style.FACE, lw=2)
    draw_ball(axes, hand, 'hand', False)
    draw_ball(axes, proxy, 'proxy', True)
    draw_spring(axes, hand, proxy)
    style.arrow(axes, hand + [-5, 0], hand + [-5, 6], style.BOUND, width=1.8)
    style.label(axes, hand + [-5.6, 2.5], 'force', style.BOUND, ha='right')
    axes.set_xlim(-15, 14)
    axes.set_ylim(-12, 10)


def draw():
    figure, (flat, crease, thin) = style.panels(3, 3.0)
    draw_flat(flat)
    draw_crease(crease)
    draw_thin(thin)
    return figure
