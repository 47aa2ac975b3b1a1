"""Runs the programs as their users do: files in, files and texts out."""

import os
import pathlib
import subprocess
import tempfile
import unittest

PROGRAM = os.environ['QUERY_OFFLINE']
MOTIONS_HEADER = ('query,mode,trocar_x,trocar_y,trocar_z,previous_x,previous_y,previous_z,'
                  'tip_x,tip_y,tip_z,radius')
CONTACTS_HEADER = 'query,face,fraction,depth,point_x,point_y,point_z,normal_x,normal_y,normal_z'


def obj_text(mesh):
    """An OBJ file of a mesh: `vertices`, and `faces` from 0."""
    lines = ['v %r %r %r' % tuple(v) for v in mesh.vertices]
    lines += ['f ' + ' '.join(str(i + 1) for i in face) for face in mesh.faces]
    return '\n'.join(lines) + '\n'


def motion_line(query, mode, trocar, previous, tip, radius):
    return ','.join([str(query), mode] + [repr(x) for x in (*trocar, *previous, *tip, radius)])


def motions_text(lines):
    return '\n'.join([MOTIONS_HEADER] + list(lines)) + '\n'


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
