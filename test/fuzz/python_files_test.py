#!/usr/bin/python3
"""Broken OBJ files give Python's reader either a mesh or a MeshFileError."""

import pathlib
import random
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
        generator, read = random.Random(1), 0
        contents = [file.read_bytes() for file in sorted(CORPUS.iterdir())]
        with tempfile.NamedTemporaryFile(suffix='.obj') as file:
            path = pathlib.Path(file.name)
            for _ in range(MUTATIONS):
                content = mutated(generator.choice(contents), generator)
                path.write_bytes(content)
                with self.subTest(content):
                    try:
                        vertices, faces = read_obj(str(path))
                    except MeshFileError:
                        continue
                    read += 1
                    self.assertTrue(not len(faces) or 0 <= np.min(faces) <= np.max(faces) < len(vertices))
        self.assertGreater(read, MUTATIONS // 10)


if __name__ == '__main__':
    unittest.main()
