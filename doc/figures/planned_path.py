#!/usr/bin/python3
"""Draws planned_path.png: the path that the planner of plan.launch finds, and the grasper at its end. Starts
plan.launch, and takes a picture of the node's markers and of the planner's line.

Usage: . devel/setup.bash && doc/figures/planned_path.py
"""

import os
import tempfile
import time

from live_scene import HERE, NODE, Camera, StillMarkers, ros_master, rviz_picture, started, wait_until
import numpy as np
import rospy
from sensor_msgs.msg import JointState
from std_msgs.msg import ColorRGBA

import style

GREEN = ColorRGBA(*style.plt.matplotlib.colors.to_rgba(style.BOUND))
WIDTH = 0.0014  # [m] of the line
REST = 1.0      # [s] The grasper has arrived if its joints have not changed for so long.
SHOWN = {'surface/liver', 'tools', 'path'}  # namespaces of markers
CAMERA = Camera((-15, -15), (0.02, -0.05, 0.008), 0.28, (1500, 820))


class Grasper:
    """Whether the grasper has arrived at the end of its way."""

    def __init__(self):
        self.start, self.position, self.changed = None, None, 0.0
        self.subscriber = rospy.Subscriber('joint_states', JointState, self.note)

    def note(self, state):
        self.start = self.start or state.position
        if state.position != self.position:
            self.position, self.changed = state.position, time.monotonic()

    def has_arrived(self):
        return self.position != self.start and time.monotonic() > self.changed + REST


def line_of(markers):
    """The planner's line, in the colour of the figure."""
    (line,) = (marker for marker in list(markers.markers.values()) if marker.ns == 'path')
    line.color, line.scale.x = GREEN, WIDTH
    return [np.array([point.x, point.y, point.z]) for point in line.points]


def draw(picture, line):
    figure, (axes,) = style.panels(1, 5.1)
    axes.imshow(style.plt.imread(picture), interpolation='lanczos')
    axes.axis('off')
    start, target = (np.array(CAMERA.pixel(place)) for place in (line[0], line[-1]))
    middle = np.array(CAMERA.pixel(line[len(line) // 2]))
    axes.plot(*np.stack([start, target]).T, '--', color=style.TEXT, lw=1.2)
    for place, color in ((start, style.TEXT), (target, style.TEXT)):
        axes.plot(*place, 'o', color=color, ms=5)
    style.label(axes, start + [0, -45], 'start of the tip', ha='center', va='center', fontsize=11)
    style.label(axes, middle + [0, -110], 'the planned way\nof the tip', style.BOUND, ha='center', fontsize=11)
    axes.annotate('target', target, target + [150, 170], color=style.TEXT, fontsize=11, va='center',
                  arrowprops={'arrowstyle': '-', 'color': style.TEXT, 'lw': 0.8})
    axes.annotate('the straight way goes\nthrough the liver', 0.6 * start + 0.4 * target, start + [260, -70],
                  color=style.TEXT, fontsize=11, va='center',
                  arrowprops={'arrowstyle': '-', 'color': style.TEXT, 'lw': 0.8})
    figure.tight_layout()
    style.save_picture(figure, os.path.join(HERE, 'planned_path.png'))


def main():
    with ros_master('planned_path'), tempfile.TemporaryDirectory() as folder:
        markers, grasper = StillMarkers(NODE + '/markers'), Grasper()
        with started('roslaunch', 'organ_collision', 'plan.launch'):
            wait_until(grasper.has_arrived, 'the grasper')
            wait_until(lambda: markers.has(SHOWN), 'the path')
            line = line_of(markers)
            markers.still(SHOWN)
            picture = os.path.join(folder, 'path.png')
            rviz_picture(picture, CAMERA, markers)
        draw(picture, line)


if __name__ == '__main__':
    main()
