"""The tables of the end-to-end measurements."""

from shapes import TOOLS, echo_of
from subject import ECHO

WHAT = {'shapes': 'shape to contacts', 'poses': 'pose to wrench'}
LATENCY_HEAD = ('median, µs', '99th percentile', '99.9th percentile', 'worst')


def table(head, rows):
    lines = ['| ' + ' | '.join(map(str, head)) + ' |', '|' + '---|' * len(head)]
    lines += ['| ' + ' | '.join(map(str, row)) + ' |' for row in rows]
    return '\n'.join(lines) + '\n'


def whole(value):
    """A number without decimals; empty for None."""
    return '' if value is None else f'{value:.0f}'


def latencies(report):
    return tuple(whole(report[key]) for key in ('median', 'p99', 'p999', 'worst'))


def name(report):
    return report['kind'] + (f" ({report['workspace']})" if report['workspace'] else '')


def latency_table(reports):
    head = ('', 'faces', 'tools', 'rate, Hz', 'held', 'sent', 'skipped', *LATENCY_HEAD)
    held = {None: '', True: 'yes', False: 'no'}
    return table(head, [(f"{name(r)}, {WHAT[r['what']]}", r['faces'], r['tools'], whole(r['rate'] or None), held[r['held']],
                         r['sent'], r['skipped'], *latencies(r))
                        for r in reports if r['what'] in WHAT])


def comparison_table(reports):
    """Medians at the highest rate of each size: four tools beside one, and node and nodelet beside their echoes."""
    shapes = {}
    for r in (r for r in reports if r['what'] == 'shapes'):
        shapes.setdefault((r['faces'], r['workspace'], r['kind'], r['tools']), r)
    rows = []
    for (faces, workspace, kind, tools), r in shapes.items():
        if kind not in ECHO or tools != TOOLS[0]:
            continue
        many = shapes[faces, workspace, kind, TOOLS[1]]
        echo = shapes[(faces, *echo_of((workspace, kind, tools)))]
        rows.append((name(r), faces, whole(r['rate']), whole(r['median']), whole(many['median']),
                     f"{many['median'] / r['median']:.2f}", whole(r['median'] - echo['median']), whole(r['query']),
                     whole(r['median'] - echo['median'] - r['query'])))
    return table(('', 'faces', 'rate, Hz', '1 tool, µs', '4 tools, µs', 'ratio', '1 tool minus echo, µs',
                  'of it the query, µs', 'the rest, µs'), rows)


SECTIONS = ((WHAT, 'Latencies', latency_table), ({'shapes'}, 'At the same rate', comparison_table))


def markdown(reports):
    """All sections of which something was measured."""
    measured = {report['what'] for report in reports}
    return '# End to end\n' + ''.join(f'\n## {title}\n\n{make(reports)}' for what, title, make in SECTIONS
                                     if measured.intersection(what))
