"""Legs of a trembling hand: one chord with a deviation serves several of them."""

import numpy as np

import style

RADIUS = 0.16
ALLOWED = 0.25 * RADIUS


def waypoints():
    random = np.random.default_rng(7)
    fraction = np.linspace(0, 1, 17)
    way = np.stack([4 * fraction, 1.1 * np.maximum(fraction - 0.5, 0)], 1)
    return fraction, way + random.uniform(-0.02, 0.02, size=way.shape)


def deviation(fraction, way, begin, end):
    share = (fraction[begin:end + 1] - fraction[begin]) / (fraction[end] - fraction[begin])
    chord = way[begin] + share[:, None] * (way[end] - way[begin])
    return np.linalg.norm(way[begin:end + 1] - chord, axis=1).max()


def longest_span(fraction, way, begin):
    """All legs that are left, then half of them, and so on; as step.cpp."""
    legs = len(way) - 1 - begin
    while legs > 1 and deviation(fraction, way, begin, begin + legs) > ALLOWED:
        legs //= 2
    return begin + max(legs, 1)


def draw():
    figure, (axes,) = style.panels(1, 2.9)
    style.drawing(axes, 'Spans: one volume around each chord')
    fraction, way = waypoints()
    begin = 0
    while begin < len(way) - 1:
        end = longest_span(fraction, way, begin)
        found = deviation(fraction, way, begin, end)
        chord = way[[begin, end]]
        along = (chord[1] - chord[0]) / np.linalg.norm(chord[1] - chord[0])
        across = np.array([-along[1], along[0]])
        for reach, line in ((RADIUS, ':'), (RADIUS + found, '-')):
            for sign in (-1, 1):
                axes.plot(*(chord + sign * reach * across).T, line,
                          color=style.TOOL if line == ':' else style.BOUND, lw=1.3)
        axes.plot(*chord.T, '--', color=style.BOUND, lw=1.2)
        style.label(axes, chord.mean(0) + [0, 0.26],
                    f'{end - begin} legs' if end > begin + 1 else '1 leg', style.BOUND, ha='center')
        axes.plot(*np.stack([chord[1] - 0.3 * across, chord[1] + 0.3 * across]).T,
                  color=style.GUIDE, lw=0.7)
        begin = end
    axes.plot(*way.T, '-o', color=style.TEXT, lw=1, ms=3)
    style.label(axes, (0.3, -0.36), 'dots: waypoints;  dashed: chord;  dotted: the part\'s radius '
                'about the chord;  solid: radius + deviation', style.TEXT)
    axes.set_ylim(-0.4, 1.0)
    return figure
