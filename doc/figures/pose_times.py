"""When a shape finds the pose that it needs: poses only while the tool moves, and poses at all times."""

import style

SHAPES = [5 + 10 * i for i in range(10)]  # [ms]
TIMEOUT = 20                              # [ms] tf_timeout_sec
COLORS = {'OK': style.BOUND, 'NO_TRANSFORM': style.FACE, 'replaced': style.GUIDE}


def outcomes(poses):
    """(shape, what becomes of it, when). One shape waits; of those behind it, only the newest counts."""
    found, left = [], list(SHAPES)
    now = 0
    while left:
        shape = left.pop(0)
        now = max(now, shape)
        pose = min((pose for pose in poses if pose >= shape), default=1000)
        in_time = pose <= shape + TIMEOUT
        now = max(now, pose if in_time else shape + TIMEOUT)
        found.append((shape, 'OK' if in_time else 'NO_TRANSFORM', now))
        behind = [other for other in left if other <= now]
        for other in behind[:-1]:
            found.append((other, 'replaced', behind[behind.index(other) + 1]))
            left.remove(other)
    return sorted(found)


def draw_times(axes, title, poses):
    axes.set_title(title, color=style.TEXT, loc='left')
    for pose in poses:
        axes.plot(pose, 1, '|', color=style.TOOL, ms=14, mew=2)
    for shape, outcome, end in outcomes(poses):
        axes.plot([shape, end], [0, 0], color=COLORS[outcome], lw=1.4)
        axes.plot(shape, 0, 'o', color=COLORS[outcome], ms=6)
        place = (shape - 1, -1.25 if outcome == 'replaced' else -0.45)
        style.label(axes, place, outcome, COLORS[outcome], va='top')
    axes.set_yticks([1, 0])
    axes.set_yticklabels(['poses', 'shapes'])
    axes.set_ylim(-2.1, 1.6)
    axes.set_xlim(-3, 119)
    axes.spines['left'].set_visible(False)
    axes.tick_params(axis='y', length=0)


def draw():
    figure, axes = style.plt.subplots(2, 1, figsize=(style.WIDTH, 3.8), sharex=True)
    draw_times(axes[0], 'Poses only while the tool moves: it rests from 24 to 76 ms',
               [0, 8, 16, 24, 76, 84, 92, 100, 108, 116])
    draw_times(axes[1], 'The remedy: the same pose again, with a new stamp', list(range(0, 120, 8)))
    axes[1].set_xlabel('time [ms]. A line: how long a shape waits for a pose of its time or later')
    return figure
