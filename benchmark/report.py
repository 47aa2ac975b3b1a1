#!/usr/bin/python3
"""Writes tables and a plot of collision_benchmark's results.

Usage: report.py FOLDER. Reads FOLDER/benchmarks.json, writes FOLDER/benchmarks.md and FOLDER/benchmarks.png."""

import json
import math
import pathlib
import sys

import matplotlib

matplotlib.use('Agg')
from matplotlib import pyplot, ticker  # noqa: E402

ENGINES = ['ours', 'ours_egl', 'cpu', 'select_paper', 'scan', 'bullet', 'bullet_gimpact', 'embree',
           'fcl', 'fcl_obb', 'fcl_obb_rebuilt', 'cgal', 'vertex_pass', 'memcpy']
PARTS = ['step', 'update', 'static', 'swept', 'static_rigid', 'swept_rigid']
CONTACT_PARTS = ['contacts', 'step_contacts', 'contacts_moving', 'step_moving']

WHERE = {'ours': 'ours: contacts, clearance up to 20 mm, placement',
         'ours_near': 'ours_near: contacts, 100 faces within 20 mm', 'fcl': 'fcl: distance of the shaft',
         'embree': 'embree: distance of the tip up to 20 mm', 'cgal': 'cgal: side of the tip'}

# What the plot shows of a step, in words. The engines that are left out are variants of ours.
PLOTTED = {'ours': 'this package', 'select_paper': 'the 1999 paper', 'scan': 'all vertices tested', 'bullet': 'Bullet',
           'bullet_gimpact': 'Bullet GImpact', 'embree': 'Embree', 'fcl': 'FCL', 'cgal': 'CGAL',
           'vertex_pass': 'all vertices read', 'memcpy': 'all vertices copied'}
ORDERS = {False: 'Neighbouring vertices are near each other in memory', True: 'Vertices and faces are in random order'}
LEAST_PLOTTED = 1000  # [faces]
LABEL_GAP = 0.055     # the least distance of two labels, as a share of the height of the plot


class Results:
    """Of each (part, engine, faces, shuffled), see case_name() in cases/cases.hpp: its fastest repetition, with its counters, and
    the time of this in microseconds. What else runs on a machine only makes repetitions slower."""

    def __init__(self, path):
        self.fastest = {}
        data = json.loads(path.read_text())
        self.context = data['context']
        for run in data['benchmarks']:
            part, engine, faces, *order = run['run_name'].split('/')
            key = part, engine, int(faces), bool(order)
            if run['run_type'] == 'iteration':
                self.fastest[key] = min(run, self.fastest.get(key, run), key=lambda one: one['real_time'])
        self.time = {key: run['real_time'] for key, run in self.fastest.items()}
        self.sizes = sorted({faces for _, _, faces, _ in self.time})

    def engines(self, part, shuffled=False):
        found = {engine for p, engine, _, s in self.time if (p, s) == (part, shuffled)}
        return [engine for engine in ENGINES if engine in found]


def microseconds(value):
    if value is None:
        return ''
    return f'{value:.2f}' if value < 10 else f'{value:.1f}' if value < 100 else f'{value:,.0f}'.replace(',', ' ')


def table(head, rows):
    lines = ['| ' + ' | '.join(str(cell) for cell in head) + ' |', '|---' * len(head) + '|']
    lines += ['| ' + ' | '.join(str(cell) for cell in row) + ' |' for row in rows]
    return '\n'.join(lines) + '\n'


def part_table(results, part, shuffled):
    rows = [[engine] + [microseconds(results.time.get((part, engine, faces, shuffled)))
                        for faces in results.sizes]
            for engine in results.engines(part, shuffled)]
    return table([f'{part}, µs'] + results.sizes, rows)


def ratio(results, part, over, under, faces, shuffled=False):
    a = results.time.get((part, over, faces, shuffled))
    b = results.time.get((part, under, faces, shuffled))
    return f'{a / b:.1f}' if a and b else ''


def ratio_table(results, shuffled):
    rows = [[f'{engine} / ours'] + [ratio(results, 'step', engine, 'ours', faces, shuffled)
                                    for faces in results.sizes]
            for engine in results.engines('step', shuffled) if engine not in ('ours', 'vertex_pass', 'memcpy')]
    rows += [[f'ours / {name}'] + [ratio(results, 'step', 'ours', name, faces, shuffled)
                                   for faces in results.sizes] for name in ('vertex_pass', 'memcpy')]
    return table(['step'] + results.sizes, rows)


