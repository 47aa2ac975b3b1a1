"""The program motions_benchmark: CollisionQuery and FCL, without ROS."""

import json
import subprocess
import sys


class Library:
    def __init__(self, workspace, faces, tool):
        self.process = subprocess.Popen(workspace.command('motions_benchmark', faces, tool), stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, universal_newlines=True)

    def rate(self, engine, threads, seconds):
        """The motions a second of an engine, on so many threads."""
        return self._ask(f'{engine} {threads} {seconds}')['motions_per_second']

    def compare(self):
        """How far FCL's answers are from the library's."""
        return self._ask('compare')

    def write_files(self, motions, folder):
        """Writes the organ, so many motions, and the robot, into a folder."""
        self._ask(f'write {motions} {folder}')

    def _ask(self, line):
        self.process.stdin.write(line + '\n')
        self.process.stdin.flush()
        answer = self.process.stdout.readline()
        if not answer:
            sys.exit(f'motions.py: motions_benchmark failed at "{line}"')
        return json.loads(answer)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.stdin.close()
        self.process.wait()
