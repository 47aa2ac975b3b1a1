#!/usr/bin/python3
"""Writes tables and a plot of collision_benchmark's results.

Usage: report.py FOLDER. Reads FOLDER/benchmarks.json, writes FOLDER/benchmarks.md and FOLDER/benchmarks.png."""

import json
import pathlib
import sys

import matplotlib

matplotlib.use('Agg')
from matplotlib import pyplot  # noqa: E402

ENGINES = ['ours', 'ours_egl', 'cpu', 'ours_no_clusters', 'select_paper', 'scan', 'bullet', 'bullet_gimpact', 'embree',
           'fcl', 'cgal', 'vertex_pass', 'memcpy']
PARTS = ['step', 'update', 'static', 'swept', 'static_rigid', 'swept_rigid']
CONTACT_PARTS = ['contacts', 'step_contacts', 'contacts_moving', 'step_moving']

WHERE = {'ours': 'ours: contacts, clearance up to 20 mm, placement',
         'ours_unlimited': 'ours_unlimited: contacts, clearance without a limit, placement',
         'ours_near': 'ours_near: contacts, 100 faces within 20 mm', 'fcl': 'fcl: distance of the shaft',
         'embree': 'embree: distance of the tip up to 20 mm', 'cgal': 'cgal: side of the tip'}

PROXY = {'proxy_slide': 'trocar, organ rests', 'proxy_slide_moving': 'trocar', 'proxy_flight_moving': 'trocar, free flight',
         'proxy_shaft_moving': 'free shaft', 'proxy_ball_moving': 'free ball', 'proxy_grasper_moving': 'free grasper'}


class Results:
    """Medians in microseconds, counters, and medians of counters, by (part, engine, faces, shuffled): see
    cases/registration.hpp."""

    def __init__(self, path):
        self.median, self.counters, self.median_counters = {}, {}, {}
        data = json.loads(path.read_text())
        self.context = data['context']
        for run in data['benchmarks']:
            part, engine, faces, *order = run['run_name'].split('/')
            key = part, engine, int(faces), bool(order)
            if run['run_type'] == 'iteration':
                self.counters[key] = run
            if run.get('aggregate_name') == 'median' or run['repetitions'] == 1:
                self.median[key] = run['real_time']
                self.median_counters[key] = run
        self.sizes = sorted({faces for _, _, faces, _ in self.median})

    def engines(self, part, shuffled=False):
        found = {engine for p, engine, _, s in self.median if (p, s) == (part, shuffled)}
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
    rows = [[engine] + [microseconds(results.median.get((part, engine, faces, shuffled)))
                        for faces in results.sizes]
            for engine in results.engines(part, shuffled)]
    return table([f'{part}, µs'] + results.sizes, rows)


def ratio(results, part, over, under, faces, shuffled=False):
    a = results.median.get((part, over, faces, shuffled))
    b = results.median.get((part, under, faces, shuffled))
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
                time, count = results.median[key], results.counters[key]['contacts']
                row.append(f'{count:.1f}' if unit == 'contacts' else
                           microseconds(time if unit == 'µs' else time / count if count else None))
            if unit != 'µs a contact' or part.startswith('contacts'):
                rows.append(row)
    return table(['with full geometry'] + results.sizes, rows)


def grasper_table(results):
    """A shaft, a wrist and two jaws of 500 faces each, against the resting organ of 1224 faces."""
    static = {engine: results.median.get(('grasper_static', engine, 1224, False)) for engine in ('ours', 'fcl')}
    swept = results.median.get(('grasper_swept', 'ours', 1224, False))
    rows = [['ours', microseconds(static['ours']), microseconds(swept)], ['fcl', microseconds(static['fcl']), ''],
            ['fcl / ours', f"{static['fcl'] / static['ours']:.1f}", '']]
    return table(['a shaft and three links', 'static, µs', 'swept, µs'], rows)


def where_table(results):
    """A new shape, and where the tool is then. A peer tells only a part of that."""
    sizes = [faces for faces in results.sizes if ('where', 'ours', faces, False) in results.median]
    rows = [[what] + [microseconds(results.median.get(('where', engine, faces, False))) for faces in sizes]
            for engine, what in WHERE.items()]
    rows += [[f'{engine} / ours'] + [ratio(results, 'where', engine, 'ours', faces) for faces in sizes]
             for engine in ('ours_unlimited', 'fcl', 'embree', 'cgal')]
    wrong = sum(results.counters['where', engine, faces, False]['wrong'] for engine in WHERE for faces in sizes)
    return table(['where the tool is, µs'] + sizes, rows) + f'\nWrong answers in all: {wrong:.0f}.\n'


