"""A program that answers each line on its standard input with a line of JSON."""

import json
import subprocess
import sys


class Program:
    def __init__(self, command):
        self.name = ' '.join(command)
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, universal_newlines=True)

    def send(self, line):
        self.process.stdin.write(line + '\n')
        self.process.stdin.flush()

    def read_line(self):
        """The next answer, or the next empty line. What roscpp logs begins with an escape sequence or a bracket."""
        for line in self.process.stdout:
            if line == '\n' or line.startswith('{'):
                return line
        sys.exit(f'{self.name} failed')

    def ask(self, line):
        self.send(line)
        return json.loads(self.read_line())

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.stdin.close()
        self.process.terminate()
        self.process.wait()
