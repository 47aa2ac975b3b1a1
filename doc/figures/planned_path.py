#!/usr/bin/python3
"""Draws planned_path.png: the path that the planner of plan.launch finds, and the grasper at its end. Starts
plan.launch, and takes a picture of the node's markers and of the planner's line.

Usage: . devel/setup.bash && doc/figures/planned_path.py
"""

import os
import tempfile

from live_scene import HERE, NODE, Camera, ros_master, snapshot, started, wait_until
import numpy as np
import rospy
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import MarkerArray

import style

GREEN = ColorRGBA(*style.plt.matplotlib.colors.to_rgba(style.BOUND))
WIDTH = 0.0014     # [m] of the line
ON_ITS_WAY = 16.0  # [s] longer than the grasper needs for its way
CAMERA = Camera((-15, -15), (0.02, -0.05, 0.008), 0.28, (1500, 820))
PICTURE = ['--frame', 'liver', '--background', '#ffffff', '--after', '1', '--topic', 'organ_collision/markers',
           '--topic', 'path', '--hide', 'swept', '--hide', 'clearance', '--hide', 'names', '--hide', 'status']


class Line:
    """Takes the planner's line out of the node's markers, and publishes it again, to be seen by late subscribers."""

    def __init__(self):
        self.points = []
        self.publisher = rospy.Publisher('path', MarkerArray, latch=True, queue_size=1)
        self.subscriber = rospy.Subscriber(NODE + '/markers', MarkerArray, self.note)

    def note(self, array):
        for marker in array.markers:
            if marker.ns == 'path':
                marker.color, marker.scale.x = GREEN, WIDTH
                self.publisher.publish([marker])
                self.points = [np.array([point.x, point.y, point.z]) for point in marker.points]


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
        line = Line()
        with started('roslaunch', 'organ_collision', 'plan.launch'):
            wait_until(lambda: line.points, 'the path')
            rospy.sleep(ON_ITS_WAY)
            picture = os.path.join(folder, 'path.png')
            snapshot(picture, *CAMERA.options(), *PICTURE)
        draw(picture, line.points)


if __name__ == '__main__':
    main()
