#!/usr/bin/python3
"""Draws guarded_arm.png: the arm of guarded_arm.launch where it bends around the liver, and how far its links are from the
liver on their way, with and without rows. Starts the launch file twice, and lets the arm follow its path once.

Usage: . devel/setup.bash && doc/figures/arm.py
"""

import os
import sys

from live_scene import HERE, ros_master, started
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
import numpy as np
import rospy

import style

sys.path.append(os.path.join(HERE, '..', '..', 'test', 'rostest'))
import guarded_arm_test  # noqa: E402

example, LAPS = guarded_arm_test.EXAMPLE, 1.1

with open(os.path.join(HERE, '..', '..', 'urdf', 'arm.urdf')) as file:
    ARM = example.Arm(file.read(), ['arm_%d' % number for number in range(1, 8)])
RADII = 0.045, 0.04, 0.04, 0.03, 0.025, 0.02, 0.006  # [m] of the links, as in the URDF
SHOWN = {6: (style.TOOL, 'tool'), 5: (style.BOUND, 'wrist'), 4: (style.FACE, 'forearm')}
LIVER, STEEL, LIGHT = (0.72, 0.32, 0.26), (0.80, 0.82, 0.86), np.array([0.4, -0.5, 0.77])


class Run:
    """One lap of the arm: the angles of its joints, and the distances of the links at each shape of the liver."""

    def __init__(self, guard):
        rospy.set_param('/liver_simulator/rate', guarded_arm_test.SHAPES)
        scene = guarded_arm_test.Scene()
        with started('roslaunch', os.path.join(HERE, '..', '..', 'examples', 'guarded_arm.launch'), 'guard:=%s' % guard):
            scene.begin()
            while scene.steps_of_arm() < LAPS * example.LAP * example.RATE:
                scene.step()
        self.distances, shapes = scene.distances(), scene.shapes.messages[scene.first:]
        self.times = np.array([shape.header.stamp.to_sec() for shape in shapes])[:len(self.distances)]
        stamps = [joints.header.stamp.to_sec() for joints in scene.joints.messages]
        lowest = int(np.argmin(self.distances[:, 5]))
        self.angles = np.array(scene.joints.messages[np.searchsorted(stamps, self.times[lowest])].position)
        shape = shapes[lowest]
        (mesh,) = [mesh for mesh in scene.mesh.messages if mesh.topology == shape.topology]
        self.liver = np.array(shape.vertices).reshape(-1, 3)[np.array(mesh.triangles).reshape(-1, 3)] - example.BASE
        scene.close()


def tube(start, end, radius):
    """Corners of the faces of a capsule, n x 4 x 3."""
    axis = (end - start) / np.linalg.norm(end - start)
    side = np.cross(axis, [1.0, 0.2, 0.1])
    side /= np.linalg.norm(side)
    around, along = np.linspace(0, 2 * np.pi, 25), np.linspace(-np.pi / 2, np.pi / 2, 13)
    ring = np.cos(around)[:, None] * side + np.sin(around)[:, None] * np.cross(axis, side)
    grid = np.array([np.where(angle < 0, start, end) + radius * (np.sin(angle) * axis + np.cos(angle) * ring) for angle in along])
    return np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], axis=2).reshape(-1, 4, 3)


def draw_scene(axes, angles, liver):
    ARM.move(angles)
    ends = [*ARM.places, ARM.tip]
    polygons, colors = list(liver), [LIVER] * len(liver)
    for link in range(7):
        pieces = max(1, int(np.linalg.norm(ends[link + 1] - ends[link]) / 0.02))  # short, so that they sort well by depth
        for k in range(pieces):
            way = ends[link + 1] - ends[link]
            faces = tube(ends[link] + k / pieces * way, ends[link] + (k + 1) / pieces * way, RADII[link])
            polygons += list(faces)
            colors += [STEEL] * len(faces)
    normals = np.array([np.cross(face[1] - face[0], face[2] - face[0]) for face in polygons])
    normals /= np.linalg.norm(normals, axis=1)[:, None] + 1e-12
    shade = 0.55 + 0.45 * np.abs(normals @ LIGHT)
    axes.add_collection3d(Poly3DCollection(polygons, facecolors=np.clip(np.array(colors) * shade[:, None], 0, 1), linewidth=0))
    axes.set(xlim=(-0.2, 0.2), ylim=(0.32, 0.72), zlim=(-0.12, 0.28), box_aspect=(1, 1, 1))
    axes.axis('off')
    axes.view_init(18, -15)


def main():
    with ros_master('guarded_arm_figure'):
        rospy.set_param('/use_sim_time', True)
        runs = Run(True), Run(False)
    figure = style.plt.figure(figsize=(style.WIDTH, 3.5))
    draw_scene(figure.add_axes((-0.10, -0.25, 0.62, 1.5), projection='3d'), runs[0].angles, runs[0].liver)
    axes = figure.add_axes((0.55, 0.14, 0.44, 0.76))
    for run, line in zip(runs, ('-', '--')):
        for link, (color, name) in SHOWN.items():
            axes.plot(run.times - run.times[0], 1e3 * run.distances[:, link], line, color=color,
                      label=name if line == '-' else None)
    axes.axhline(5, color=style.GUIDE, lw=0.8)
    axes.axhspan(-34, 0, color=LIVER, alpha=0.12, lw=0)
    axes.set(xlim=(0, max(run.times[-1] - run.times[0] for run in runs)), ylim=(-34, 60), xlabel='time [s]',
             title='distance from the liver [mm]; dashed: without rows')
    axes.legend(loc='lower center', frameon=False, ncol=3)
    print('least distances with and without rows [mm]:', *(np.round(1e3 * run.distances.min(axis=0), 2) for run in runs))
    figure.savefig(os.path.join(HERE, 'guarded_arm.png'), dpi=180, metadata={'Software': None}, pil_kwargs={'optimize': True})


if __name__ == '__main__':
    main()
