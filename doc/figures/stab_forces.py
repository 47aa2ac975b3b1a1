"""What a hand feels that stabs through tissue: by the penalty force, and by a haptic proxy."""

import csv
import os

import matplotlib.pyplot as plt

import style

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'stab_forces.csv')
TITLES = {'sheet': 'A sheet, and a shaft that comes from its side',
          'lobe': 'The left lobe of the demo\'s liver'}


def rows_of(tissue):
    """Columns of the file: time [ms], way of the hand [mm], both forces [N]."""
    with open(DATA, encoding='utf-8') as rows:
        kept = [row for row in csv.DictReader(rows) if row['tissue'] == tissue]
    return [[float(row[name]) for row in kept] for name in ('time_ms', 'way_mm', 'penalty_n', 'proxy_n')]


def draw_stab(above, below, tissue):
    time, way, penalty, proxy = rows_of(tissue)
    surface = next(way for way, force in zip(way, proxy) if force > 0)
    above.plot(time, [surface - x for x in way], color=style.TOOL, lw=1.8)
    above.axhline(0, color=style.FACE, lw=1.5)
    above.text(100, 1, 'first touch', color=style.FACE, ha='center', va='bottom')
    above.set_title(TITLES[tissue], color=style.TEXT)
    below.plot(time, proxy, color=style.BOUND, lw=2)
    below.plot(time, penalty, color=style.FACE, lw=1.5)
    below.axhline(0, color=style.GUIDE, lw=0.6)
    below.set_xlabel('time [ms]')


def draw():
    figure, ((depth, other_depth), (force, other_force)) = plt.subplots(
        2, 2, figsize=(style.WIDTH, 4.8), sharex='col', sharey='row', gridspec_kw={'height_ratios': [1, 1.6]})
    draw_stab(depth, force, 'sheet')
    draw_stab(other_depth, other_force, 'lobe')
    depth.set_ylabel('height of the\nhand [mm]')
    force.set_ylabel('force out of the tissue [N]')
    style.label(force, (100, 10.6), 'proxy: 300 N/m × depth', style.BOUND, ha='center')
    style.label(force, (100, 0.5), 'penalty force:\nthe shaft is\nthrough, no force', style.FACE, ha='center')
    force.annotate('pushed out on\nthe wrong side', (158, -0.9), xytext=(120, -3.6), color=style.FACE,
                   ha='center', arrowprops={'arrowstyle': '-', 'color': style.FACE})
    force.set_ylim(-4.2, 19)
    return figure
