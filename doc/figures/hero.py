#!/usr/bin/python3
"""Draws hero.png: the same step of a tool twice, as a static and as a swept query see it. Starts the node with the
demo's liver, lets a tool jump over the left lobe in one step, and takes pictures of the node's markers. The numbers of
faces are those of the node's answers. The tool's place before the step is drawn by this script.

Usage: . devel/setup.bash && doc/figures/hero.py
"""

import os
import tempfile

from geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from live_scene import HERE, NODE, Camera, Scene, StillMarkers, collision_node, liver, ros_master, rviz_picture
import numpy as np
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker

import style

# The tool, in the liver's frame [m].
TOOL = {'name': 'tool', 'trocar_frame': 'trocar', 'tip_frame': 'tip', 'radius': 0.004}
TROCAR = np.array([0.070, 0.020, 0.150])
BEFORE, NOW = np.array([0.062, -0.060, -0.022]), np.array([0.062, 0.095, -0.022])
MARKERS_DEPTH = 0.25  # [m] Touched faces are yellow to red, and easy to see.

CAMERA = Camera((-20, 30), (0.020, 0.018, 0.040), 0.30, (800, 700))


def ghost(frame):
    """The tool where it was before the step."""
    way = BEFORE - TROCAR
    length = np.linalg.norm(way)
    axis = np.cross([0, 0, 1], way / length)
    turn = Quaternion(*axis, 1 + way[2] / length)
    size = np.linalg.norm([turn.x, turn.y, turn.z, turn.w])
    turn = Quaternion(turn.x / size, turn.y / size, turn.z / size, turn.w / size)
    width = 2 * TOOL['radius']
    shapes = ((Marker.CYLINDER, 0.5 * (TROCAR + BEFORE), length), (Marker.SPHERE, BEFORE, width))
    return [Marker(header=Header(frame_id=frame), ns='before', type=shape, pose=Pose(Point(*place), turn),
                   scale=Vector3(width, width, height), color=ColorRGBA(0.75, 0.80, 0.88, 0.40))
            for shape, place, height in shapes]


def draw_panel(axes, picture, title, color):
    axes.imshow(style.plt.imread(picture), interpolation='lanczos')
    axes.axis('off')
    axes.set_title(title, color=color, fontsize=12, fontweight='bold')
    for place, text in ((BEFORE, 'tool at the\nlast answer'), (NOW, 'tool now')):
        x, y = CAMERA.pixel(place)
        style.label(axes, (x, y + 25), text, ha='center', va='top')


def main():
    with ros_master('hero'), tempfile.TemporaryDirectory() as folder:
        mesh = liver()
        figure, panels = style.panels(2, 4.0)
        with collision_node(TOOL, markers_depth=MARKERS_DEPTH):
            scene = Scene(mesh, TOOL['name'], TROCAR)
            markers = StillMarkers(NODE + '/markers')
            # The first step after a reset is static.
            for axes, tips, traces, title, color in (
                    (panels[0], [NOW], set(), 'Static query: %d faces touched', style.TEXT),
                    (panels[1], [BEFORE, NOW], {'swept', 'touched'}, 'Swept query: %d faces touched', style.FACE)):
                picture = os.path.join(folder, '%d.png' % len(tips))
                answer = scene.moment(tips, markers, {'surface/liver', 'tools'} | traces,
                                      *ghost(mesh.header.frame_id))
                rviz_picture(picture, CAMERA, markers)
                draw_panel(axes, picture, title % len(answer.contacts), color)
        figure.tight_layout()
        style.save_picture(figure, os.path.join(HERE, 'hero.png'))


if __name__ == '__main__':
    main()
