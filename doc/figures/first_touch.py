"""Conservative advancement with a turning plane: a tip that moves along a face.

Axis and face are segments of one plane, so that closest points are simple; the bound is the one of
the code.
"""

import numpy as np

import style

RADIUS = 0.17
TROCAR = np.array([-0.4, 0.0])
TIPS = np.array([[-1.2, 1.0], [0.9, 1.62]])
FACE = np.array([[0.25, 1.62], [1.3, 1.9]])


def place_on(point, start, end):
    way = end - start
    return start + np.clip((point - start) @ way / (way @ way), 0, 1) * way


def tip(time):
    return TIPS[0] + time * (TIPS[1] - TIPS[0])


def closest(time):
    """Separation vector from the axis to the face. The two never cross before first touch."""
    pairs = [(end, place_on(end, *FACE)) for end in (TROCAR, tip(time))]
    pairs += [(place_on(corner, TROCAR, tip(time)), corner) for corner in FACE]
    return min(((b - a, a, b) for a, b in pairs), key=lambda pair: np.linalg.norm(pair[0]))


def coefficients(begin, end, radius):
    """Bernstein coefficients of the bound for each pair of a corner and an end of the axis."""
    n0, n1 = (closest(time)[0] for time in (begin, end))
    n0, n1 = n0 / np.linalg.norm(n0), n1 / np.linalg.norm(n1)
    if n0 @ n1 <= 0:
        n1 = n0
    rows = []
    for corner in FACE:
        for points in ((TROCAR, TROCAR), (tip(begin), tip(end))):
            h0, h1 = corner - points[0], corner - points[1]
            rows.append((n0 @ h0 - radius, 0.5 * (n0 @ h1 + n1 @ h0) - 0.5 * (1 + n0 @ n1) * radius,
                         n1 @ h1 - radius))
    return rows


def bernstein(row, s):
    return row[0] * (1 - s)**2 + 2 * row[1] * s * (1 - s) + row[2] * s**2


def advances():
    """Intervals that the search looks at: begin, end, and the time until which it is clear."""
    now, ahead, found = 0.0, 1.0, []
    for _ in range(20):
        s = np.linspace(0, 1, 20001)
        least = np.min([bernstein(row, s) for row in coefficients(now, ahead, RADIUS)], axis=0)
        below = np.argmax(least <= 0) if np.any(least <= 0) else None
        clear = ahead if below is None else now + s[below] * (ahead - now)
        found.append((now, ahead, clear))
        distance = np.linalg.norm(closest(clear)[0])
        if distance <= RADIUS + 1e-3 or clear >= 1.0:
            break
        length = ahead - now
        now, ahead = clear, min(clear + 0.25 * length, 1.0)
    return found


def draw_shapes(axes, found):
    style.drawing(axes, 'The separating plane of the first interval turns')
    begin, end, clear = found[0]
    normals = [closest(time)[0] / np.linalg.norm(closest(time)[0]) for time in (begin, end)]
    if normals[0] @ normals[1] <= 0:
        normals[1] = normals[0]
    axes.plot(*FACE.T, color=style.FACE, lw=3)
    style.label(axes, FACE[1] + [0.05, -0.05], 'face', style.FACE)
    for time, text, shift, side in ((begin, 'start', (-0.1, 0.0), 'right'),
                                    (clear, 'first time that\nthe bound allows\na touch', (-0.25, 0.0), 'right'),
                                    (end, 'end', (0.05, -0.2), 'left')):
        axes.plot(*np.stack([TROCAR, tip(time)]).T, color=style.TOOL, lw=1.8)
        style.label(axes, tip(time) + shift, text, style.TOOL, ha=side, va='bottom')
    for s, (time, line) in enumerate(((begin, '-'), (end, '--'))):
        normal, anchor = normals[s], closest(time)[2]
        along = np.array([-normal[1], normal[0]])
        axes.plot(*np.stack([anchor - 0.5 * along, anchor + 0.5 * along]).T, line,
                  color=style.BOUND)
        foot = anchor + 0.45 * along
        style.arrow(axes, foot, foot + 0.25 * normal, style.BOUND)
        style.label(axes, foot + 0.37 * normal, 'n' + '₀₁'[s], style.BOUND, ha='center', va='center')
    axes.set_ylim(-0.1, 2.35)


def draw_times(axes, found):
    times = np.linspace(0, 1, 400)
    axes.plot(times, [np.linalg.norm(closest(time)[0]) for time in times], color=style.TOOL, lw=1.5,
              label='distance')
    axes.axhline(RADIUS, color=style.FACE, lw=1, label='radius')
    for i, (begin, end, clear) in enumerate(found[:3]):
        rows = coefficients(begin, end, RADIUS)
        s = np.linspace(0, 1, 200)
        row = min(rows, key=lambda r: np.argmax(np.append(bernstein(r, s), 0) <= 0))
        at = begin + s * (end - begin)
        axes.plot(at, RADIUS + bernstein(row, s), '-', color=style.BOUND, lw=1.5,
                  label='bound of an interval (+ radius)' if i == 0 else None)
        if i == 0:
            axes.plot([begin, 0.5 * (begin + end), end], RADIUS + np.array(row), 'o:', ms=4,
                      color=style.GUIDE, label='its Bernstein coefficients')
        axes.plot(clear, RADIUS, 'v', color=style.BOUND, ms=6)
        style.label(axes, (clear - 0.005, RADIUS - 0.09), str(i + 1), style.BOUND, ha='center')
    axes.set_ylim(-0.35, 1.7)
    axes.set_xlabel('time of the leg')
    axes.set_ylabel('distance [m]')
    axes.set_title('Each bound tells until when nothing touches', color=style.TEXT)
    axes.legend(frameon=False, loc='upper right')


def draw():
    figure, (shapes, times) = style.panels(2, 3.8, [1, 1.2])
    found = advances()
    draw_shapes(shapes, found)
    draw_times(times, found)
    return figure
