"""Plots of a tool over time: of a whole trial, or of its last seconds."""

import itertools

import numpy as np

# Of a series: its name, what it is, and how much larger its numbers are than in SI units.
SERIES = (('depth', 'depth [mm]', 1e3), ('distance', 'distance [mm]', 1e3), ('force', 'force [N]', 1.0),
          ('speed', 'speed of tip [mm/s]', 1e3))
COLOURS = ('#1f5fa8', '#b8442c', '#2d7d46', '#8a4fa3', '#b07d12', '#3a9a9a')


def draw(figure, trial, tool, start, speed=None, limits=()):
    """Draws what a trial knows of a tool: a line for each organ, and its touches as bands of the same colour.

    start   the time that the plots call 0 [s]
    speed   the series of the speed of its tip, if it is to be shown
    limits  [(name of a series, legal value)]
    """
    pairs = sorted((pair for pair in trial.pairs.values() if pair.tool == tool), key=lambda pair: pair.organ)
    colours = dict(zip((pair.organ for pair in pairs), itertools.cycle(COLOURS)))
    lines = {name: [(pair.organ, pair.series[name]) for pair in pairs if name in pair.series] for name, _, _ in SERIES}
    lines['speed'] = [('', speed)] if speed else []
    shown = [row for row in SERIES if lines[row[0]]] or SERIES[:1]
    figure.clear()
    for axes, (name, text, scale) in zip(figure.subplots(len(shown), 1, sharex=True, squeeze=False)[:, 0], shown):
        for organ, series in lines[name]:
            times, low, high = series.points()
            gaps = np.flatnonzero(np.diff(times) > max(0.1, 3 * series.width)) + 1  # The line ends where nothing is known.
            for part in np.split(np.arange(len(times)), gaps):
                look = {'color': colours.get(organ, '#555555'), 'lw': 0.8}
                axes.plot(times[part] - start, scale * high[part], '.' if len(part) == 1 else '-', ms=2, **look)
                axes.fill_between(times[part] - start, scale * low[part], scale * high[part], alpha=0.3, **{**look, 'lw': 0})
        for pair in pairs:
            bands = list(zip((touch.begin - start for touch in pair.touches), pair.touch_sec()))
            axes.broken_barh(bands, (0, 1), transform=axes.get_xaxis_transform(), color=colours[pair.organ], alpha=0.13)
        for value in {value for limited, value in limits if limited == name}:
            axes.axhline(scale * value, ls='--', color='#c02020', lw=0.8)
        axes.set_ylabel(text, fontsize=8)
        axes.tick_params(labelsize=8)
        axes.grid(alpha=0.25)
    axes.set_xlabel('time [s]', fontsize=8)
    for organ, colour in colours.items():
        figure.axes[0].plot([], [], color=colour, label=organ)
    figure.axes[0].set_title(tool, fontsize=9)
    if pairs:
        figure.axes[0].legend(loc='upper right', fontsize=7)
    figure.align_ylabels()
