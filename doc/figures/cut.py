#!/usr/bin/python3
"""Draws cut.png: the demo, before and after the stabber has cut off the end of the lobe. Starts the node and the demo's
simulator, and takes pictures of the node's markers right after a stab.

Usage: . devel/setup.bash && doc/figures/cut.py
"""

import os
import tempfile

from live_scene import (HERE, NODE, Camera, StillMarkers, collision_node, demo_tools, ros_master, rviz_picture, started,
                        wait_until)

import style

WHOLE = 1224  # faces of the liver
SHOWN = {'surface/liver', 'tools', 'swept', 'touched'}  # namespaces of markers
MARKERS_DEPTH = 0.25  # [m] Touched faces are yellow to red, and easy to see.
CAMERA = Camera((-12, 30), (0.060, -0.005, 0.006), 0.21, (800, 640))


def faces(markers, name_space):
    return sum(len(marker.points) // 3 for marker in list(markers.markers.values()) if marker.ns == name_space)


def main():
    with ros_master('cut'), tempfile.TemporaryDirectory() as folder:
        markers = StillMarkers(NODE + '/markers')
        figure, panels = style.panels(2, 3.6)
        simulator = ('rosrun', 'organ_collision', 'liver_simulator')
        with collision_node(*demo_tools(), markers_depth=MARKERS_DEPTH), started(*simulator):
            for axes, is_cut, title in zip(panels, (False, True), ('Before the cut', 'After the cut')):
                wait_until(lambda: markers.has(SHOWN) and (faces(markers, 'surface/liver') != WHOLE) == is_cut, title)
                # Both sides of a touched face are drawn.
                counts = faces(markers, 'touched') // 2, faces(markers, 'surface/liver')
                markers.still(SHOWN)
                picture = os.path.join(folder, 'cut.png')
                rviz_picture(picture, CAMERA, markers)
                axes.imshow(style.plt.imread(picture), interpolation='lanczos')
                axes.axis('off')
                axes.set_title('%s: %d of %d faces touched' % (title, *counts), color=style.TEXT)
        figure.tight_layout()
        style.save_picture(figure, os.path.join(HERE, 'cut.png'))


if __name__ == '__main__':
    main()
