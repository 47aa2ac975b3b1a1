"""Answers of the collision node as numpy arrays."""

import re

import numpy as np

from organ_collision.msg import Clearance, Contact, ContactArray, Crossing

# The names of the statuses, by number: in the text of the message, they stand above the modes.
_NAMES = dict(enumerate(re.findall(r'^uint8 (\w+)=', ContactArray._full_text.split('# Modes')[0], re.MULTILINE)))

# The columns of fields that are not plain numbers.
_COLUMNS = {'geometry_msgs/Point': (float, 3), 'geometry_msgs/Vector3': (float, 3), 'float64[3]': (float, 3),
            'uint32[3]': (np.uint32, 3), 'time': (float,)}
# How the values of such fields come into a row. All others are there as they are.
_CELLS = {'geometry_msgs/Point': lambda at: (at.x, at.y, at.z), 'geometry_msgs/Vector3': lambda at: (at.x, at.y, at.z),
          'time': lambda at: at.to_sec()}


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
    return _table(answer, answer.contacts, Contact)


def contacts_of_all(answers):
    """The contacts of many ContactArrays, such as the results of a batch, as one table.

    Its columns are those of contact_table(), and `motion` before them: the number of the answer that has the contact,
    from 0. Answers whose status is not OK have no contacts: look at their status.
    """
    rows = [(motion,) + _row(contact) for motion, answer in enumerate(answers) for contact in answer.contacts]
    return np.array(rows, dtype=[('motion', np.intp)] + _columns(Contact)).view(np.recarray)


def near_table(answer):
    """The faces within the margin that are not touched, nearest first, as a table like that of contact_table().

    -near.depth is the distance of each face at its closest approach. The table is empty unless the query or the tool
    has `max_near`. answer.near_more tells whether it leaves further faces out. Raises CollisionError if the status
    is not OK.
    """
    return _table(answer, answer.near, Contact)


def crossing_table(answer):
    """Where the shaft's axis pierces the organ, from trocar to tip, as a numpy record array.

    Its columns are the fields of Crossing.msg: crossings.point has the shape (k, 3), crossings.direction is +1 where
    the axis enters and -1 where it leaves. Raises CollisionError if the status is not OK.
    """
    return _table(answer, answer.placement.crossings, Crossing)


def clearance_record(answer):
    """How far the tool is from the organ: a numpy record with the fields of Clearance.msg.

    Only if clearance.state is Clearance.KNOWN, clearance.distance and what belongs to it are set. clearance.on_tool
    and clearance.on_organ have the shape (3,). Raises CollisionError if the status is not OK.
    """
    return _table(answer, [answer.clearance], Clearance)[0]


def _table(answer, messages, kind):
    if answer.status != ContactArray.OK:
        raise CollisionError(answer.status, answer.message)
    return np.array([_row(message) for message in messages], dtype=_columns(kind)).view(np.recarray)


def _columns(kind):
    """The fields of a type of messages, in their order."""
    return [(name, *_COLUMNS.get(of, (of,))) for name, of in zip(kind.__slots__, kind._slot_types)]


def _row(message):
    return tuple([_CELLS[of](getattr(message, name)) if of in _CELLS else getattr(message, name)
                  for name, of in zip(message.__slots__, message._slot_types)])
