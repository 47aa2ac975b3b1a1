"""Recorded and running topics, fast: bags in one pass of bounded memory, and messages from their bytes without a Python
object for each contact.

rosbag's own reader first indexes all messages in memory, and refuses a bag that was cut. rospy needs about 15 us for
each contact.
"""

import bz2
from collections import namedtuple
import functools
import os
import struct
import threading
import time
from types import SimpleNamespace

import genpy.message
import numpy as np

LARGEST = 1 << 30  # [bytes] A longer record is none: the file is damaged there.
_UINT32 = struct.Struct('<I')
_MESSAGE, _BAG, _CHUNK, _CONNECTION = 2, 3, 5, 7  # the kinds of records of a bag
_NUMBERS = {'bool': '?', 'char': 'u1', 'byte': 'i1', 'float32': '<f4', 'float64': '<f8', 'time': ('<u4', 2),
            'duration': ('<i4', 2), **{sign + 'int%d' % bits: '<%s%d' % (sign or 'i', bits // 8)
                                       for sign in ('', 'u') for bits in (8, 16, 32, 64)}}

# A topic as one node publishes it. kind: the type of its messages, such as organ_collision/ContactArray.
Connection = namedtuple('Connection', 'topic kind md5 node')


class BagError(RuntimeError):
    """The file is no bag that can be read."""


def _class(of):
    return genpy.message.get_message_class(of if '/' in of else 'std_msgs/' + of)  # std_msgs/Header is named Header.


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
    if of == 'string':
        return None
    kind = _class(of)
    parts = [_fixed(part) for part in kind._slot_types]
    if any(part is None for part in parts):  # numpy takes None for a number type, too.
        return None
    if len(parts) > 1 and set(parts) == {np.dtype('<f8')}:
        return np.dtype(('<f8', len(parts)))
    return np.dtype(list(zip(kind.__slots__, parts)))


@functools.lru_cache(maxsize=None)
def _plan(of):
    """How a message is read: its fields in groups (names, numpy type of a group, type of a single field)."""
    kind, groups = _class(of), []
    for name, part in zip(kind.__slots__, kind._slot_types):
        if _fixed(part) is None:
            groups.append(([name], None, part))
        elif groups and groups[-1][1] is not None:
            groups[-1][0].append(name)
            groups[-1][1].append((name, _fixed(part)))
        else:
            groups.append(([name], [(name, _fixed(part))], None))
    return [(names, None if fields is None else np.dtype(fields), part) for names, fields, part in groups]


def _read(of, data, at):
    """The value of this type at this place of the bytes, and the place behind it."""
    if of == 'string' or of.endswith('[]'):
        count, at = _UINT32.unpack_from(data, at)[0], at + 4
        if of == 'string':
            return bytes(data[at:at + count]).decode('utf-8', 'replace'), at + count
        dtype, values = _fixed(of[:-2]), []
        if dtype is not None:
            return np.frombuffer(data, dtype, count * int(np.prod(dtype.shape)) if dtype.shape else count, at), \
                at + count * dtype.itemsize
        for _ in range(count):
            value, at = _read(of[:-2], data, at)
            values.append(value)
        return values, at
    fields = {}
    for names, dtype, part in _plan(of):
        if dtype is None:
            fields[names[0]], at = _read(part, data, at)
        else:
            fields.update(zip(names, np.frombuffer(data, dtype, 1, at)[0].item()))
            at += dtype.itemsize
    return SimpleNamespace(**fields), at


def decode(kind, data):
    """The fields of a message of this type, such as 'organ_collision/ContactArray', from its bytes. Lists of equally
    long parts are numpy arrays: contacts.depth of an answer has the shape (k,), and contacts['point'] (k, 3)."""
    return _read(kind, data, 0)[0]


def seconds(stamp):
    """A time of decode() in seconds."""
    return float(stamp[0]) + 1e-9 * float(stamp[1])


class BagReader:
    """Reads a bag from its start to its end, chunk by chunk. A bag that was cut, or not closed, gives what is there.

    After the last message, `fault` says where the bag is cut; it is empty if the bag is whole. `share` is the share of
    the file that was read.
    """

    def __init__(self, path):
        self.path, self.fault, self.share, self._connections = path, '', 0.0, {}

    def messages(self):
        """Yields (connection, time of receipt [s], bytes). Raises BagError if the file is no bag of version 2.0."""
        with open(self.path, 'rb') as file:
            if file.readline(64) != b'#ROSBAG V2.0\n':
                raise BagError('%s is no bag of version 2.0' % self.path)
            size, begin = os.fstat(file.fileno()).st_size, file.tell()
            try:
                while file.tell() < size:
                    begin = file.tell()
                    yield from self._record(file, size)
                    self.share = file.tell() / size
            except (struct.error, KeyError, ValueError, OSError, EOFError) as error:
                self.fault = self.fault or 'damaged after %d of %d bytes (%s)' % (begin, size, error)

    def _record(self, file, size):
        fields = _fields(file.read(_UINT32.unpack(file.read(4))[0]))
        length = _UINT32.unpack(file.read(4))[0]
        data, kind = file.read(min(length, LARGEST)), fields[b'op'][0]
        index = struct.unpack('<Q', fields[b'index_pos'])[0] if kind == _BAG else 0
        if len(data) < length or index > size:
            self.fault = 'cut after %d bytes' % size
        if kind == _BAG and index == 0:
            self.fault = 'not closed: its recorder was killed'
        if kind == _CHUNK:
            yield from self._chunk(_unpacked(fields[b'compression'], data))
        elif kind in (_CONNECTION, _MESSAGE):
            yield from self._entry(fields, data)

    def _chunk(self, data):
        at = 0
        while at < len(data):
            begin = at + 8 + _UINT32.unpack_from(data, at)[0]
            end = begin + _UINT32.unpack_from(data, begin - 4)[0]
            if end <= len(data):  # Otherwise the chunk was cut here.
                yield from self._entry(_fields(data[at + 4:begin - 4]), data[begin:end])
            at = end

    def _entry(self, fields, data):
        if fields[b'op'][0] == _MESSAGE:
            yield self._connections[fields[b'conn']], seconds(struct.unpack('<2I', fields[b'time'])), data
        elif fields[b'op'][0] == _CONNECTION:
            about = {key: value.decode() for key, value in _fields(data).items()}
            self._connections[fields[b'conn']] = Connection(
                fields[b'topic'].decode(), about[b'type'], about[b'md5sum'], about.get(b'callerid', ''))


def _fields(header):
    """The fields of a record's header, by name."""
    fields, at = {}, 0
    while at < len(header):
        end = at + 4 + _UINT32.unpack_from(header, at)[0]
        name, _, fields[name] = header[at + 4:end].partition(b'=')
        at = end
    return fields


def _unpacked(compression, data):
    if compression == b'bz2':
        return bz2.BZ2Decompressor().decompress(data)
    if compression == b'lz4':
        import roslz4  # Only such bags need it.
        return roslz4.decompress(data)
    return data


class Listener:
    """Gives a Trial the messages of the running nodes. Hold `lock` while you read the trial."""

    def __init__(self, trial):
        self.trial, self.lock, self.fault, self._subscribers = trial, threading.Lock(), None, {}

    def look(self):
        """Subscribes to topics that are new. Call it now and then. Raises what the trial refused."""
        import rospy  # Bags do not need it.
        if self.fault:
            raise self.fault
        for topic, kind in rospy.get_published_topics():
            if topic not in self._subscribers and self.trial.wants(topic, kind):
                self._subscribers[topic] = rospy.Subscriber(topic, rospy.AnyMsg, self._take, (topic, rospy.get_time),
                                                            buff_size=1 << 24, tcp_nodelay=True)

    def listen(self, duration):
        """Listens so long [s], or until Ctrl-C."""
        end = time.monotonic() + duration
        try:
            while time.monotonic() < end:
                self.look()
                time.sleep(min(0.1, duration))
        except KeyboardInterrupt:
            pass  # What came counts.

    def _take(self, message, about):
        header, (topic, now) = message._connection_header, about
        connection = Connection(topic, header['type'], header['md5sum'], header['callerid'])
        with self.lock:
            try:
                if not self.fault and self.trial.has(connection):
                    self.trial.take(connection, now(), message._buff)
            except RuntimeError as error:
                self.fault = error
