"""How many steps the exact tests of one query may cost; the constants are those of WorkBudget."""

import numpy as np

import style

STEPS_FOR_EACH_PAIR, LEAST_PAIRS, MOST_PAIRS = 2, 1e5, 1e7


def draw():
    figure, (axes,) = style.panels(1, 3.6)
    pairs = np.logspace(2, 9, 300)
    axes.loglog(pairs, STEPS_FOR_EACH_PAIR * np.clip(pairs, LEAST_PAIRS, MOST_PAIRS),
                color=style.BOUND, lw=2)
    for faces, parts, legs, text, shift, side in (
            (1224, 1, 1, 'shaft, 1224 faces, one leg', (0, 8), 'center'),
            (1224, 1000, 1, 'two jaws of 500 triangles, 1224 faces, one leg', (-10, 0), 'right'),
            (1003520, 1, 100, 'shaft, 1 003 520 faces, 100 legs', (0, 8), 'right')):
        count = faces * parts * legs
        steps = STEPS_FOR_EACH_PAIR * np.clip(count, LEAST_PAIRS, MOST_PAIRS)
        axes.plot(count, steps, 'o', color=style.TOOL)
        axes.annotate(text, (count, steps), xytext=shift, textcoords='offset points',
                      color=style.TOOL, ha=side)
    seconds = axes.secondary_yaxis('right', functions=(lambda x: x * 1e-7, lambda x: x / 1e-7))
    seconds.set_ylabel('time at 0.1 µs for each step [s]')
    seconds.spines['right'].set_visible(True)
    for axis in (axes.xaxis, axes.yaxis, seconds.yaxis):
        axis.set_major_formatter(style.power_of_ten)
    axes.set_xlabel('pairs of a face and a convex part, summed over the legs')
    axes.set_ylabel('steps allowed')
    axes.set_ylim(5e4, 6e7)
    return figure
