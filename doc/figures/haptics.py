#!/usr/bin/python3
"""Draws haptics.png, the picture of doc/haptics.md: the hand and the proxy of the demo, when the hand is deep in the
liver, as RViz shows them and as a section. Starts demo.launch, and takes the markers of one moment. Writes into the
folder above this one.

Usage: . devel/setup.bash && doc/figures/haptics.py
"""

import os
import tempfile

from live_scene import HERE, NODE, Camera, StillMarkers, ros_master, rviz_picture, started, wait_until
import numpy as np

import style

DEEP = 0.009  # [m] from hand to proxy
RADIUS = 0.005  # [m] of the palpator
SHOWN = {'surface/liver', 'proxy', 'hand', 'spring', 'loads'}  # namespaces of markers
HALF_WIDTH, BELOW, ABOVE = 0.040, 0.030, 0.036  # [m] of the section, around the proxy
HAND, PROXY, LIVER, FORCE = '#5b9bd5', '#8c9196', '#d98c7a', '#e0a100'


def place(point):
    return np.array([point.x, point.y, point.z])


class Moment:
    """The markers of one moment, and the liver's surface before the tool touched it."""

    def __init__(self, markers):
        self.markers, self.before = markers, None

    def all(self, name_space):
        return [marker for marker in list(self.markers.markers.values()) if marker.ns == name_space]

    def spring(self):
        """The centres of proxy and hand."""
        hand, proxy = (place(point) for point in self.all('spring')[0].points)
        return proxy, hand

    def triangles(self):
        points = [place(point) for marker in self.all('surface/liver') for point in marker.points]
        return np.reshape(points, (-1, 3, 3))

    def is_deep(self):
        if not self.all('spring') and self.all('surface/liver'):
            self.before = self.triangles()
        if self.before is None or not self.markers.has(SHOWN):
            return False
        proxy, hand = self.spring()
        return np.linalg.norm(hand - proxy) > DEEP


def section(triangles, to_plane):
    """The lines in which a surface meets a plane, as pairs of its coordinates. `to_plane` gives the coordinates of a
    place in the plane, and its distance from it."""
    lines = []
    for corners in (to_plane(triangle) for triangle in triangles):
        ends = []
        for a, b in ((0, 1), (1, 2), (2, 0)):
            if (corners[a, 2] < 0) != (corners[b, 2] < 0):
                share = corners[a, 2] / (corners[a, 2] - corners[b, 2])
                ends.append(corners[a, :2] + share * (corners[b, :2] - corners[a, :2]))
        if len(ends) == 2:
            lines.append(ends)
    return np.array(lines)


def inside_of(lines):
    """A polygon around the section, from its lines, which all belong to one outline."""
    rest, outline = [tuple(map(tuple, np.round(line, 8))) for line in lines], []
    here = rest[0][0]
    while rest:
        number = min(range(len(rest)), key=lambda i: min(np.hypot(*np.subtract(end, here)) for end in rest[i]))
        a, b = rest.pop(number)
        here = b if np.hypot(*np.subtract(a, here)) < np.hypot(*np.subtract(b, here)) else a
        outline.append(here)
    return outline


def draw_section(axes, moment):
    proxy, hand = moment.spring()
    trocar = place(moment.all('proxy')[1].pose.position)
    up = np.array([0.0, 0.0, 1.0])
    across = np.cross(up, np.cross(proxy - trocar, up))
    across /= np.linalg.norm(across)
    normal = np.cross(across, up)

    def to_plane(places):
        return np.stack([(places - proxy) @ across, (places - proxy) @ up, (places - proxy) @ normal], axis=-1)

    before = section(moment.before, to_plane)
    axes.fill(*np.transpose(inside_of(section(moment.triangles(), to_plane))), color=LIVER, ec=style.FACE, lw=1.4)
    for line in before:
        axes.plot(*line.T, '--', color=style.FACE, lw=1.0)
    for tip, color, alpha in ((hand, HAND, 0.65), (proxy, PROXY, 1.0)):
        way = to_plane(trocar)[:2] - to_plane(tip)[:2]
        side = RADIUS * np.array([-way[1], way[0]]) / np.hypot(*way)
        turn = np.arctan2(*side[::-1])
        cap = [to_plane(tip)[:2] + RADIUS * np.array([np.cos(turn + a), np.sin(turn + a)])
               for a in np.linspace(0, np.pi, 20)]
        axes.fill(*np.transpose([*cap, to_plane(trocar)[:2] - side, to_plane(trocar)[:2] + side]), color=color,
                  alpha=alpha, lw=0)
    at, below = to_plane(proxy)[:2], to_plane(hand)[:2]
    axes.plot(*np.transpose([at, below]), color=style.BOUND, lw=2.5)
    for load in moment.all('loads'):
        tail, head = (to_plane(place(point))[:2] for point in load.points)
        style.arrow(axes, head, head + 0.5 * (head - tail), FORCE, width=3.0)
    axes.set(xlim=(-HALF_WIDTH, HALF_WIDTH), ylim=(-BELOW, ABOVE))
    for text, anchor, label in (('proxy', at + (0.004, 0.002), (0.014, 0.012)),
                                ('hand', below + (0.004, -0.002), (0.016, -0.016)),
                                ('spring', 0.5 * (at + below), (-0.024, -0.006)),
                                ('force on\nthe liver', at + (0.002, -0.009), (-0.028, -0.020))):
        axes.annotate(text, anchor, label, color=style.TEXT, fontsize=11, va='center',
                      arrowprops={'arrowstyle': '-', 'color': style.TEXT, 'lw': 0.8})


def main():
    with ros_master('haptics'), tempfile.TemporaryDirectory() as folder:
        markers = StillMarkers(NODE + '/markers', '/haptic_proxy/markers')
        moment = Moment(markers)
        with started('roslaunch', 'organ_collision', 'demo.launch', 'report:=false'):
            wait_until(moment.is_deep, 'the hand')
            markers.markers = {key: marker for key, marker in markers.markers.items() if marker.ns in SHOWN}
            proxy, _ = moment.spring()
            for marker in moment.all('surface/liver'):
                marker.color.a = 0.5  # The hand is inside.
            markers.still(SHOWN)
            camera = Camera((-60, 12), proxy + (0.0, 0.0, -0.004), 0.13, (800, 800))
            picture = os.path.join(folder, 'hand.png')
            rviz_picture(picture, camera, markers)
        figure, (left, right) = style.panels(2, 4.2)
        left.imshow(style.plt.imread(picture), interpolation='lanczos')
        left.axis('off')
        left.set_title('The palpator presses on the liver', color=style.TEXT)
        style.drawing(right, 'The same moment in section')
        draw_section(right, moment)
        figure.tight_layout()
        style.save_picture(figure, os.path.join(HERE, '..', 'haptics.png'))


if __name__ == '__main__':
    main()
