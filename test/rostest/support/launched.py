"""Runs launch files of the package as a user would."""

import signal
import subprocess
import tempfile

import rosgraph
import rospy

from .node_client import wait_until


def nodes_online():
    """The names of all nodes that the ROS master knows."""
    publishers, subscribers, services = rosgraph.Master(rospy.get_name()).getSystemState()
    return {
        node
        for group in (publishers, subscribers, services)
        for _, nodes in group
        for node in nodes
    }


class Launched:
    """Runs roslaunch with one file until the end of a `with` block. `printed` is then its
    output. `arguments`: the file's, as NAME:=VALUE."""

    def __init__(self, path, *arguments):
        self.words, self.output = [path, *arguments], tempfile.TemporaryFile(mode='w+')
        listed = subprocess.check_output(
            ['roslaunch', '--nodes', *self.words], universal_newlines=True
        )
        self.nodes = listed.split()

    def __enter__(self):
        self.process = subprocess.Popen(
            ['roslaunch', *self.words], stdout=self.output, stderr=subprocess.STDOUT
        )
        return self

    def wait_for_nodes(self):
        wait_until(
            lambda: self.process.poll() is not None or set(self.nodes) <= nodes_online(),
            'the nodes %s' % self.nodes,
        )

    def __exit__(self, *error):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(timeout=40)
        self.output.seek(0)
        self.printed = self.output.read()
