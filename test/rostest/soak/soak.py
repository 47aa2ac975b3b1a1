#!/usr/bin/python3
"""Runs the node, then the nodelet, with a fast simulator, and disturbs them all the time.

Usage: soak.py [--help] [--minutes N] [--seed S] [--out FOLDER] DEVEL

The run is a success if memory stays flat, no answer is wrong, and what was sent is all accounted for. DEVEL is the
devel space of a build with tests. The script starts its own ROS masters. It writes into FOLDER: soak.md, soak.json, and
what the node and the nodelet have printed."""

import argparse
import contextlib
import json
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))

from disturbances import Disturbances  # noqa: E402
from report import markdown  # noqa: E402
from subject import KINDS, Subject  # noqa: E402
from support.own_master import OwnMaster  # noqa: E402
from verdict import findings  # noqa: E402


def run_kind(kind, options):
    """One subject for its share of the minutes. Returns all that was measured."""
    random_numbers = random.Random(f'{options.seed} {kind}')
    with contextlib.ExitStack() as stack:
        master = OwnMaster()
        stack.callback(master.stop)
        log = stack.enter_context(open(options.out / f'{kind}.log', 'w', encoding='utf-8'))
        subject = stack.enter_context(Subject(master, options.devel.resolve(), kind, options.seed, log))
        disturbances = Disturbances(master, subject, random_numbers)
        disturbances.run(60.0 * options.minutes / len(KINDS))
        return subject.end(disturbances)


def main():
    parser = argparse.ArgumentParser(usage=__doc__, add_help=False)
    parser.add_argument('--minutes', type=float, default=1.0)
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--out', type=pathlib.Path, default='soak')
    parser.add_argument('devel', type=pathlib.Path)
    if {'-h', '--help'} & set(sys.argv[1:]):
        print(__doc__)
        return 0
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    runs = {kind: run_kind(kind, options) for kind in KINDS}
    wrong = [f'{kind}: {finding}' for kind, run in runs.items() for finding in findings(run)]
    result = {'minutes': options.minutes, 'seed': options.seed, 'findings': wrong, 'runs': runs}
    (options.out / 'soak.json').write_text(json.dumps(result, indent=1) + '\n', encoding='utf-8')
    (options.out / 'soak.md').write_text(markdown(result), encoding='utf-8')
    print(markdown(result))
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
