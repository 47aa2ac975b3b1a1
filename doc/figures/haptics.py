#!/usr/bin/python3
"""Draws haptics.png, the picture of doc/haptics.md: the hand and the proxy of the demo, when the hand is deep in the
liver. Starts demo.launch, and takes a picture of the markers of one moment. Writes into the folder above this one.

Usage: . devel/setup.bash && doc/figures/haptics.py
"""

import os
import tempfile

from live_scene import HERE, NODE, Camera, StillMarkers, ros_master, snapshot, started, wait_until
import numpy as np
from organ_collision.msg import ProxyState
import rospy

import style

DEEP = 0.009  # [m] from hand to proxy
CAMERA = Camera((-45, 10), (-0.025, -0.02, 0.036), 0.165, (1500, 740))
SHOWN = {'surface/liver', 'proxy', 'hand', 'spring', 'loads'}  # namespaces of markers
PICTURE = ['--frame', 'liver', '--topic', 'still', '--background', '#ffffff']


class Hand:
    def __init__(self):
        self.state = None
        self.subscriber = rospy.Subscriber('/haptic_proxy/palpator/state', ProxyState, self.note, queue_size=1)

    def note(self, state):
        self.state = state

    def is_deep(self):
        pull = self.state.pull if self.state else None
        return pull and np.linalg.norm([pull.x, pull.y, pull.z]) > DEEP


def draw(picture, state):
    figure, (axes,) = style.panels(1, 4.6)
    axes.imshow(style.plt.imread(picture), interpolation='lanczos')
    axes.axis('off')
    hand, proxy = (np.array([pose.position.x, pose.position.y, pose.position.z]) for pose in (state.hand, state.proxy))
    for text, place, shift in (('hand', hand, (150, 120)), ('proxy', proxy, (170, -60)),
                               ('forces on the liver', proxy + (0.0, 0.0, 0.011), (140, -120))):
        pixel = np.array(CAMERA.pixel(place))
        axes.annotate(text, pixel, pixel + shift, color=style.TEXT, fontsize=12, va='center',
                      arrowprops={'arrowstyle': '-', 'color': style.TEXT, 'lw': 0.8})
    figure.tight_layout()
    style.save_picture(figure, os.path.join(HERE, '..', 'haptics.png'))


def main():
    with ros_master('haptics'), tempfile.TemporaryDirectory() as folder:
        markers, hand = StillMarkers(NODE + '/markers', '/haptic_proxy/markers'), Hand()
        with started('roslaunch', 'organ_collision', 'demo.launch', 'report:=false'):
            wait_until(hand.is_deep, 'the hand')
            state = hand.state
            markers.markers = {key: marker for key, marker in markers.markers.items() if marker.ns in SHOWN}
            for marker in markers.markers.values():
                if marker.ns == 'surface/liver':
                    marker.color.a = 0.5  # The hand is inside.
            markers.still()
            picture = os.path.join(folder, 'hand.png')
            snapshot(picture, *CAMERA.options(), *PICTURE)
        draw(picture, state)


if __name__ == '__main__':
    main()
