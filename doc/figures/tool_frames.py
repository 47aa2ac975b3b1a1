"""Which frames place a shaft, a shaft that sends poses, and a tool of links."""

import matplotlib.pyplot as plt
import numpy as np

import style


def turned(angle):
    angle = np.radians(angle)
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def draw_frame(axes, place, angle, name, offset, color=style.TEXT, **options):
    for i, shade in enumerate((style.FACE, style.BOUND)):
        style.arrow(axes, place, place + 0.55 * turned(angle)[:, i], shade, width=1.6)
    axes.plot(*place, 'o', color=color, ms=5)
    style.label(axes, np.asarray(place) + offset, name, color, **options)


def bar(axes, start, end, width, color=style.TOOL):
    start, end = np.asarray(start, float), np.asarray(end, float)
    way = (end - start) / np.linalg.norm(end - start)
    side = 0.5 * width * np.array([-way[1], way[0]])
    axes.add_patch(plt.Polygon([start + side, end + side, end - side, start - side], fc=color,
                               alpha=0.25, lw=0))


def draw_known(axes, place, text):
    style.label(axes, place, text, ha='center', va='top')


def draw_shaft_by_tf(axes):
    style.drawing(axes, 'A shaft: two frames in TF')
    trocar, tip = np.array([0.0, 4.0]), np.array([1.2, 0.6])
    bar(axes, trocar, tip, 0.3)
    draw_frame(axes, trocar, 20, 'trocar_frame', [-0.2, 0.2], ha='right')
    draw_frame(axes, tip, -35, 'tip_frame', [-0.2, -0.15], ha='right', va='top')
    draw_known(axes, [0.6, -0.9], 'TF places both. Only their\norigins count, not their axes')
    axes.set_xlim(-2.6, 3.4)
    axes.set_ylim(-2.3, 5.2)


def draw_shaft_by_poses(axes):
    style.drawing(axes, 'A shaft that sends poses')
    trocar, tip = np.array([0.0, 4.0]), np.array([1.2, 0.6])
    bar(axes, trocar, tip, 0.3)
    draw_frame(axes, trocar, 20, 'trocar_frame,\nthe frame of the poses', [-0.2, 0.1], ha='right')
    draw_frame(axes, tip, -35, 'tip_frame', [-0.2, -0.15], style.TOOL, ha='right', va='top')
    axes.annotate('', tip + [0.1, 0.2], trocar + [0.2, 0.05],
                  arrowprops={'arrowstyle': '-|>', 'color': style.TOOL, 'lw': 1.5,
                              'connectionstyle': 'arc3,rad=-0.35'})
    style.label(axes, [1.5, 2.9], 'message on\ntip_pose_topic', style.TOOL)
    draw_known(axes, [0.8, -0.9], 'Each message places the tip in the frame\nthat header.frame_id '
               'names. TF (or\nbase_pose_topic) places that frame')
    axes.set_xlim(-2.6, 3.6)
    axes.set_ylim(-2.3, 5.2)


def draw_links(axes):
    style.drawing(axes, 'A tool of links that sends poses')
    base, first = np.array([-1.8, 4.0]), np.array([0.0, 2.6])
    wrist, jaws = np.array([1.0, 1.3]), [np.array([2.3, 0.7]), np.array([1.7, 0.05])]
    bar(axes, first, wrist, 0.5)
    for jaw in jaws:
        bar(axes, wrist, jaw, 0.22)
    draw_frame(axes, base, 10, 'frame of the poses', [0.75, 0.0], va='center')
    draw_frame(axes, first, -50, 'stylus_body = first of `links`\n= tip_frame, if you name no other',
               [0.45, 0.35], style.TOOL)
    draw_frame(axes, wrist, -35, 'left and right jaw:\nTF places them below\nthe first link',
               [-0.25, -0.6], ha='right', va='top')
    axes.annotate('', first + [-0.08, 0.08], base + [0.1, -0.05],
                  arrowprops={'arrowstyle': '-|>', 'color': style.TOOL, 'lw': 1.5,
                              'connectionstyle': 'arc3,rad=0.3'})
    style.label(axes, [-1.7, 2.35], 'message on\ntip_pose_topic', style.TOOL, ha='right')
    draw_known(axes, [0.6, -1.15], 'The message places one frame: the origin and\nthe axes of tip_frame. '
               'All other links hang on it')
    axes.set_xlim(-4.4, 6.8)
    axes.set_ylim(-2.1, 5.2)


def draw():
    figure, (by_tf, by_poses, links) = style.two_and_one(6.6, (1, 0.95))
    draw_shaft_by_tf(by_tf)
    draw_shaft_by_poses(by_poses)
    draw_links(links)
    return figure
