#!/usr/bin/python3
"""Draws trial_report.png from a bag of the demo, as trial_report.py shows its palpator, and sculpt.png from the clay that
sculpt.launch has carved.

Usage: doc/figures/trials.py demo.bag clay.npz, after ./run_demo --seconds 20 --record demo.bag, . devel/setup.bash, and
roslaunch organ_collision sculpt.launch save:=$PWD/clay.npz
"""

import importlib.machinery
import os
import sys

from matplotlib.text import Text
import numpy as np
from organ_collision.recordings import read_bag
from organ_collision.trial import Trial
from organ_collision.trial_plots import draw

import style

HERE = os.path.dirname(os.path.abspath(__file__))
TOOL, COLOURS = 'palpator', {'kept': '#d8f0dc', 'broken': '#f8d3cf', 'unknown': '#f3ecc8'}
CLAY, LIGHT = '#c98f6b', style.plt.matplotlib.colors.LightSource(315, 35)


def report_figure(bag):
    program = importlib.machinery.SourceFileLoader('trial_report', HERE + '/../../scripts/trial_report.py').load_module()
    trial, limits = Trial(tips={}), list(program.read_limits(HERE + '/../../examples/limits.yaml'))
    read_bag(bag, trial)
    report = program.Report('demo', trial, limits, [])
    figure = style.plt.figure(figsize=(style.WIDTH, 4.6), constrained_layout=True)
    head, plots = figure.subfigures(2, 1, height_ratios=(1, 3))
    axes = head.subplots()
    axes.axis('off')
    axes.set_title(report.headline, backgroundcolor=COLOURS[report.state], fontsize=12, pad=12)
    rows = [(row['limit'], row['state'], row['worst'] or '') for row in report.verdicts]
    cells = axes.table(rows, [[COLOURS[state]] * 3 for _, state, _ in rows], colLabels=('limit', 'state', 'worst'),
                       loc='center', cellLoc='left', colWidths=(0.55, 0.15, 0.25))
    cells.scale(1, 1.3)
    draw(plots, trial, TOOL, report.start, report.paths[TOOL].speed, [('force', legal) for key, legal, _, _ in limits
                                                                     if key == 'max_force'])
    cells.auto_set_font_size(False)
    for text in plots.findobj(Text) + cells.findobj(Text):
        text.set_fontsize(9)
    style.save_picture(figure, HERE + '/trial_report.png')


def clay_figure(clay):
    vertices, faces = 1e3 * clay['vertices'], clay['faces']
    figure = style.plt.figure(figsize=(5, 3.4))
    axes = figure.add_axes((-0.06, -0.32, 1.12, 1.64), projection='3d', box_aspect=np.ptp(vertices, axis=0))
    axes.plot_trisurf(*vertices[:, :2].T, faces, vertices[:, 2], color=CLAY, lightsource=LIGHT, antialiased=False)
    axes.axis('off')
    axes.view_init(50, -70)
    figure.savefig(HERE + '/sculpt.png', dpi=160, metadata={'Software': None}, pil_kwargs={'optimize': True})


if __name__ == '__main__':
    report_figure(sys.argv[1])
    clay_figure(np.load(sys.argv[2]))
