"""A client that asks a node about batches of motions."""

import json
import subprocess
import sys


# As a planner that must not take the processors from the simulation. The node's batch threads have the same.
NICENESS = 19


class Batches:
    """The program ask_batches, in the namespace of the node that it asks."""

    def __init__(self, workspace, namespace, faces, tool):
        command = workspace.command('ask_batches', faces, tool, f'__ns:={namespace}')
        self.process = subprocess.Popen(['nice', '-n', str(NICENESS), *command], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, universal_newlines=True)

    def publish_organ(self):
        self._send('organ')
        self.end()

    def begin(self, mode, motions, seconds):
        """Starts to ask for batches of so many motions, until so many seconds have passed."""
        self._send(f'{mode} {motions} {seconds}')

    def end(self):
        """Waits until the last batch is answered. Returns the report."""
        for line in self.process.stdout:
            if line.startswith('{'):
                return json.loads(line)
        sys.exit('end_to_end: ask_batches failed')

    def _send(self, line):
        self.process.stdin.write(line + '\n')
        self.process.stdin.flush()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.stdin.close()
        self.process.terminate()
        self.process.wait()
