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
import subprocess
import sys
import tempfile
from statistics import median

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / 'end_to_end'))

from report import table, whole  # noqa: E402
from ros_master import Master  # noqa: E402
from subject import Workspace  # noqa: E402

SIZES = (1224, 10_000, 100_000, 1_000_000)
TOOLS = ('shaft', 'grasper')
THREADS = (1, 2)
SECONDS = 0.5  # of a round of one engine
ENGINES = ('static', 'swept', 'fcl', 'fcl_touches')


class Library:
    """The program motions_benchmark: CollisionQuery and FCL, without ROS."""

    def __init__(self, workspace, faces, tool):
        self.process = subprocess.Popen(workspace.command('motions_benchmark', faces, tool), stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, universal_newlines=True)

    def ask(self, line):
        self.process.stdin.write(line + '\n')
        self.process.stdin.flush()
        answer = self.process.stdout.readline()
        if not answer:
            sys.exit(f'motions.py: motions_benchmark failed at "{line}"')
        return json.loads(answer)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.stdin.close()
        self.process.wait()


def measure(workspace, faces, tool, rounds):
    with Library(workspace, faces, tool) as library:
        rates = {(engine, threads): [] for engine in ENGINES for threads in THREADS}
        for _ in range(rounds):
            for (engine, threads), found in rates.items():
                found.append(library.ask(f'{engine} {threads} {SECONDS}')['motions_per_second'])
        report = {'faces': faces, 'tool': tool, 'compared': library.ask('compare'),
                  'rates': {f'{engine}/{threads}': median(found) for (engine, threads), found in rates.items()}}
    return report


def markdown(reports):
    head = ('', 'faces', 'threads', 'static', 'swept', 'FCL, static', 'FCL, touch or not', 'static / FCL')
    rows = []
    for r in reports:
        for threads in THREADS:
            rates = [r['rates'][f'{engine}/{threads}'] for engine in ENGINES]
            rows.append((r['tool'], r['faces'], threads, *map(whole, rates), f'{rates[0] / rates[2]:.1f}'))
    return '# Motions a second\n\n' + table(head, rows)


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    workspace, folder, rounds = Workspace(sys.argv[1]), pathlib.Path(sys.argv[2]), int(sys.argv[3])
    reports = []
    for faces in [int(size) for size in sys.argv[4:]] or SIZES:
        for tool in TOOLS:
            print(f'{faces} faces, {tool}', flush=True)
            reports.append(measure(workspace, faces, tool, rounds))
    folder.mkdir(exist_ok=True)
    (folder / 'motions.json').write_text(json.dumps(reports, indent=1) + '\n')
    (folder / 'motions.md').write_text(markdown(reports))


if __name__ == '__main__':
    main()
