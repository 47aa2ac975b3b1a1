"""Recorded and running topics, fast: bags in one pass of bounded memory, and messages from their bytes without a Python
object for each contact. rosbag's own reader first indexes all messages in memory, and refuses a bag that was cut. rospy
needs about 15 us for each contact."""

import bz2
from collections import namedtuple
import functools
import io
import os
import struct
import sys
import threading
import time

from genpy.base import SIMPLE_TYPES_DICT
import genpy.message
import numpy as np
import rospy

LARGEST = 1 << 30  # [bytes] A longer record is none: the file is damaged there.
_UINT32 = struct.Struct('<I')
_MESSAGE, _BAG, _CHUNK, _CONNECTION = b'\x02', b'\x03', b'\x05', b'\x07'  # the kinds of records of a bag
_CODES = {**SIMPLE_TYPES_DICT, 'bool': '?', 'time': '2I', 'duration': '2i'}

# A topic as one node publishes it. kind: the type of its messages, such as organ_collision/ContactArray.
Connection = namedtuple('Connection', 'topic kind md5 node')


class BagError(RuntimeError):
    """The file is no bag that can be read."""


def _leaves(of, name=''):
    """The fields of a type with those of its parts in their places: dotted names and types."""
    if of == 'string' or of in _CODES or of[-1] == ']':
        return [(name, of)]
    kind = genpy.message.get_message_class(of if '/' in of else 'std_msgs/' + of)  # std_msgs/Header is named Header.
    return [leaf for part, inner in zip(kind.__slots__, kind._slot_types)
            for leaf in _leaves(inner, (name + '.' + part).lstrip('.'))]


def _code(of):
    """The code of a number or of so many numbers, for struct and numpy. None for a string or a list of any length."""
    base, _, count = of.partition('[')
    return None if of == 'string' or count == ']' else count[:-1] + _CODES[base]


def _list_reader(of, wanted):
    """A function that reads so many elements of a string or of a list without a fixed length. See _reader."""
    columns = [('', 'S1')] if of == 'string' else [(name, _code(kind)) for name, kind in _leaves(of[:-2])]
    part = np.dtype(columns) if all(code for _, code in columns) else None
    if part and not wanted:
        return lambda data, at, count: (None, at + count * part.itemsize)
    if of == 'string':
        return lambda data, at, count: (str(data[at:at + count], 'utf-8', 'replace'), at + count)
    if part:
        return lambda data, at, count: (np.frombuffer(data, part, count, at), at + count * part.itemsize)
    read = _reader(of[:-2], wanted)

    def read_list(data, at, count):
        rows = []
        for _ in range(count):
            row, at = read(data, at)
            rows.append(row)
        return rows, at
    return read_list


def _reader(of, wanted):
    """A function that reads what is wanted of a type at a place of the bytes. It returns the values, and the place behind."""
    steps, numbers = [], '<'
    for name, kind in _leaves(of):
        is_wanted = any((name + '.').startswith(one + '.') for one in wanted)
        code = _code(kind)
        if code is None:
            inner = ('',) if is_wanted else tuple(one[len(name) + 1:] for one in wanted if one.startswith(name + '.'))
            steps.append((struct.Struct(numbers + 'I'), _list_reader(kind, inner), bool(inner)))
            numbers = '<'
        else:
            numbers += code if is_wanted else '%dx' % struct.calcsize('<' + code)
    last = struct.Struct(numbers)

    def read(data, at):
        values = []
        for before, read_list, is_wanted in steps:
            *numbers, count = before.unpack_from(data, at)
            value, at = read_list(data, at + before.size, count)
            values += [*numbers, value] if is_wanted else numbers
        values += last.unpack_from(data, at)
        return values, at + last.size
    return read


@functools.lru_cache(maxsize=None)
def decoder(kind, wanted):
    """A function that gives the wanted fields of a message from its bytes, as a list in their order in the message.

    kind    the type of the message, such as 'organ_collision/ContactArray'
    wanted  names such as 'header.stamp tool contacts.organ'. Times are two values (seconds, nanoseconds), parts such as
            points the values of their fields. Lists are numpy arrays if their elements have a fixed size: of an answer,
            contacts['depth'] and contacts['point.x'] have the shape (k,). Other lists are lists of such lists of values.

    The function raises ValueError or struct.error if the bytes are damaged."""
    read = _reader(kind, tuple(wanted.split()))

    def decode(data):
        values, end = read(data, 0)
        if end != len(data):
            raise ValueError('a message of %d bytes has %d' % (end, len(data)))
        return values
    return decode


def seconds(secs, nsecs):
    """A time in seconds."""
    return secs + 1e-9 * nsecs


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
                        trial.take(connections[header[b'conn']], seconds(*struct.unpack('<2I', header[b'time'])), data)
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

    def __init__(self, trial, name):
        """Starts a node of this name, without rospy's handler of Ctrl-C."""
        self.trial, self.lock, self.fault, self._subscribers = trial, threading.Lock(), None, {}
        rospy.init_node(name, anonymous=True, disable_signals=True)

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
