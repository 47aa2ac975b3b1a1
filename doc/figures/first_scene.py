"""The first scene of doc/getting_started.md: which program sends which topic, and the frames of the probe."""

import matplotlib.pyplot as plt
import numpy as np

import style
from shaft_view import RADIUS, draw_shaft

TROCAR, TIP = np.array([0.0, 100.0]), np.array([-12.0, 3.0])  # [mm], as in examples/simulator.py
SIDE = 100.0                                                  # [mm] of the sheet


def box(axes, low, high, text, color):
    low, high = np.array(low, float), np.array(high, float)
    axes.add_patch(plt.Rectangle(low, *(high - low), fc=color, alpha=0.13, lw=0))
    axes.add_patch(plt.Rectangle(low, *(high - low), fill=False, ec=color, lw=1.4))
    style.label(axes, 0.5 * (low + high), text, color, ha='center', va='center')


def topic(axes, start, end, text, color):
    style.arrow(axes, start, end, color, width=1.6)
    middle = 0.5 * (np.array(start, float) + end)
    style.label(axes, middle + [0, 3], text, color, ha='center', va='bottom')


def draw_topics(axes):
    style.drawing(axes, 'Topics (all but /tf begin with /organ_collision/)')
    box(axes, (0, 0), (118, 178), 'simulator.py\n\nsends tissue\nand frames,\nprints contacts', style.FACE)
    box(axes, (268, 0), (386, 178), 'organ_collision\n\nthe node;\nknows the tools\nfrom tools.yaml', style.TOOL)
    box(axes, (492, 110), (590, 178), 'RViz', style.TEXT)
    box(axes, (492, 0), (590, 68), 'rostopic echo', style.TEXT)
    for height, text in ((148, 'organ_mesh: once'), (108, 'organ_vertices: 100 Hz'), (68, '/tf: 100 Hz')):
        topic(axes, (122, height), (264, height), text, style.FACE)
    topic(axes, (264, 24), (122, 24), 'contacts', style.TOOL)
    topic(axes, (390, 144), (488, 144), 'markers', style.TOOL)
    topic(axes, (390, 34), (488, 34), 'contacts', style.TOOL)
    axes.set_xlim(-2, 592)
    axes.set_ylim(-2, 180)


def draw_tree(axes):
    style.drawing(axes, 'Frames in TF')
    box(axes, (60, 90), (180, 126), 'tissue', style.FACE)
    box(axes, (0, 10), (112, 46), 'probe_trocar', style.TOOL)
    box(axes, (128, 10), (240, 46), 'probe_tip', style.TOOL)
    style.arrow(axes, (105, 88), (62, 48), style.GUIDE, width=1.4)
    style.arrow(axes, (135, 88), (178, 48), style.GUIDE, width=1.4)
    axes.set_xlim(-5, 245)
    axes.set_ylim(0, 150)


def draw_frame(axes, place):
    for way, color in (((16, 0), style.FACE), ((0, 16), style.BOUND)):
        style.arrow(axes, place, np.add(place, way), color, width=1.6)
    axes.plot(*place, 'o', color=style.TEXT, ms=4)


def draw_probe(axes):
    style.drawing(axes, 'Where they are')
    x = np.linspace(-0.5 * SIDE, 0.5 * SIDE, 100)
    axes.plot(x, np.sin(0.05 * x), color=style.FACE, lw=2.5)  # the wave of 1 mm
    draw_shaft(axes, TROCAR, TIP)
    for place in ((0.0, 0.0), TROCAR, TIP):
        draw_frame(axes, place)
    style.label(axes, TROCAR + [22, 0], 'probe_trocar, 0.1 m above the tissue', style.TOOL, va='center')
    style.label(axes, TIP + [-10, 9], 'probe_tip,\nit moves', style.TOOL, ha='right', va='bottom')
    style.label(axes, (22, 5), 'tissue, the frame of the sheet', style.FACE, va='bottom')
    middle = 0.5 * (TROCAR + TIP)
    style.label(axes, middle + [2 * RADIUS, 0], 'probe, radius 5 mm', style.TOOL, va='center')
    axes.set_xlim(-58, 135)
    axes.set_ylim(-8, 120)


def draw():
    figure, axes = plt.subplot_mosaic([['topics', 'topics'], ['tree', 'probe']], figsize=(style.WIDTH, 5.4),
                                      gridspec_kw={'height_ratios': [1, 0.85], 'width_ratios': [0.72, 1]})
    draw_topics(axes['topics'])
    draw_tree(axes['tree'])
    draw_probe(axes['probe'])
    return figure
