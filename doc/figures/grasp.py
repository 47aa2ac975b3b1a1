#!/usr/bin/python3
"""Draws grasp.png: the grasper of grasper.launch, which has lifted a fold of tissue, and where it holds it. Starts the
launch file, and takes a picture of the node's markers.

Usage: . devel/setup.bash && doc/figures/grasp.py
"""

import os
import tempfile

from live_scene import HERE, LIMIT, NODE, Camera, StillMarkers, ros_master, rviz_picture, started, wait_until
import numpy as np
from organ_collision.msg import Grasp
import rospy
from sensor_msgs.msg import JointState

import style

LIFTED = 0.0832  # [m] The insertion of the shaft where the grasper is highest.
SHOWN = {'surface/fold', 'tools', 'touched'}  # namespaces of markers
CAMERA = Camera((-60, 14), (0.0, 0.0, 0.018), 0.13, (1500, 900))


class Robot:
    """What the jaws hold, and whether they have lifted it."""

    def __init__(self):
        self.grasp, self.is_high = None, False
        self.subscribers = [rospy.Subscriber(NODE + '/grasps', Grasp, self.note_grasp),
                            rospy.Subscriber('joint_states', JointState, self.note_joints)]

    def note_grasp(self, grasp):
        self.grasp = grasp if grasp.event == Grasp.GRASPED else None

    def note_joints(self, state):
        self.is_high = dict(zip(state.name, state.position))['grasper_insertion'] < LIFTED

    def has_lifted(self):
        return self.grasp is not None and self.is_high


def draw(picture, grasp, lift):
    figure, (axes,) = style.panels(1, 5.1)
    axes.imshow(style.plt.imread(picture), interpolation='lanczos')
    axes.axis('off')
    ends = [np.array([p.x, p.y, p.z + lift]) for p in (grasp.on_first, grasp.on_second)]
    middle = np.array(CAMERA.pixel(0.5 * sum(ends)))
    axes.annotate('the jaws hold %.1f mm of tissue:\nthe message has its faces on both sides' % (1e3 * grasp.thickness),
                  middle, middle + [330, 60], color=style.TEXT, fontsize=11, va='center',
                  arrowprops={'arrowstyle': '-', 'color': style.TEXT, 'lw': 0.8})
    figure.tight_layout()
    style.save_picture(figure, os.path.join(HERE, 'grasp.png'))


def main():
    with ros_master('grasp'), tempfile.TemporaryDirectory() as folder:
        rospy.set_param(NODE + '/tf_timeout_sec', LIMIT)
        markers, robot = StillMarkers(NODE + '/markers'), Robot()
        with started('roslaunch', 'organ_collision', 'grasper.launch'):
            wait_until(lambda: robot.has_lifted() and markers.has(SHOWN), 'the lifted fold')
            grasp = robot.grasp
            markers.still(SHOWN)
            picture = os.path.join(folder, 'grasp.png')
            rviz_picture(picture, CAMERA, markers, 'fold')
        draw(picture, grasp, 0.012)


if __name__ == '__main__':
    main()
