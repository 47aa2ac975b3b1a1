#!/usr/bin/python3
"""Draws the figures of the pages, from the formulas that the pages give.

Usage: doc/figures/draw.py [FOLDER]

Writes one SVG for each figure into FOLDER (default: the folder of this script). The same version of
matplotlib writes the same bytes. Needs python3-matplotlib (scripts/packages.txt).
"""

import importlib
import os
import sys

import style

FIGURES = ['first_scene', 'touch', 'fast_sweep', 'tool_frames', 'pose_times', 'words', 'wedge', 'first_touch', 'spans',
           'distances', 'sides', 'mobility', 'proxy']


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.abspath(__file__))
    for name in FIGURES:
        figure = importlib.import_module(name).draw()
        style.save(figure, os.path.join(folder, name))


if __name__ == '__main__':
    main()