def contact_table(results):
    rows = []
    for part in CONTACT_PARTS:
        for unit in ('µs', 'contacts', 'µs a contact'):
            row = [f'{part}, {unit}']
            for faces in results.sizes:
                key = part, 'ours', faces, False
                time, count = results.time[key], results.fastest[key]['contacts']
                row.append(f'{count:.1f}' if unit == 'contacts' else
                           microseconds(time if unit == 'µs' else time / count if count else None))
            if unit != 'µs a contact' or part.startswith('contacts'):
                rows.append(row)
    return table(['with full geometry'] + results.sizes, rows)


def grasper_table(results):
    """A shaft, a wrist and two jaws of 500 faces each, against the resting organ of 1224 faces."""
    static = {engine: results.time.get(('grasper_static', engine, 1224, False)) for engine in ('ours', 'fcl')}
    swept = results.time.get(('grasper_swept', 'ours', 1224, False))
    rows = [['ours', microseconds(static['ours']), microseconds(swept)], ['fcl', microseconds(static['fcl']), ''],
            ['fcl / ours', f"{static['fcl'] / static['ours']:.1f}", '']]
    return table(['a shaft and three links', 'static, µs', 'swept, µs'], rows)


def where_table(results):
    """A new shape, and where the tool is then. A peer tells only a part of that."""
    sizes = [faces for faces in results.sizes if ('where', 'ours', faces, False) in results.time]
    rows = [[what] + [microseconds(results.time.get(('where', engine, faces, False))) for faces in sizes]
            for engine, what in WHERE.items()]
    rows += [[f'{engine} / ours'] + [ratio(results, 'where', engine, 'ours', faces) for faces in sizes]
             for engine in ('fcl', 'embree', 'cgal')]
    wrong = sum(results.fastest['where', engine, faces, False]['wrong'] for engine in WHERE for faces in sizes)
    return table(['where the tool is, µs'] + sizes, rows) + f'\nWrong answers in all: {wrong:.0f}.\n'


def error_table(results):
    rows = []
    for engine in ENGINES:
        row = [engine]
        for faces in results.sizes:
            for shuffled in (False, True):
                run = results.fastest.get(('step', engine, faces, shuffled))
                row.append(f"{run['missed']:.0f} / {run['wrong']:.0f}" if run and 'missed' in run else '')
        if any(row[1:]):
            rows.append(row)
    head = ['missed / wrongly found']
    for faces in results.sizes:
        head += [faces, f'{faces} shuffled']
    return table(head, rows)


def paper_table(results, faces):
    """The comparison of the paper's figures 11 and 12. The organ of 1224 faces has as many as the paper's liver; that of 4 is a
    tetrahedron."""
    def times(engine):
        update, static, swept, *rigid = (results.time.get((part, engine, faces, False), 0.0) for part in
                                         ('update', 'static', 'swept', 'static_rigid', 'swept_rigid'))
        return [update, *rigid, update + static, update + swept]

    what = ['static', 'dynamic', 'static with it', 'dynamic with it']
    peers = {engine: times(engine) for engine in ('ours', 'select_paper')}
    rows = [[engine] + [microseconds(value) for value in times(engine)]
            + [f'{a / b:.2f}' for peer in peers.values() for a, b in zip(times(engine)[1:], peer[1:])]
            for engine in results.engines('static')]
    return table([f'{faces} faces', 'precomputation, µs'] + [f'{name}, µs' for name in what]
                 + [f'{name} / {peer}' for peer in peers for name in what], rows)


def machine(context):
    model = next((line.split(':')[1].strip() for line in pathlib.Path('/proc/cpuinfo').read_text().splitlines()
                  if line.startswith('model name')), 'unknown processor')
    load = ' '.join(f'{value:.2f}' for value in context['load_avg'])
    return f"{model}, {context['num_cpus']} cores, load {load} at the start, {context['date']}\n"


