#!/usr/bin/python3
"""Measures the latencies of the running node and nodelet, beside roscpp alone.

Usage: end_to_end.py [--beside DEVEL] [--only PART] DEVEL FOLDER SECONDS [FACES ...]

DEVEL is the devel space of the built workspace. The script starts its own ROS master and writes end_to_end.json and
end_to_end.md into FOLDER. What is compared runs in turn, in rounds; each measurement takes SECONDS in all. With
--beside, node and nodelet of a second workspace run in turn with those of the first, for example of an older state,
which must have been built with these benchmarks."""

import argparse
import json
import os
import pathlib
import tempfile

from hands import SIZES as HAND_SIZES
from hands import measure_hands
from report import markdown
from ros_master import Master
from shapes import HIGHEST_RATE, measure_size
from subject import Workspace


PARTS = ('hands', 'shapes')


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--beside', metavar='DEVEL')
    parser.add_argument('--only', choices=PARTS, action='append', help='may be given several times')
    parser.add_argument('devel')
    parser.add_argument('folder', type=pathlib.Path)
    parser.add_argument('seconds', type=float)
    parser.add_argument('faces', type=int, nargs='*', default=list(HIGHEST_RATE))
    given = parser.parse_args()
    workspaces = {'': Workspace(given.devel)}
    if given.beside:
        workspaces['beside'] = Workspace(given.beside)
    parts = given.only or PARTS
    reports = []
    with tempfile.TemporaryDirectory() as home:
        os.environ['ROS_HOME'] = home
        with Master() as master:
            for faces in given.faces:
                if 'hands' in parts and faces in HAND_SIZES:
                    print(f'{faces} faces, a hand', flush=True)
                    reports += measure_hands(master, workspaces[''], faces, given.seconds)
                if 'shapes' in parts:
                    print(f'{faces} faces, shapes', flush=True)
                    reports += measure_size(master, workspaces, faces, given.seconds)
    given.folder.mkdir(exist_ok=True)
    (given.folder / 'end_to_end.json').write_text(json.dumps(reports, indent=1) + '\n')
    (given.folder / 'end_to_end.md').write_text(markdown(reports))


if __name__ == '__main__':
    main()
