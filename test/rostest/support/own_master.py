"""A ROS master of a test's own, which it may kill, and the nodes that use it. The test itself must not be a node of this
master: rospy does not register again either."""

import os
import signal
import socket
import subprocess
import time
import xmlrpc.client

from .node_client import LIMIT, wait_until


def free_port():
    with socket.socket() as any_socket:
        any_socket.bind(('', 0))
        return any_socket.getsockname()[1]


class OwnMaster:
    """The program that roscore runs as master, on a port of its own."""

    def __init__(self):
        self.port = free_port()
        self.uri = 'http://localhost:%d' % self.port
        self.environment = dict(os.environ, ROS_MASTER_URI=self.uri, ROS_HOSTNAME='localhost')
        self.environment.pop('ROS_IP', None)
        self.processes = []
        self.start()

    def start(self):
        self.process = subprocess.Popen(
            ['rosmaster', '--core', '-p', str(self.port)],
            env=self.environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        wait_until(lambda: self.ask('getPid'), 'the master at ' + self.uri)

    def kill(self):
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()

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

    def output(self, *words):
        """What a program prints that ends by itself."""
        return subprocess.check_output(
            list(words), env=self.environment, text=True, timeout=LIMIT, stderr=subprocess.STDOUT
        )

    def stop(self):
        self.stop_programs()
        self.kill()

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
