#!/usr/bin/python3
"""Measures how many motions a second are answered: by the library, by query_batch, by query_offline, and by FCL.

Usage: motions.py DEVEL FOLDER ROUNDS [FACES ...]

DEVEL is the devel space of the built workspace. The script starts its own ROS master and writes motions.json and
motions.md into FOLDER. All that is compared answers the same motions, in turn, in ROUNDS rounds; the tables have
medians."""

import contextlib
import json
import os
import pathlib
import sys
import tempfile
from statistics import median

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / 'end_to_end'))

from batch_node import BatchNode  # noqa: E402
from library_client import Library  # noqa: E402
from offline_runs import MOTIONS as OFFLINE_MOTIONS  # noqa: E402
from offline_runs import offline_rate  # noqa: E402
from report import table, whole  # noqa: E402
from ros_master import Master  # noqa: E402
from subject import Workspace  # noqa: E402

SIZES = (1224, 10_000, 100_000, 1_000_000)
TOOLS = ('shaft', 'grasper')
THREADS = (1, 2)
MODES = ('static', 'swept')
SECONDS = 0.5  # of a round of one engine
COLUMNS = {'library static': 'library, static', 'library static_cpu': 'the same, picker: cpu',
           'fcl': 'FCL, static', 'fcl_touches': 'FCL, touch or not',
           'batch static': 'query_batch, static', 'offline static': 'query_offline, static',
           'library swept': 'library, swept', 'batch swept': 'query_batch, swept', 'offline swept': 'query_offline, swept'}


def measure(master, workspace, faces, tool, rounds):
    with contextlib.ExitStack() as stack:
        folder = stack.enter_context(tempfile.TemporaryDirectory())
        library = stack.enter_context(Library(workspace, faces, tool))
        library.write_files(OFFLINE_MOTIONS, folder)
        nodes = {threads: stack.enter_context(BatchNode(master, workspace, faces, tool, threads, folder))
                 for threads in THREADS}
        rates = {}

        def add(what, threads, rate):
            rates.setdefault(f'{what}/{threads}', []).append(rate)

        for _ in range(rounds):
            for threads in THREADS:
                add('fcl', threads, library.rate('fcl', threads, SECONDS))
                add('fcl_touches', threads, library.rate('fcl_touches', threads, SECONDS))
                add('library static_cpu', threads, library.rate('static_cpu', threads, SECONDS))
                for mode in MODES:
                    add(f'library {mode}', threads, library.rate(mode, threads, SECONDS))
                    add(f'batch {mode}', threads, nodes[threads].rate(mode, SECONDS))
                    if tool == 'shaft':  # query_offline reads no links.
                        add(f'offline {mode}', threads, offline_rate(workspace, folder, mode, threads))
        return {'faces': faces, 'tool': tool, 'compared': library.compare(),
                'rates': {what: median(found) for what, found in rates.items()}}


def markdown(reports):
    rows, ratios, compared = [], [], []
    for r in reports:
        rates = r['rates']
        rows += [(r['tool'], r['faces'], threads, *(whole(rates.get(f'{what}/{threads}')) for what in COLUMNS))
                 for threads in THREADS]
        ratios.append((r['tool'], r['faces'],
                       *(f"{rates[f'library {engine}/{threads}'] / rates[f'fcl/{threads}']:.1f}"
                         for engine in ('static', 'static_cpu') for threads in THREADS),
                       *(f"{rates[f'{what}/{THREADS[1]}'] / rates[f'{what}/{THREADS[0]}']:.2f}"
                         if f'{what}/{THREADS[0]}' in rates else ''
                         for what in ('library static', 'batch static', 'batch swept', 'offline swept', 'fcl'))))
        compared.append((r['tool'], r['faces'], *r['compared'].values()))
    return '\n'.join([
        '# Motions a second\n', table(('', 'faces', 'threads', *COLUMNS.values()), rows),
        table(('', 'faces', 'library / FCL, 1 thread', '2 threads', 'picker: cpu / FCL, 1 thread',
               '2 threads', 'two threads / one: library, static',
               'query_batch, static', 'query_batch, swept', 'query_offline, swept', 'FCL'), ratios),
        table(('', 'faces', 'contacts', 'missed by FCL', 'only by FCL'), compared)])


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    workspace, folder, rounds = Workspace(sys.argv[1]), pathlib.Path(sys.argv[2]), int(sys.argv[3])
    reports = []
    with tempfile.TemporaryDirectory() as home:
        os.environ['ROS_HOME'] = home
        with Master() as master:
            for faces in [int(size) for size in sys.argv[4:]] or SIZES:
                for tool in TOOLS:
                    print(f'{faces} faces, {tool}', flush=True)
                    reports.append(measure(master, workspace, faces, tool, rounds))
    folder.mkdir(exist_ok=True)
    (folder / 'motions.json').write_text(json.dumps(reports, indent=1) + '\n')
    (folder / 'motions.md').write_text(markdown(reports))


if __name__ == '__main__':
    main()
