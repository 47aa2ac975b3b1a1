"""Runs the programs as their users do: files in, files and texts out."""

import os
import pathlib
import subprocess
import tempfile
import unittest

PROGRAM = os.environ['QUERY_OFFLINE']
CONTACTS_HEADER = 'query,face,fraction,depth,point_x,point_y,point_z,normal_x,normal_y,normal_z'


class ProgramCase(unittest.TestCase):
    """A folder of its own for each test, which is the programs' working directory."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, text):
        (self.folder / name).write_bytes(text if isinstance(text, bytes) else text.encode())

    def run_program(self, *arguments, program=PROGRAM, text='', **environment):
        """What a program did with `text` as its standard input: `returncode`, `stdout` and `stderr`. No ROS master can
        be reached."""
        return subprocess.run([program, *arguments], cwd=self.folder, input=text, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, text=True, errors='backslashreplace', timeout=100,
                              env={**os.environ, 'ROS_MASTER_URI': 'http://localhost:1', **environment})

    def contacts(self, *arguments):
        """The rows that query_offline prints, each a list of its cells; it must succeed."""
        done = self.run_program(*arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        header, *rows = done.stdout.split('\n')[:-1]
        self.assertEqual(header, CONTACTS_HEADER)
        return [row.split(',') for row in rows]
