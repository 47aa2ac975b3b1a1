"""Organs, queries and contacts of the collision node as numpy arrays. doc/python.md shows how to use them.

The messages and services are in organ_collision.msg and organ_collision.srv. Programs that need only these do not load
rospy: each name below is loaded when it is first used.
"""

import importlib

_MODULES = {
    'CollisionError': 'answers',
    'clearance_record': 'answers',
    'contact_table': 'answers',
    'contacts_of_all': 'answers',
    'crossing_table': 'answers',
    'near_table': 'answers',
    'MeshFileError': 'mesh_files',
    'read_mesh': 'mesh_files',
    'write_ply': 'mesh_files',
    'link_motions': 'messages',
    'organ_mesh': 'messages',
    'organ_vertices': 'messages',
    'shaft_motion': 'messages',
    'shaft_motions': 'messages',
    'Organ': 'organ',
    'Queries': 'queries',
}
__all__ = sorted(_MODULES)


def __getattr__(name):
    if name not in _MODULES:
        raise AttributeError('module %r has no attribute %r' % (__name__, name))
    return getattr(importlib.import_module('%s.%s' % (__name__, _MODULES[name])), name)


def __dir__():
    return sorted([*globals(), *_MODULES])