def proxy_table(results):
    """A tick of a haptic proxy. The penalty law needs at least one swept query a tick."""
    rows = []
    for part, what in PROXY.items():
        for faces in results.sizes:
            ours, penalty = (results.median_counters.get((part, engine, faces, False)) for engine in ('ours', 'penalty'))
            if ours:
                rows.append([f'{what}, {faces} faces'] + [microseconds(ours[name]) for name in ('median', 'p99', 'p99_9')]
                            + [microseconds(ours['update']) if ours['update'] else '', microseconds(penalty['median']),
                               f"{ours['median'] / penalty['median']:.1f}", f"{ours['contacts']:.1f}"])
    return table(['a tick, µs', 'median', '99th percentile', '99.9th percentile', 'move_vertices, median',
                  'one swept query, median', 'ratio', 'contacts'], rows)


def error_table(results):
    rows = []
    for engine in ENGINES:
        row = [engine]
        for faces in results.sizes:
            for shuffled in (False, True):
                run = results.counters.get(('step', engine, faces, shuffled))
                row.append(f"{run['missed']:.0f} / {run['wrong']:.0f}" if run and 'missed' in run else '')
        if any(row[1:]):
            rows.append(row)
    head = ['missed / wrongly found']
    for faces in results.sizes:
        head += [faces, f'{faces} shuffled']
    return table(head, rows)


def paper_table(results):
    """The comparison of the paper's figures 11 and 12, on an organ with as many faces as its liver (1224)."""
    def of(part, engine):
        return results.median.get((part, engine, 1224, False), 0.0)

    rows = []
    for engine in results.engines('static'):
        deforming = [of('update', engine) + of(part, engine) for part in ('static', 'swept')]
        ours = [of('update', 'ours') + of(part, 'ours') for part in ('static', 'swept')]
        rigid = [of(part, engine) for part in ('static_rigid', 'swept_rigid')]
        ours_rigid = [of(part, 'ours') for part in ('static_rigid', 'swept_rigid')]
        rows.append([engine, microseconds(of('update', engine))]
                    + [microseconds(value) for value in rigid + deforming]
                    + [f'{a / b:.1f}' for a, b in zip(rigid + deforming, ours_rigid + ours)])
    return table(['1224 faces', 'precomputation, µs', 'static, µs', 'dynamic, µs', 'static with it, µs', 'dynamic with it, µs',
                  'static / ours', 'dynamic / ours', 'static with it / ours', 'dynamic with it / ours'], rows)


def machine(context):
    model = next((line.split(':')[1].strip() for line in pathlib.Path('/proc/cpuinfo').read_text().splitlines()
                  if line.startswith('model name')), 'unknown processor')
    load = ' '.join(f'{value:.2f}' for value in context['load_avg'])
    return f"{model}, {context['num_cpus']} cores, load {load} at the start, {context['date']}\n"


def write_table(results, path):
    hits = [f"{results.counters[('step', 'ours', faces, False)]['hits']:.1f}" for faces in results.sizes]
    text = ['# Benchmarks\n', machine(results.context),
            'Medians over repetitions. A step: a new shape, a static query, a swept query.\n',
            table(['faces'] + results.sizes, [['hit by a query'] + hits]),
            '## Ratios\n', ratio_table(results, False), 'Vertices and faces in random order:\n', ratio_table(results, True),
            '## Times\n', *(part_table(results, part, False) for part in PARTS),
            'Vertices and faces in random order:\n', *(part_table(results, part, True) for part in PARTS),
            '## Contacts with full geometry\n', contact_table(results),
            '## Where the tool is\n', where_table(results),
            '## A haptic proxy\n', proxy_table(results),
            '## A grasper\n', grasper_table(results),
            "## The paper's figures 11 and 12\n", paper_table(results),
            '## Answers against the oracle, in all steps together\n', error_table(results)]
    path.write_text('\n'.join(text))


def plot(results, path):
    figure, axes = pyplot.subplots(1, 2, figsize=(13, 5.5), sharey=True)
    for axis, shuffled in zip(axes, (False, True)):
        for engine in results.engines('step', shuffled):
            points = [(faces, results.median[key]) for faces in results.sizes
                      if (key := ('step', engine, faces, shuffled)) in results.median]
            axis.plot(*zip(*points), marker='o', label=engine, linewidth=3 if engine == 'ours' else 1.2,
                      linestyle=':' if engine in ('vertex_pass', 'memcpy') else '-')
        axis.set(xscale='log', yscale='log', xlabel='faces',
                 title='vertices in random order' if shuffled else 'vertices in coherent order')
        axis.grid(alpha=0.3)
    axes[0].set_ylabel('µs a step: new shape, static and swept query')
    axes[0].legend(fontsize='small')
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def main():
    folder = pathlib.Path(sys.argv[1])
    results = Results(folder / 'benchmarks.json')
    write_table(results, folder / 'benchmarks.md')
    plot(results, folder / 'benchmarks.png')


if __name__ == '__main__':
    main()
