#!/usr/bin/python3
"""Redoes figures 9 and 10 of the 1999 paper: starts the node with the demo's liver and one tool, and
takes pictures of its markers. Writes paper_figure_9.png and paper_figure_10.png beside this file.

Usage: . devel/setup.bash && doc/figures/paper_figures.py
"""

import os

from live_scene import HERE, NODE, Camera, Scene, StillMarkers, collision_node, liver, ros_master, rviz_picture

# The tool, in the liver's frame [m]. It is thin, like the segment in the paper's figures.
TOOL = {'name': 'tool', 'trocar_frame': 'trocar', 'tip_frame': 'tip', 'radius': 0.002}
TROCAR = (0.030, 0.080, 0.150)
BEFORE, AFTER = (-0.070, -0.020, 0.015), (0.020, -0.035, 0.010)
MARKERS_DEPTH = 0.25  # [m] Touched faces are yellow to red, and easy to see.

CAMERA = Camera((-80, 45), (0.0, 0.0, 0.025), 0.27, (720, 540))
SHOWN = {'surface/liver', 'tools', 'touched'}


def main():
    with ros_master('paper_figures'):
        mesh = liver()
        with collision_node(TOOL, markers_depth=MARKERS_DEPTH):
            scene = Scene(mesh, TOOL['name'], TROCAR)
            markers = StillMarkers(NODE + '/markers')
            for tips, shown, file in (([BEFORE], SHOWN, 'paper_figure_9.png'),
                                      ([BEFORE, AFTER], SHOWN | {'swept'}, 'paper_figure_10.png')):
                scene.moment(tips, markers, shown)
                rviz_picture(os.path.join(HERE, file), CAMERA, markers)


if __name__ == '__main__':
    main()
