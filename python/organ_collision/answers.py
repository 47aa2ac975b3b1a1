"""Answers of the collision node as numpy arrays."""

import re

import numpy as np

from organ_collision.msg import ContactArray

# The names of the statuses, by number: in the text of the message, they stand above the modes.
_NAMES = dict(enumerate(re.findall(r'^uint8 (\w+)=', ContactArray._full_text.split('# Modes')[0], re.MULTILINE)))

_PLACE = [('face', np.uint32), ('vertices', np.uint32, 3), ('barycentric', float, 3)]
# The fields of Contact.msg, Crossing.msg and Clearance.msg, in their order.
_CONTACT = np.dtype([
    ('face', np.uint32), ('vertices', np.uint32, 3), ('link', np.int32), ('touching', bool), ('since', float),
    ('fraction', float), ('point', float, 3), ('normal', float, 3), ('barycentric', float, 3), ('shaft', float),
    ('depth', float), ('behind', bool), ('on_organ', float, 3), ('velocity', float, 3),
    ('on_tool', float, 3)])
_CROSSING = np.dtype(_PLACE + [('shaft', float), ('point', float, 3), ('direction', np.int8)])
_CLEARANCE = np.dtype(
    [('state', np.uint8), ('margin', float), ('unlimited', bool), ('distance', float), ('least', float),
     ('least_fraction', float)] + _PLACE +
    [('link', np.int32), ('on_organ', float, 3), ('on_tool', float, 3), ('normal', float, 3),
     ('normal_defined', bool), ('unresolved', bool), ('closing_speed', float)])


class CollisionError(RuntimeError):
    """The node has no answer. `status` is a status of ContactArray; the text gives its name and the node's message."""

    def __init__(self, status, message):
        super().__init__('%s: %s' % (_NAMES.get(status, 'status %d' % status), message))
        self.status = status


def contact_table(answer):
    """The contacts of a ContactArray, as a numpy record array with one row for each contact.

    Its columns are the fields of Contact.msg: contacts.depth has the shape (k,), contacts.point has (k, 3). Lengths
    are in metres, contacts.since is in seconds, vectors are in the frame answer.header.frame_id. contacts.link counts
    in answer.links; -1 is the shaft. Raises CollisionError if the status is not OK: then nothing is known about
    contacts.
    """
    return _table(answer, answer.contacts, _CONTACT, _contact_row)


def contacts_of_all(answers):
    """The contacts of many ContactArrays, such as the results of a batch, as one table.

    Its columns are those of contact_table(), and `motion` before them: the number of the answer that has the contact,
    from 0. Answers whose status is not OK have no contacts: look at their status.
    """
    columns = np.dtype([('motion', np.intp)] + [(name, _CONTACT[name]) for name in _CONTACT.names])
    rows = [(motion,) + _contact_row(contact) for motion, answer in enumerate(answers) for contact in answer.contacts]
    return np.array(rows, dtype=columns).view(np.recarray)


def near_table(answer):
    """The faces within the margin that are not touched, nearest first, as a table like that of contact_table().

    -near.depth is the distance of each face at its closest approach. The table is empty unless the query or the tool
    has `max_near`. answer.near_more tells whether it leaves further faces out. Raises CollisionError if the status
    is not OK.
    """
    return _table(answer, answer.near, _CONTACT, _contact_row)


def crossing_table(answer):
    """Where the shaft's axis pierces the organ, from trocar to tip, as a numpy record array.

    Its columns are the fields of Crossing.msg: crossings.point has the shape (k, 3), crossings.direction is +1 where
    the axis enters and -1 where it leaves. Raises CollisionError if the status is not OK.
    """
    return _table(answer, answer.placement.crossings, _CROSSING, _crossing_row)


def clearance_record(answer):
    """How far the tool is from the organ: a numpy record with the fields of Clearance.msg.

    Only if clearance.state is Clearance.KNOWN, clearance.distance and what belongs to it are set. clearance.on_tool
    and clearance.on_organ have the shape (3,). Raises CollisionError if the status is not OK.
    """
    return _table(answer, [answer.clearance], _CLEARANCE, _clearance_row)[0]


def _table(answer, messages, columns, row):
    if answer.status != ContactArray.OK:
        raise CollisionError(answer.status, answer.message)
    return np.array([row(message) for message in messages], dtype=columns).view(np.recarray)


def _contact_row(c):
    return (c.face, c.vertices, c.link, c.touching, c.since.to_sec(), c.fraction, _xyz(c.point), _xyz(c.normal),
            c.barycentric, c.shaft, c.depth, c.behind, _xyz(c.on_organ), _xyz(c.velocity), _xyz(c.on_tool))


def _crossing_row(c):
    return (c.face, c.vertices, c.barycentric, c.shaft, _xyz(c.point), c.direction)


def _clearance_row(c):
    return (c.state, c.margin, c.unlimited, c.distance, c.least, c.least_fraction, c.face, c.vertices, c.barycentric,
            c.link, _xyz(c.on_organ), _xyz(c.on_tool), _xyz(c.normal), c.normal_defined, c.unresolved,
            c.closing_speed)


def _xyz(point):
    return point.x, point.y, point.z
