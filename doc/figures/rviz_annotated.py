#!/usr/bin/python3
"""Draws rviz_annotated.png: RViz with the liver of the demo and two tools, and the names of what it shows. The probe
goes through the surface of the right lobe, the hook is near the left one. Needs rviz, xvfb and imagemagick.

Usage: . devel/setup.bash && doc/figures/rviz_annotated.py
"""

import os
import tempfile

from live_scene import (HERE, NODE, Camera, Scene, StillMarkers, collision_node, liver, ros_master, rviz_picture,
                        wait_until)
import numpy as np
import rospy
import tf2_ros

import style

# Both tools, in the liver's frame [m].
PROBE = {'name': 'probe', 'trocar_frame': 'trocar', 'tip_frame': 'tip', 'radius': 0.004}
TROCAR, BEFORE, NOW = np.array([[-0.140, -0.02, 0.075], [-0.065, -0.045, 0.042], [-0.030, -0.020, 0.028]])
HOOK = {'name': 'hook', 'trocar_frame': 'hook_trocar', 'tip_frame': 'hook_tip', 'radius': 0.003, 'margin': 0.02,
        'max_near': 30}
HOOK_TROCAR, HOOK_TIP = (0.130, -0.02, 0.070), (0.068, 0.005, 0.032)
# Namespaces of markers.
SHOWN = {'surface/liver', 'tools', 'swept', 'touched', 'normals', 'names', 'clearance', 'near', 'status'}
CAMERA = Camera((-80, 32), (0.0, 0.0, -0.020), 0.300, (1600, 960), '40; 45; 54')


def place(point):
    return np.array([point.x, point.y, point.z])


def call_outs(mesh, probe, hook):
    """What is named, its pixel, and where the name stands. `probe`, `hook`: the answers about the tools."""
    deepest = max(probe.contacts, key=lambda contact: contact.depth)
    corners = np.reshape(mesh.vertices, (-1, 3))[list(deepest.vertices)]
    in_liver = (
        ('tools', TROCAR + 0.25 * (NOW - TROCAR), (60, 330)),
        ('swept: where\nthe axis went', 0.25 * TROCAR + 0.55 * BEFORE + 0.2 * NOW, (60, 430)),
        ('surface/liver: the organ', (-0.088, -0.030, 0.004), (60, 550)),
        ('normals of the contacts', place(deepest.on_organ) - 0.008 * place(deepest.normal), (150, 660)),
        ('touched: coloured by depth', np.mean(corners, axis=0), (560, 660)),
        ('clearance: the nearest points',
         0.5 * (place(hook.clearance.on_tool) + place(hook.clearance.on_organ)), (1060, 620)),
        ('near: faces within\nthe margin', (0.074, 0.001, 0.019), (1300, 470)))
    found = [(name, CAMERA.pixel(anchor), label) for name, anchor, label in in_liver]
    return found + [('status of each tool', (905, 727), (1180, 690))]


def draw(picture, names):
    figure = style.plt.figure(figsize=(style.WIDTH, style.WIDTH * CAMERA.size[1] / CAMERA.size[0]))
    axes = figure.add_axes((0, 0, 1, 1))
    axes.imshow(style.plt.imread(picture), interpolation='lanczos')
    axes.axis('off')
    for name, anchor, label in names:
        axes.plot(*anchor, 'o', color='white', ms=4, mec=style.TEXT, mew=0.8)
        axes.annotate(name, anchor, label, color=style.TEXT, fontsize=10, va='center',
                      bbox={'boxstyle': 'round,pad=0.3', 'fc': 'white', 'ec': 'none'},
                      arrowprops={'arrowstyle': '-', 'color': 'white', 'lw': 1.0, 'shrinkB': 2})
    style.save_picture(figure, os.path.join(HERE, 'rviz_annotated.png'), border=0)


def main():
    with ros_master('rviz_annotated'), tempfile.TemporaryDirectory() as folder:
        mesh = liver()
        with collision_node(PROBE, HOOK):
            scene = Scene(mesh, PROBE['name'], TROCAR)
            hook = tf2_ros.StaticTransformBroadcaster()
            hook.sendTransform([scene.transform(name, tip, rospy.Time.now())
                                for name, tip in (('hook_trocar', HOOK_TROCAR), ('hook_tip', HOOK_TIP))])
            markers = StillMarkers(NODE + '/markers')
            scene.play([BEFORE])
            wait_until(lambda: HOOK['name'] in scene.answers, 'the hook')
            scene.moment([BEFORE, NOW], markers, SHOWN)
            picture = os.path.join(folder, 'rviz.png')
            rviz_picture(picture, CAMERA, markers)
            draw(picture, call_outs(mesh, scene.answers[PROBE['name']], scene.answers[HOOK['name']]))


if __name__ == '__main__':
    main()
