#!/usr/bin/python3
"""Saves a mesh of any type that read_mesh reads as a binary STL file: save_stl.py FROM TO"""

import sys

import numpy as np
from organ_collision import read_mesh

vertices, faces = read_mesh(sys.argv[1])
triangles = np.zeros(len(faces), [('normal', '<3f4'), ('corners', '<9f4'), ('attribute', '<u2')])
triangles['corners'] = vertices[faces].reshape(-1, 9)
with open(sys.argv[2], 'wb') as file:
    file.write(bytes(80) + np.uint32(len(faces)).tobytes() + triangles.tobytes())
