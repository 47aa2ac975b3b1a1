"""How far 32-bit arithmetic misplaces planes: the budgets that are derived, and what was measured.

The measurement repeats the arithmetic of outcodes.cpp and of GL's vertex transform in numpy's
32-bit floats, for points that lie on a plane exactly.
"""

import numpy as np

import style
from wedge import unit

U = 2.0**-24  # half of the distance between 1 and the next 32-bit number
TRIALS = 1500
POINTS = 80


def dot32(row, points):
    """Row · (point, 1), summed from left to right in 32 bits."""
    row, points = row.astype(np.float32), points.astype(np.float32)
    total = row[0] * points[:, 0]
    for i in range(1, points.shape[1]):
        total = total + row[i] * points[:, i]
    return total + row[-1] if len(row) > points.shape[1] else total


def outcode_error(random, moving):
    """Largest error of a 32-bit dot product, in U times the sum of the coordinates' magnitudes."""
    normal = unit(random.normal(size=3) * random.choice([1.0, 0.01], size=3))
    after = random.normal(size=(POINTS, 3)).astype(np.float32)
    before = random.normal(size=(POINTS, 3)).astype(np.float32)
    fraction = random.uniform() if moving else 1.0
    points = before + np.float32(fraction) * (after - before) if moving else after
    exact = before + fraction * (after.astype(float) - before) if moving else after.astype(float)
    size = np.abs(after).sum(1, dtype=float)
    if moving:
        size = np.maximum(size, np.abs(before).sum(1, dtype=float))
    return np.max(np.abs(dot32(normal, points) - exact @ normal) / size) / U


def random_wedge(random):
    """Clip matrix, user planes, radius, near, far, reach and slant, as conservative_volume.cpp."""
    half = np.radians(random.uniform(2, 72))
    skew = np.radians(random.uniform(-1, 1) * (72 - np.degrees(half)))
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    x, y, z = turn
    slopes = np.tan([-half + skew, half + skew])
    tips = [slope * x + z for slope in slopes]
    radius = 10**random.uniform(-3, -0.3)
    back = 1 / np.sin(half)
    reach = max(max(np.linalg.norm(tip) for tip in tips) + radius, back * radius)
    eye = -unit(unit(tips[0]) + unit(tips[1])) * back * radius
    near, far = -z @ eye - radius, 1 - z @ eye + radius
    if near < 1e-3 * far:
        return None
    rows = [np.append(axis, -axis @ eye) for axis in (x, y, z)]
    w, one = rows[2] / near, np.array([0, 0, 0, 1.0])
    left, right = slopes * near
    clip = np.stack([(2 * rows[0] - (right + left) * w) / (right - left), rows[1] / radius,
                     ((far + near) * w - 2 * far * one) / (far - near), w])
    return clip, np.append(-y, radius), near, far, reach, 1 + np.abs(slopes).max()


def clip_errors(random):
    """Misplacement of each kind of plane, in U times what the volume's growth scales with."""
    volume = random_wedge(random)
    if volume is None:
        return {}
    clip, user, near, far, reach, slant = volume
    user_in_clip = user @ np.linalg.inv(clip)
    planes = {'side': (clip[3] - clip[0], slant), 'near': (clip[3] + clip[2], 1.0),
              'far': (clip[3] - clip[2], far / near), 'user': (user, slant)}
    errors = {}
    for name, (plane, share) in planes.items():
        length = np.linalg.norm(plane[:3])
        points = random.uniform(-1, 1, size=(POINTS, 3)) * reach
        points -= np.outer(points @ plane[:3] + plane[3], plane[:3]) / length**2
        x, _, z, w = rows = [dot32(row, points) for row in clip]
        value = {'side': w.astype(float) - x, 'near': w.astype(float) + z,
                 'far': w.astype(float) - z,
                 'user': dot32(user_in_clip, np.stack(rows, 1))}[name]
        counts = np.abs(points).max(1) <= reach
        if name == 'user':  # the frustum's own planes cut off what lies outside of them
            counts &= (np.abs(x) <= 1.01 * w) & (np.abs(z) <= 1.01 * w)
        errors[name] = np.abs(value[counts]).max(initial=0.0) / length / share / reach / U
    return errors


def draw():
    random = np.random.default_rng(1)
    figure, (codes, clip) = style.panels(2, 3.4, [1, 1.8])
    measured = [max(outcode_error(random, moving) for _ in range(TRIALS))
                for moving in (False, True)]
    draw_bars(codes, ['at rest', 'moving'], [8, 16], [4, 11], measured)
    codes.set_title('Outcodes', color=style.TEXT)
    codes.set_ylabel('2⁻²⁴ times the sum of |coordinates|')
    worst = {'side': 0.0, 'near': 0.0, 'far': 0.0, 'user': 0.0}
    for _ in range(TRIALS):
        for name, error in clip_errors(random).items():
            worst[name] = max(worst[name], error)
    plane = 1e-6 / U
    draw_bars(clip, ['side planes\n(times slant)', 'near plane', 'far plane\n(times far / near)',
                     'user planes\n(times slant)'], [plane, plane, 16, plane],
              [14.4, 14.4, 14.4, 0], list(worst.values()))
    clip.set_title("GL's vertex transform and plane tests", color=style.TEXT)
    clip.set_ylabel('2⁻²⁴ times reach')
    clip.legend(frameon=False, ncol=3, loc='upper right')
    clip.set_ylim(0, 21)
    return figure


def draw_bars(axes, names, allowed, derived, measured):
    place = np.arange(len(names))
    axes.bar(place - 0.27, allowed, 0.25, color=style.BOUND, label='the code allows')
    axes.bar(place, derived, 0.25, color=style.GUIDE, label='derived')
    axes.bar(place + 0.27, measured, 0.25, color=style.FACE, label='measured')
    for x, value in zip(place + 0.27, measured):
        axes.text(x, value + 0.2, f'{value:.1f}', ha='center', color=style.FACE)
    axes.set_xticks(place)
    axes.set_xticklabels(names)