def write_table(results, path):
    hits = [f"{results.fastest[('step', 'ours', faces, False)]['hits']:.1f}" for faces in results.sizes]
    text = ['# Benchmarks\n', machine(results.context),
            'The fastest repetition of each. A step: a new shape, a static query, a swept query.\n',
            table(['faces'] + results.sizes, [['hit by a query'] + hits]),
            '## Ratios\n', ratio_table(results, False), 'Vertices and faces in random order:\n', ratio_table(results, True),
            '## Times\n', *(part_table(results, part, False) for part in PARTS),
            'Vertices and faces in random order:\n', *(part_table(results, part, True) for part in PARTS),
            '## Contacts with full geometry\n', contact_table(results),
            '## Where the tool is\n', where_table(results),
            '## A grasper\n', grasper_table(results),
            "## The paper's figures 11 and 12\n", paper_table(results, 1224), paper_table(results, 4),
            '## Answers against the oracle, in all steps together\n', error_table(results)]
    path.write_text('\n'.join(text))


def duration(value, _=None):
    """Of a value in microseconds."""
    for unit, size in (('s', 1e6), ('ms', 1e3), ('µs', 1.0)):
        if value >= size:
            return f'{value / size:g} {unit}'
    return f'{1e3 * value:g} ns'


def apart(places, gap):
    """The same places in the same order, moved up where they are nearer to each other than `gap`."""
    moved = []
    for place in sorted(places):
        moved.append(max(place, moved[-1] + gap) if moved else place)
    excess = [after - before for before, after in zip(sorted(places), moved)]
    return [place - 0.5 * max(excess) for place in moved]


def plot_steps(axis, results, shuffled):
    """A line for each engine, with its name at its end."""
    ends = {}
    for number, engine in enumerate(engine for engine in PLOTTED if engine in results.engines('step', shuffled)):
        points = [(faces, results.time[key]) for faces in results.sizes
                  if faces >= LEAST_PLOTTED and (key := ('step', engine, faces, shuffled)) in results.time]
        ours, bound = engine == 'ours', engine in ('vertex_pass', 'memcpy')
        colour = '#1f5fa8' if ours else '#777777' if bound else f'C{(1, 2, 3, 4, 5, 6, 8)[(number - 1) % 7]}'
        axis.plot(*zip(*points), 'o:' if bound else 'o-', markersize=4, color=colour, linewidth=3.5 if ours else 1.6)
        ends[points[-1]] = PLOTTED[engine], colour, 'bold' if ours else 'normal'
    axis.set(xscale='log', yscale='log', title=ORDERS[shuffled])
    axis.xaxis.set_major_formatter(lambda value, _: f'{value:,.0f}'.replace(',', ' '))
    axis.yaxis.set_major_formatter(duration)
    axis.yaxis.set_major_locator(ticker.LogLocator(numticks=12))
    axis.grid(alpha=0.3)
    low, high = (math.log10(limit) for limit in axis.get_ylim())
    last = max(faces for faces, _ in ends)
    ending = sorted((point for point in ends if point[0] == last), key=lambda point: point[1])
    heights = apart([(math.log10(time) - low) / (high - low) for _, time in ending], LABEL_GAP)
    for point, height in zip(ending, heights):
        text, colour, weight = ends.pop(point)
        axis.annotate(text, point, (1.03, height), textcoords='axes fraction', va='center', color=colour, weight=weight,
                      arrowprops={'arrowstyle': '-', 'color': colour, 'linewidth': 0.6, 'shrinkA': 0})
    for point, (text, colour, weight) in ends.items():
        axis.annotate(text, point, (4, 7), textcoords='offset points', ha='right', color=colour, weight=weight)


def plot(results, path):
    pyplot.rcParams.update({'font.size': 9.5, 'axes.titlesize': 10.5})
    figure, axes = pyplot.subplots(2, 1, figsize=(8, 9), sharex=True)
    for axis, shuffled in zip(axes, ORDERS):
        plot_steps(axis, results, shuffled)
        axis.set_ylabel('time of a step')
    axes[1].set_xlabel('faces of the organ')
    figure.suptitle('Time to find the touched faces: a new shape, one static and one swept query', fontsize=12)
    figure.tight_layout()
    figure.savefig(path, dpi=200)


def main():
    folder = pathlib.Path(sys.argv[1])
    results = Results(folder / 'benchmarks.json')
    write_table(results, folder / 'benchmarks.md')
    plot(results, folder / 'benchmarks.png')


if __name__ == '__main__':
    main()
