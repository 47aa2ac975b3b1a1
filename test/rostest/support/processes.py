"""Nodes, launch files and ROS masters that a test starts and stops itself."""

import os
import shlex
import signal
import socket
import subprocess
import tempfile
import time
import unittest
import xmlrpc.client

import roslib.packages
import rosgraph
import rospy

from .node_client import LIMIT, wait_until


def program(name, package='organ_collision'):
    """The path of a program."""
    return roslib.packages.find_node(package, name)[0]


def nodelet(*words):
    """The words of a command that runs the program `nodelet`, under what ORGAN_COLLISION_NODELET_PREFIX says."""
    prefix = os.environ.get('ORGAN_COLLISION_NODELET_PREFIX', '')
    return [*(shlex.split(prefix) if words[0] != 'load' else ()), program('nodelet', 'nodelet'), *words]


def process_of(node):
    """The process id of a node."""
    address = rosgraph.Master(rospy.get_name()).lookupNode(node)
    return xmlrpc.client.ServerProxy(address).getPid(rospy.get_name())[2]


class NodeStarter(unittest.TestCase):
    """Starts and stops nodes within a test, as roslaunch does."""

    def start(self, name, parameters, node='organ_collision_node', through=(), arguments=()):
        """Starts a node with these private parameters. It is killed at the end of the test at the latest. `through`:
        the words of a command that runs the node's command."""
        if parameters:
            rospy.set_param(name, parameters)
        process = subprocess.Popen([*through, program(node), *arguments, '__name:=' + name.strip('/')],
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def stop(self, process, code=0):
        """Stops the node with SIGINT, checks its exit code, and returns its output."""
        process.send_signal(signal.SIGINT)
        printed, _ = process.communicate(timeout=LIMIT)
        self.assertEqual(process.returncode, code, printed)
        return printed

    def assert_refused(self, process, words):
        """Checks that the node exits with an error by itself, and that it prints all `words`."""
        printed, _ = process.communicate(timeout=30)
        self.assertGreater(process.returncode, 0, printed)  # negative: killed by a signal
        for word in words:
            self.assertIn(word, printed, words)


def nodes_online():
    """The names of all nodes that the ROS master knows."""
    state = rosgraph.Master(rospy.get_name()).getSystemState()
    return {node for group in state for _, nodes in group for node in nodes}


class Launched:
    """Runs roslaunch with one file until the end of a `with` block. `printed` is then its output. `arguments`: the
    file's, as NAME:=VALUE."""

    def __init__(self, path, *arguments):
        self.words, self.output = [path, *arguments], tempfile.TemporaryFile(mode='w+')
        self.nodes = subprocess.check_output(['roslaunch', '--nodes', *self.words], text=True).split()

    def __enter__(self):
        self.process = subprocess.Popen(['roslaunch', *self.words], stdout=self.output, stderr=subprocess.STDOUT)
        return self

    def wait_for_nodes(self):
        wait_until(lambda: self.process.poll() is not None or set(self.nodes) <= nodes_online(),
                   'the nodes %s' % self.nodes)

    def __exit__(self, *error):
        self.process.send_signal(signal.SIGINT)
        self.process.wait(timeout=40)
        self.output.seek(0)
        self.printed = self.output.read()


def free_port():
    with socket.socket() as any_socket:
        any_socket.bind(('', 0))
        return any_socket.getsockname()[1]


class OwnMaster:
    """The program that roscore runs as master, on a port of its own, and the programs that use it."""

    def __init__(self):
        self.port = free_port()
        self.uri = 'http://localhost:%d' % self.port
        self.environment = dict(os.environ, ROS_MASTER_URI=self.uri, ROS_HOSTNAME='localhost')
        self.environment.pop('ROS_IP', None)
        self.processes = []
        self.start()

    def start(self):
        self.master = subprocess.Popen(['rosmaster', '--core', '-p', str(self.port)], env=self.environment,
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        wait_until(lambda: self.ask('getPid'), 'the master at ' + self.uri)

    def kill(self):
        self.master.kill()
        self.master.wait()

    def ask(self, method, *arguments):
        """What the master answers; None if it does not, or refuses."""
        try:
            with xmlrpc.client.ServerProxy(self.uri) as master:
                code, _, answer = getattr(master, method)('/test', *arguments)
        except (OSError, xmlrpc.client.Error):
            return None
        return answer if code == 1 else None

    def record(self):
        """{(kind, name, node)} of all publishers, subscribers and services."""
        kinds = zip(('publisher', 'subscriber', 'service'), self.ask('getSystemState') or ([], [], []))
        return {(kind, name, node) for kind, names in kinds for name, nodes in names for node in nodes}

    def run(self, *words, **options):
        """Starts a program that uses this master, and runs until stop()."""
        process = subprocess.Popen(list(words), env=self.environment, **options)
        self.processes.append(process)
        return process

    def stop_programs(self):
        for process in reversed(self.processes):
            if process.poll() is None:
                process.terminate()
        end = time.monotonic() + 5.0
        for process in self.processes:
            try:
                process.wait(max(0.0, end - time.monotonic()))
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        self.processes = []

    def stop(self):
        self.stop_programs()
        self.kill()
