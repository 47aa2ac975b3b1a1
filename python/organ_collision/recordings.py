"""Recorded and running topics, fast: bags in one pass of bounded memory, and messages from their bytes without a Python
object for each contact. rosbag's own reader first indexes all messages in memory, and refuses a bag that was cut. rospy
needs about 15 us for each contact."""

import bz2
from collections import namedtuple
import functools
import io
import itertools
import os
import struct
import sys
import threading
import time
from types import SimpleNamespace

import genpy.message
import numpy as np
import rospy

LARGEST = 1 << 30  # [bytes] A longer record is none: the file is damaged there.
_UINT32 = struct.Struct('<I')
_MESSAGE, _BAG, _CHUNK, _CONNECTION = b'\x02', b'\x03', b'\x05', b'\x07'  # the kinds of records of a bag
_NUMBERS = {'bool': '?', 'char': 'u1', 'byte': 'i1', 'float32': '<f4', 'float64': '<f8', 'time': ('<u4', 2),
            'duration': ('<i4', 2), **{sign + 'int%d' % bits: '<%s%d' % (sign or 'i', bits // 8)
                                       for sign in ('', 'u') for bits in (8, 16, 32, 64)}}

# A topic as one node publishes it. kind: the type of its messages, such as organ_collision/ContactArray.
Connection = namedtuple('Connection', 'topic kind md5 node')


class BagError(RuntimeError):
    """The file is no bag that can be read."""


@functools.lru_cache(maxsize=None)
def _fields(of):
    """The names and types of a message's fields."""
    kind = genpy.message.get_message_class(of if '/' in of else 'std_msgs/' + of)  # std_msgs/Header is named Header.
    return list(zip(kind.__slots__, kind._slot_types))


@functools.lru_cache(maxsize=None)
def _fixed(of):
    """The numpy type of a type of fields that all have the same size; None if their sizes differ. Vectors of one
    number type, such as geometry_msgs/Point, are rows; other messages are records; times are (seconds, nanoseconds).
    """
    if of in _NUMBERS:
        return np.dtype(_NUMBERS[of])
    base, bracket, count = of.partition('[')
    if bracket:
        return np.dtype((_fixed(base), int(count[:-1]))) if count != ']' and _fixed(base) else None
    parts = [] if of == 'string' else [(name, _fixed(part)) for name, part in _fields(of)]
    if not parts or any(part is None for _, part in parts):  # numpy takes None for a number type, too.
        return None
    is_row = len(parts) > 1 and {part for _, part in parts} == {np.dtype('<f8')}
    return np.dtype(('<f8', len(parts)) if is_row else parts)


@functools.lru_cache(maxsize=None)
def _groups(of):
    """The fields of a message as pairs: a name and its type, or None and the numpy type of neighbours of fixed size."""
    groups = []
    for is_fixed, fields in itertools.groupby(_fields(of), lambda field: _fixed(field[1]) is not None):
        groups += [(None, np.dtype([(name, _fixed(part)) for name, part in fields]))] if is_fixed else fields
    return groups


def _read(of, data, at):
    """The value of a type without a fixed size at this place of the bytes, and the place behind it."""
    if of == 'string' or of[-1] == ']':
        count, at = _UINT32.unpack_from(data, at)[0], at + 4
        if count > len(data):
            raise ValueError('%d values in %d bytes' % (count, len(data)))
        if of == 'string':
            return data[at:at + count].decode('utf-8', 'replace'), at + count
        part, values = of[:-2], []
        if _fixed(part):
            kind = np.dtype([('value', _fixed(part))])  # As a record: numpy would make several numbers of a row.
            return np.frombuffer(data, kind, count, at)['value'], at + count * kind.itemsize
        for _ in range(count):
            value, at = _read(part, data, at)
            values.append(value)
        return values, at
    fields = {}
    for name, part in _groups(of):
        if name:
            fields[name], at = _read(part, data, at)
        else:
            fields.update(zip(part.names, np.frombuffer(data, part, 1, at)[0]))
            at += part.itemsize
    return SimpleNamespace(**fields), at


def decode(kind, data):
    """The fields of a message of this type, such as 'organ_collision/ContactArray', from its bytes. Lists of equally
    long parts are numpy arrays: contacts['depth'] of an answer has the shape (k,), and contacts['point'] (k, 3). Raises
    ValueError or struct.error if the bytes are damaged."""
    return _read(kind, data, 0)[0]


def seconds(stamp):
    """A time of decode() in seconds."""
    return float(stamp[0]) + 1e-9 * float(stamp[1])


def read_bag(path, trial):
    """Gives a Trial what it wants of a bag, chunk by chunk, with progress on standard error. Returns what is wrong with the
    bag, or ''. A bag that was cut, or not closed, gives what is there. Raises BagError if it is none of version 2.0."""
    connections, shown, fault = {}, time.monotonic(), ''
    with open(path, 'rb') as file:
        if file.readline(64) != b'#ROSBAG V2.0\n':
            raise BagError('%s is no bag of version 2.0' % path)
        size = os.fstat(file.fileno()).st_size
        try:
            for kind, header, data in _records(file):
                if kind == _BAG and not 0 < struct.unpack('<Q', header[b'index_pos'])[0] < size:
                    fault = 'cut after %d bytes, or not closed by its recorder' % size
                for kind, header, data in _records(_unpacked(header, data)) if kind == _CHUNK else [(kind, header, data)]:
                    if kind == _CONNECTION:
                        about = {key: value.decode() for key, value in _header(data).items()}
                        connection = Connection(header[b'topic'].decode(), about[b'type'], about[b'md5sum'],
                                                about.get(b'callerid', ''))
                        connections[header[b'conn']] = connection if trial.has(connection) else None
                    elif kind == _MESSAGE and connections[header[b'conn']]:
                        trial.take(connections[header[b'conn']], seconds(struct.unpack('<2I', header[b'time'])), data)
                if time.monotonic() > shown + 1:
                    shown = time.monotonic()
                    print('\r%3.0f %% of %s' % (100 * file.tell() / size, path), end='', file=sys.stderr, flush=True)
        except EOFError:
            fault = fault or 'cut after %d bytes' % size
        except (struct.error, KeyError, ValueError, OSError) as error:
            fault = fault or 'damaged before byte %d of %d (%r)' % (file.tell(), size, error)
    print('\r' + ' ' * (len(path) + 9), end='\r', file=sys.stderr)
    return fault


def _records(file):
    """Yields (kind, header, data) of each record. Of a chunk that was cut, the data are what is there."""
    for length in iter(lambda: file.read(4), b''):
        header = _header(file.read(min(_UINT32.unpack(length)[0], LARGEST)))
        length = _UINT32.unpack(file.read(4))[0]
        data = file.read(min(length, LARGEST))
        if len(data) == length or header[b'op'] == _CHUNK:
            yield header[b'op'], header, data
        if len(data) < length:
            raise EOFError('a record of %d bytes has %d' % (length, len(data)))


def _header(data):
    """The fields of a record's header, or of a connection, by name."""
    fields, at = {}, 0
    while at < len(data):
        end = at + 4 + _UINT32.unpack_from(data, at)[0]
        name, _, fields[name] = data[at + 4:end].partition(b'=')
        at = end
    return fields


def _unpacked(header, data):
    """The records of a chunk."""
    if header[b'compression'] == b'lz4':
        import roslz4  # Only such bags need it.
        data = roslz4.decompress(data)
    return io.BytesIO(bz2.BZ2Decompressor().decompress(data) if header[b'compression'] == b'bz2' else data)


class Listener:
    """Gives a Trial the messages of the running nodes. Hold `lock` while you read the trial."""

    def __init__(self, trial):
        self.trial, self.lock, self.fault, self._subscribers = trial, threading.Lock(), None, {}

    def look(self):
        """Subscribes to topics that are new. Call it now and then. Raises what the trial refused."""
        if self.fault:
            raise self.fault
        for topic, kind in rospy.get_published_topics():
            if topic not in self._subscribers and self.trial.wants(topic, kind):
                self._subscribers[topic] = rospy.Subscriber(topic, rospy.AnyMsg, self._take, topic, buff_size=1 << 24,
                                                            tcp_nodelay=True)

    def listen(self, duration):
        """Listens so long [s], or until Ctrl-C."""
        end = time.monotonic() + duration
        try:
            while time.monotonic() < end:
                self.look()
                time.sleep(min(0.1, duration))
        except KeyboardInterrupt:
            pass  # What came counts.

    def _take(self, message, topic):
        header = message._connection_header
        connection = Connection(topic, header['type'], header['md5sum'], header['callerid'])
        with self.lock:
            try:
                if not self.fault and self.trial.has(connection):
                    self.trial.take(connection, rospy.get_time(), message._buff)
            except RuntimeError as error:
                self.fault = error
