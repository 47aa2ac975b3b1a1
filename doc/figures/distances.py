"""The three distance algorithms: pairs of an axis and a face, GJK, and the slope along an edge."""

import matplotlib.pyplot as plt
import numpy as np

import style


def draw_pairs(axes):
    style.drawing(axes, 'Axis and face: the pairs')
    face = np.array([[0, 0], [2.2, 0.2], [0.9, 1.7]])
    axes.add_patch(plt.Polygon(face, fc=style.FACE, alpha=0.25, ec=style.FACE))
    cases = [((0.95, 0.65), (0.95, 1.05), '1'), ((1.35, 0.12), (1.45, -0.45), '2'),
             ((0.9, 1.7), (0.8, 2.15), '3')]
    for on_face, on_axis, number in cases:
        style.arrow(axes, on_axis, on_face, style.TEXT, '-')
        axes.plot(*on_face, 'o', color=style.FACE, ms=4)
        axes.plot(*on_axis, 'o', color=style.TOOL, ms=4)
        style.label(axes, np.array(on_axis) + [0.08, 0.0], number)
    axes.plot([0.95, 1.7], [1.05, 2.2], color=style.TOOL, lw=2)
    axes.plot([0.55, 2.4], [-0.61, -0.28], color=style.TOOL, lw=2)
    axes.plot([0.0, 1.25], [2.05, 2.21], color=style.TOOL, lw=2)
    style.label(axes, (-0.35, -1.5), '1 end over the inside (or piercing)\n2 edge and axis\n'
                '3 corner and axis')
    axes.set_xlim(-0.5, 2.7)


def nearest_on_hull(points):
    """The hull's point nearest to the origin, of up to three points, and the points it needs."""
    best = min(([point, [point]] for point in points), key=lambda pair: np.linalg.norm(pair[0]))
    for i, a in enumerate(points):
        for b in points[i + 1:]:
            way = b - a
            place = np.clip(-a @ way / (way @ way), 0, 1)
            if 0 < place < 1 and np.linalg.norm(a + place * way) < np.linalg.norm(best[0]) - 1e-12:
                best = [a + place * way, [a, b]]
    return best


def draw_gjk(axes):
    style.drawing(axes, 'GJK on the difference of two hulls')
    core = np.array([[-1.5, -0.4], [-0.3, -0.9], [0.1, 0.0], [-0.6, 0.7], [-1.4, 0.5]])
    face = np.array([[1.0, 0.55], [2.1, 1.4], [0.9, 1.9]])
    difference = np.array([b - a for a in core for b in face])
    centre = difference.mean(0)
    hull = [difference[np.argmax(difference @ np.array([np.cos(t), np.sin(t)]))]
            for t in np.linspace(0, 2 * np.pi, 720)]
    hull = np.unique(np.array(hull), axis=0)
    hull = hull[np.argsort(np.arctan2(*(hull - centre).T[::-1]))]
    axes.add_patch(plt.Polygon(hull, fc=style.GUIDE, alpha=0.2, ec=style.GUIDE))
    axes.plot(0, 0, 'o', color=style.TEXT, ms=4)
    style.label(axes, (-0.1, -0.1), 'origin', ha='right', va='top')
    simplex = [difference[np.argmax(difference[:, 1])]]
    nearest = simplex[0]
    for step in range(1, 8):
        axes.plot(*nearest, 's', color=style.FACE, ms=4)
        style.label(axes, nearest + [0.1, 0.02], str(step), style.FACE)
        support = difference[np.argmin(difference @ nearest)]
        if nearest @ (nearest - support) < 1e-9:
            break
        axes.plot(*np.stack([nearest, support]).T, ':', color=style.TOOL, lw=1)
        axes.plot(*support, 'o', color=style.TOOL, ms=5)
        nearest, simplex = nearest_on_hull(simplex + [support])
    style.arrow(axes, np.zeros(2), nearest, style.TEXT)
    along = np.array([-nearest[1], nearest[0]]) / np.linalg.norm(nearest)
    axes.plot(*np.stack([nearest - 1.2 * along, nearest + 0.9 * along]).T, '--', color=style.BOUND,
              lw=1.2)
    style.label(axes, nearest + 0.95 * along, 'plane that proves\nthe distance', style.BOUND,
                ha='right')
    axes.set_xlim(-2.0, 4.0)


def draw_slope(axes):
    corner, edge = np.array([-0.9, 0.75, 0.55]), np.array([2.0, 0.35, 1.1])
    radius, length = 0.5, 1.2

    def half_slope(place):
        point = corner + place * edge
        across, sideways = point[:2], edge[:2]
        distance = np.linalg.norm(across)
        value = edge[2] * (point[2] - np.clip(point[2], 0, length))
        return value + max(distance - radius, 0) * (across @ sideways) / distance

    places = np.linspace(0, 1, 300)
    axes.plot(places, [half_slope(place) for place in places], color=style.TOOL,
              label='half the slope of distance²')
    axes.axhline(0, color=style.GUIDE, lw=0.8)
    place = 0.5
    for step in range(3):
        value = half_slope(place)
        rise = (half_slope(place + 1e-6) - value) / 1e-6
        axes.plot([place, place - value / rise], [value, 0], color=style.FACE, lw=1,
                  label="Newton's steps" if step == 0 else None)
        axes.plot(place, value, 'o', color=style.FACE, ms=4)
        place -= value / rise
    axes.set_xlabel('place on the edge')
    axes.set_title('Cylinder and edge: the slope only rises', color=style.TEXT)
    axes.legend(frameon=False)


def draw():
    figure, (pairs, gjk, slope) = style.two_and_one(6.0, (1.3, 1))
    draw_pairs(pairs)
    draw_gjk(gjk)
    draw_slope(slope)
    return figure
