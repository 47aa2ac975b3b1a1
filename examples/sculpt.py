#!/usr/bin/python3
"""A ball carves a groove into a block of clay at 500 Hz. The program knows the clay and where the ball goes, but not its
radius: the vertices, `on_organ` and the depth of the contacts alone tell how the clay gives way.

Parameters: ~seconds until the groove is done; ~save: a file of numpy (.npz) with the clay's vertices and faces then.
"""

import argparse
import queue
import threading

from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
import numpy as np
from organ_collision import Organ
from organ_collision.recordings import decoder
import rospy
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

CELL, CELLS, HEIGHT = 0.001, (64, 44), 0.012  # [m], of the top in each direction, [m]
TOP_VERTICES = (CELLS[0] + 1) * (CELLS[1] + 1)
RATE = 500                                    # [Hz]
TOP, DEEPEST = 0.007, 0.0035                  # [m] height of the ball's centre above the clay at first and in the groove
PATIENCE = 1.0                                # [s] for an answer


def block():
    """The vertices, n x 3 [m], and faces, m x 3, of a closed block. Its top is a grid at z = 0; that comes first."""
    columns, rows = CELLS[0] + 1, CELLS[1] + 1
    x, y = np.meshgrid(CELL * (np.arange(columns) - CELLS[0] / 2), CELL * (np.arange(rows) - CELLS[1] / 2))
    top = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    number = np.arange(x.size).reshape(rows, columns)
    a, b, c, d = (part.ravel() for part in (number[:-1, :-1], number[:-1, 1:], number[1:, :-1], number[1:, 1:]))
    rim = np.concatenate([number[0, :-1], number[:-1, -1], number[-1, :0:-1], number[:0:-1, 0]])
    foot = x.size + np.arange(len(rim))
    vertices = np.concatenate([top, top[rim] - [0, 0, HEIGHT], [[0, 0, -HEIGHT]]])
    after, foot_after, centre = np.roll(rim, -1), np.roll(foot, -1), np.full(len(rim), len(vertices) - 1)
    faces = [(a, b, d), (a, d, c), (rim, foot, foot_after), (rim, foot_after, after), (foot_after, foot, centre)]
    return vertices, np.concatenate([np.stack(face, axis=1) for face in faces])


def ball(share):
    """The ball's centre [m] on its way: down, along the groove, and up."""
    turn = 2 * np.pi * min(1.0, max(0.0, (share - 0.1) / 0.8))
    down = min(1.0, 10 * share, 10 * (1 - share))
    return 0.02 * np.sin(2 * turn), 0.012 * np.sin(3 * turn), TOP + (DEEPEST - TOP) * down


def carve(vertices, contacts):
    """Lowers the vertices of the touched faces. A face goes down by its depth at the place `on_organ`; its vertices share
    this as they share the place, and a vertex of several faces follows the deepest one."""
    contacts = contacts[contacts['touching'] & (contacts['depth'] > 0)]
    corners = contacts['vertices']
    a, b, c = (vertices[corners[:, i]] for i in range(3))
    place = np.stack([contacts['on_organ.' + axis] for axis in 'xyz'], axis=1) - a
    edges = np.stack([b - a, c - a], axis=2)
    weights = np.linalg.solve(edges.swapaxes(1, 2) @ edges, edges.swapaxes(1, 2) @ place[:, :, None])[:, :, 0]
    weights = np.clip(np.column_stack([1 - weights.sum(axis=1), weights]), 0, 1)
    lower = np.zeros(len(vertices))
    np.maximum.at(lower, corners, contacts['depth'][:, None] * weights / weights.max(axis=1, keepdims=True))
    vertices[:, 2] -= lower


def sculpt(answers, frames):
    """Moves the ball and the clay in turn: the next step comes when the answer about this one is there."""
    vertices, faces = block()
    clay, tick, ticks = Organ('clay', vertices, faces), 0, int(RATE * rospy.get_param('~seconds', 12.0))
    read = decoder('organ_collision/ContactArray', 'mesh_stamp status message contacts')
    while tick <= ticks and not rospy.is_shutdown():
        now = rospy.Time.now()
        frames.publish([TransformStamped(Header(0, now, 'clay'), 'ball', Transform(
            Vector3(*ball(tick / ticks)), Quaternion(0, 0, 0, 1)))])
        clay.move(vertices, now)
        try:
            stamp = ()
            while stamp != [now.secs, now.nsecs]:  # It is about an earlier shape.
                *stamp, status, message, contacts = read(answers.get(timeout=PATIENCE))
        except queue.Empty:
            rospy.logwarn_throttle(1, 'no answer about the clay')
            continue
        if status:
            rospy.logwarn_throttle(1, message)
            continue
        if tick == 0:
            begin = rospy.get_time()
        if len(contacts):
            carve(vertices, contacts)
        tick += 1
        if tick % (2 * RATE) == 0:
            rospy.loginfo('carved %.2f mm deep, at %.0f Hz', -1e3 * vertices[:TOP_VERTICES, 2].min(),
                          tick / (rospy.get_time() - begin))
        rospy.sleep(begin + tick / RATE - rospy.get_time())  # A late step does not delay those after it: rospy.Rate would.
    if rospy.get_param('~save', '') and tick > ticks:
        np.savez(rospy.get_param('~save'), vertices=vertices, faces=faces)


def main():
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args(
        rospy.myargv()[1:])
    rospy.init_node('sculpt')
    # Without tcp_nodelay, as in tf2_ros, a transform waits up to 40 ms for the confirmation of the one before.
    answers, frames = queue.Queue(), rospy.Publisher('/tf', TFMessage, queue_size=10, tcp_nodelay=True)
    # The bytes of the answers: rospy needs 4 ms to make objects of 250 contacts.
    contacts = rospy.Subscriber('/organ_collision/contacts', rospy.AnyMsg, lambda answer: answers.put(answer._buff),
                                tcp_nodelay=True)
    while (frames.get_num_connections() == 0 or contacts.get_num_connections() == 0) and not rospy.is_shutdown():
        rospy.sleep(0.05)
    # In a thread of its own: rospy deadlocks if Ctrl-C finds the main thread in a publish.
    threading.Thread(target=sculpt, args=(answers, frames), daemon=True).start()
    rospy.spin()


if __name__ == '__main__':
    main()
