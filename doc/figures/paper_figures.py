#!/usr/bin/python3
"""Redoes figures 9 and 10 of the 1999 paper: starts the node with the demo's liver and one tool, and
takes pictures of its markers. Writes paper_figure_9.png and paper_figure_10.png beside this file.

Usage: . devel/setup.bash && doc/figures/paper_figures.py
"""

import contextlib
import os
import signal
import socket
import subprocess
import threading
import time

from geometry_msgs.msg import TransformStamped
from organ_collision.msg import ContactArray, OrganMesh
import rosgraph
import rospy
from std_srvs.srv import Empty
from tf2_msgs.msg import TFMessage
import yaml

HERE = os.path.dirname(os.path.abspath(__file__))
NODE = '/organ_collision'
# The tool, in the liver's frame [m]. It is thin, like the segment in the paper's figures.
TOOL = {'name': 'tool', 'trocar_frame': 'trocar', 'tip_frame': 'tip', 'radius': 0.002}
TROCAR = (0.030, 0.080, 0.150)
BEFORE, AFTER = (-0.070, -0.020, 0.015), (0.020, -0.035, 0.010)
LIMIT = 60.0  # [s] longest wait for anything
COLOURS = {'markers_depth': 0.25}  # [m] Touched faces are yellow to red, and easy to see.
PERIOD = 0.2  # [s] from one step to its repetition, so that its traces do not fade

CAMERA = ['--view', '-80,45', '--target', '0.0,0.0,0.025', '--distance', '0.27']
PICTURE = ['--size', '720x540', '--background', '#ffffff', '--after', '1', '--timeout', str(LIMIT)]
HIDDEN = ['--hide', 'normals', '--hide', 'names', '--hide', 'status']


@contextlib.contextmanager
def started(*command):
    """Runs a command until the end of a `with` block."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    try:
        yield process
    finally:
        process.send_signal(signal.SIGINT)
        process.wait()


def wait_until(condition, what):
    end = time.monotonic() + LIMIT
    while not condition():
        if time.monotonic() > end:
            raise SystemExit('paper_figures: waited %g s for %s' % (LIMIT, what))
        time.sleep(0.01)


def free_port():
    with socket.socket() as free:
        free.bind(('', 0))
        return free.getsockname()[1]


def liver():
    """The demo's liver at rest: the first mesh of the demo's simulator."""
    with open(os.path.join(HERE, '..', '..', 'config', 'demo_tools.yaml')) as tools:
        rospy.set_param('/demo', yaml.safe_load(tools))
    with started('rosrun', 'organ_collision', 'organ_collision_node', '__name:=demo'):
        with started('rosrun', 'organ_collision', 'liver_simulator', '_collision_node:=/demo'):
            return rospy.wait_for_message('/demo/organ_mesh', OrganMesh, LIMIT)


class Scene:
    """The resting liver, and the tool that moves in steps."""

    def __init__(self, mesh):
        rospy.wait_for_service(NODE + '/reset', LIMIT)
        self.reset = rospy.ServiceProxy(NODE + '/reset', Empty)
        self.answered = None
        self.mesh = mesh
        self.tf = rospy.Publisher('/tf', TFMessage, queue_size=10)
        self.meshes = rospy.Publisher(NODE + '/organ_mesh', OrganMesh, queue_size=10)
        self.contacts = rospy.Subscriber(NODE + '/contacts', ContactArray, self.note)
        wait_until(
            lambda: self.tf.get_num_connections() > 0
            and self.meshes.get_num_connections() > 0
            and self.contacts.get_num_connections() > 0,
            'connections to ' + NODE,
        )

    def note(self, answer):
        if answer.status == ContactArray.OK:
            self.answered = answer.mesh_stamp

    def transform(self, child, place, stamp):
        transform = TransformStamped(child_frame_id=child)
        transform.header.frame_id, transform.header.stamp = self.mesh.header.frame_id, stamp
        translation = transform.transform.translation
        translation.x, translation.y, translation.z = place
        transform.transform.rotation.w = 1.0
        return transform

    def move_tool(self, tip):
        """Moves the tip there, and waits for the node's answer."""
        stamp = rospy.Time.now()
        self.tf.publish(
            [self.transform('trocar', TROCAR, stamp), self.transform('tip', tip, stamp)]
        )
        self.mesh.header.stamp = stamp
        self.meshes.publish(self.mesh)
        wait_until(lambda: self.answered == stamp, 'contacts')

    def play(self, tips):
        """Moves the tool through these tips. The reset makes the first one a static position."""
        self.reset()
        for tip in tips:
            self.move_tool(tip)

    def repeat(self, tips, end):
        """Plays the same steps again and again until the event `end`."""
        while not end.wait(PERIOD):
            self.play(tips)

    def show(self, tips, file):
        """Takes a picture of the tool's last step through `tips`."""
        self.play(tips)
        end = threading.Event()
        motion = threading.Thread(target=self.repeat, args=(tips, end))
        motion.start()
        command = ['rosrun', 'organ_collision', 'snapshot', *CAMERA, *PICTURE, *HIDDEN]
        try:
            subprocess.run([*command, '--output', os.path.join(HERE, file)], check=True)
        finally:
            end.set()
            motion.join()


def main():
    port = free_port()
    os.environ['ROS_MASTER_URI'] = 'http://localhost:%d' % port
    os.environ['ROS_HOSTNAME'] = 'localhost'
    with started('roscore', '-p', str(port)):
        wait_until(rosgraph.is_master_online, 'the ROS master')
        rospy.init_node('paper_figures', disable_signals=True)
        mesh = liver()
        rospy.set_param(NODE, {'tools': [TOOL], 'tf_timeout_sec': LIMIT, **COLOURS})
        with started('rosrun', 'organ_collision', 'organ_collision_node', '__name:=' + NODE[1:]):
            scene = Scene(mesh)
            scene.show([BEFORE], 'paper_figure_9.png')
            scene.show([BEFORE, AFTER], 'paper_figure_10.png')


if __name__ == '__main__':
    main()
