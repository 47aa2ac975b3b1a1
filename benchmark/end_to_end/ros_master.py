"""A ROS master of the measurements' own."""

import os
import socket
import subprocess
import sys
import time
import xmlrpc.client

CALLER = '/end_to_end'


def free_port():
    with socket.socket() as any_socket:
        any_socket.bind(('', 0))
        return any_socket.getsockname()[1]


class Master:
    """A roscore that runs until its `with` block ends. Programs that start within the block find it."""

    def __enter__(self):
        port = free_port()
        os.environ['ROS_MASTER_URI'] = f'http://localhost:{port}'
        self.process = subprocess.Popen(['roscore', '-p', str(port)], stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        self.proxy = xmlrpc.client.ServerProxy(os.environ['ROS_MASTER_URI'])
        self._wait_for(lambda: self.proxy.lookupNode(CALLER, '/rosout')[0] == 1, 'roscore')
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()

    def set_parameters(self, node, parameters):
        """Sets all parameters of a node, and deletes those that it had."""
        self.proxy.setParam(CALLER, node, parameters)

    def wait_for_service(self, name):
        self._wait_for(lambda: self.proxy.lookupService(CALLER, name)[0] == 1, name)

    @staticmethod
    def _wait_for(condition, what, seconds=30):
        give_up = time.monotonic() + seconds
        while True:
            try:
                if condition():
                    return
            except OSError:
                pass  # not listening yet
            if time.monotonic() > give_up:
                sys.exit(f'end_to_end: no answer from {what}')
            time.sleep(0.05)
