"""A client that asks a node about batches of motions."""

import json

from program import Program


# As a planner that must not take the processors from the simulation. The node's batch threads have the same.
NICENESS = 19


class Batches(Program):
    """The program ask_batches, in the namespace of the node that it asks."""

    def __init__(self, workspace, namespace, faces, tool):
        command = workspace.command('ask_batches', faces, tool, f'__ns:={namespace}')
        super().__init__(['nice', '-n', str(NICENESS), *command])

    def publish_organ(self):
        self.ask('organ')

    def begin(self, mode, motions, seconds):
        """Starts to ask for batches of so many motions, until so many seconds have passed."""
        self.send(f'{mode} {motions} {seconds}')

    def end(self):
        """Waits until the last batch is answered. Returns the report."""
        return json.loads(self.read_line())
