"""Answers of the collision node as numpy arrays."""

import numpy as np

from organ_collision.msg import ContactArray

_STATUSES = ('OK', 'NO_MESH', 'NO_TRANSFORM', 'STALE_MESH', 'INVALID_REQUEST', 'UNKNOWN_ORGAN', 'UNKNOWN_TOOL',
             'PICKER_FAILED', 'INVALID_TOOL')
_NAMES = {getattr(ContactArray, name): name for name in _STATUSES}

# The fields of Contact.msg.
_CONTACT = np.dtype([
    ('face', np.uint32), ('vertices', np.uint32, 3), ('link', np.uint32), ('fraction', float), ('point', float, 3),
    ('normal', float, 3), ('barycentric', float, 3), ('shaft', float), ('depth', float), ('behind', bool),
    ('end_point', float, 3), ('view_min', float), ('view_max', float)])


class CollisionError(RuntimeError):
    """The node has no answer. `status` is a status of ContactArray; the text gives its name and the node's message."""

    def __init__(self, status, message):
        super().__init__('%s: %s' % (_NAMES.get(status, 'status %d' % status), message))
        self.status = status


def contact_table(answer):
    """The contacts of a ContactArray, as a numpy record array with one row for each contact.

    Its columns are the fields of Contact.msg: contacts.depth has the shape (k,), contacts.point has (k, 3). Lengths
    are in metres, vectors in the frame answer.header.frame_id. contacts.link counts in answer.links. Raises
    CollisionError if the status is not OK: then nothing is known about contacts.
    """
    if answer.status != ContactArray.OK:
        raise CollisionError(answer.status, answer.message)
    return np.array([_row(contact) for contact in answer.contacts], dtype=_CONTACT).view(np.recarray)


def _row(c):
    return (c.face, c.vertices, c.link, c.fraction, _xyz(c.point), _xyz(c.normal), c.barycentric, c.shaft, c.depth,
            c.behind, _xyz(c.end_point), c.view_min, c.view_max)


def _xyz(point):
    return point.x, point.y, point.z
