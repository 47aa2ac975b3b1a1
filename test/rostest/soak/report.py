"""The page about a soak."""

from verdict import MEBIBYTE, WARM_UP, median_memory, memory_trend, most_growth

HOUR = 3600.0  # [s]


def table(rows):
    """Rows of cells; the first one is the head."""
    lines = ['| ' + ' | '.join(map(str, row)) + ' |' for row in rows]
    lines.insert(1, '|' + '---|' * len(rows[0]))
    return '\n'.join(lines)


def column(run):
    """What is told of a run: {what: value}."""
    judged, sent, counts = run['judged'], run['sent'], run['judged']['counts']
    growth, slope = memory_trend(run['memory'])
    seconds = run['memory'][-1][0]
    told = {
        'seconds': f'{seconds:.0f}',
        'shapes sent a second': f'{sent["vertices"] / seconds:.0f}',
        'memory, median': f'{median_memory(run["memory"]) / MEBIBYTE:.1f} MiB',
        'memory, growth after the warm-up': f'{growth / MEBIBYTE:+.2f} MiB ({slope * HOUR / MEBIBYTE:+.1f} MiB/h)',
        'organ messages sent': sent['meshes'] + sent['vertices'],
    }
    told.update({f'node: {key}': counts[key] for key in counts if key.startswith(('organ messages', 'shapes'))})
    told.update({
        'node: answers published': counts['answers published'],
        'answers received': judged['answers'],
        'answers known as lost on the way': judged['lost'],
        'answers OK': judged['ok'],
        'answers evaluated a second time': judged['rechecked'],
        'their contacts': judged['rechecked contacts'],
        'of them swept': sum(count for what, count in judged['rechecked tools'].items() if what.startswith('swept')),
        'times that all sums were checked': judged['sums'],
    })
    told.update({f'disturbance: {name.replace("_", " ")}': count for name, count in run['disturbances'].items()})
    told.update({f'simulator: {name}': sent[name] for name in sent if name not in ('meshes', 'vertices')})
    return told


def markdown(result):
    lines = [f'# Soak of {result["minutes"]:g} minutes, seed {result["seed"]}', '']
    lines += [f'- **{finding}**' for finding in result['findings']] or ['Nothing was found.']
    runs = {kind: column(run) for kind, run in result['runs'].items() if 'judged' in run}
    if runs:
        names = list(dict.fromkeys(name for told in runs.values() for name in told))
        rows = [['', *runs]] + [[name, *(told.get(name, 0) for told in runs.values())] for name in names]
        lines += ['', table(rows), '',
                  f'Memory is the lowest resident memory of a window. The first {WARM_UP:.0%} of a run are left out. '
                  'It may grow by ' + ' and '.join(f'{most_growth(run) // MEBIBYTE} MiB ({kind})'
                                                  for kind, run in result['runs'].items()) + '.']
    return '\n'.join(lines) + '\n'
