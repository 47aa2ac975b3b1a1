#!/usr/bin/python3
"""Broken OBJ files give either a mesh or a MeshFileError. A fuzz target keeps the input that ended it.

Usage: python_files_test.py FUZZ_TARGET
"""

import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import unittest

import numpy as np
from organ_collision.mesh_files import MeshFileError, read_obj

CORPUS = pathlib.Path(__file__).resolve().parent / 'corpus' / 'obj_file'
MUTATIONS = 1000
TOKENS = [b'-1', b'0', b'99999999999999999999', b'1e999', b'nan', b'/', b'//', b'#', b'\n', b'\r', b'f', b'v', b' ',
          b'\0', b'\xff\xfe', b'_', b'1_0', '\u0663'.encode()]


def mutated(content, generator):
    """The content, changed in one to four places."""
    content = bytearray(content)
    for _ in range(generator.randint(1, 4)):
        at = generator.randint(0, len(content))
        end = min(len(content), at + generator.randint(0, 8))
        content[at:end] = generator.choice([generator.choice(TOKENS), b'', content[at:end] * 2,
                                            bytes([generator.randrange(256)])])
    return bytes(content)


class PythonFilesTest(unittest.TestCase):
    def test_broken_obj_files(self):
        generator = random.Random(1)
        contents = [file.read_bytes() for file in sorted(CORPUS.iterdir())]
        read = 0
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / 'organ.obj'
            for number in range(MUTATIONS):
                content = mutated(generator.choice(contents), generator)
                path.write_bytes(content)
                with self.subTest(content):
                    try:
                        vertices, faces = read_obj(str(path))
                    except MeshFileError:
                        continue
                    read += 1
                    self.assertTrue(not len(faces) or np.max(faces) < len(vertices))
                    self.assertTrue(not len(faces) or np.min(faces) >= 0)
        self.assertGreater(read, MUTATIONS // 10)


def handles(process, number):
    """Whether the process has a handler of this signal."""
    status = pathlib.Path('/proc/%d/status' % process.pid).read_text()
    return int(status.split('SigCgt:')[1].split()[0], 16) >> (number - 1) & 1


class FailedInputTest(unittest.TestCase):
    def test_it_is_kept_beside_the_program_and_not_where_the_program_was_started(self):
        kept = pathlib.Path(TARGET + '.failed_input')
        kept.unlink(missing_ok=True)
        with tempfile.TemporaryDirectory() as folder:
            command = [TARGET, str(CORPUS.with_name('feedback')), '1000000000']
            with subprocess.Popen(command, cwd=folder, stderr=subprocess.PIPE, text=True) as process:
                while not handles(process, signal.SIGABRT):
                    self.assertIsNone(process.poll())
                process.send_signal(signal.SIGABRT)
                said = process.communicate()[1]
            self.assertEqual(process.returncode, -signal.SIGABRT)
            self.assertIn(str(kept), said)
            self.assertEqual(os.listdir(folder), [])
        kept.unlink()


if __name__ == '__main__':
    TARGET = sys.argv.pop()
    unittest.main()
