"""Bytes that a peer may send to a node, most of them wrong. All come from one random generator."""

import io
import struct

from organ_collision.msg import OrganMesh, OrganVertices
from organ_collision.srv import QueryCollisionBatchRequest, QueryCollisionRequest
from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

import peers

LENGTHS = [0, 1, 255, 2**16, 2**24, 2**28, 2**30, 2**30 + 1, 10**9, 10**9 + 1, 2**31 - 1, 2**31, 2**32 - 2, 2**32 - 1]
TYPES = ['i4', 'int', 'boolean', 'double', 'string', 'base64', 'dateTime.iso8601', 'array', 'struct', 'nonsense']
VALUES = ['', '0', '-1', '99999999999999999999', '1e999', 'nan', '####', 'A' * 5000, '<value>', '</value>', '<data>']
METHODS = ['publisherUpdate', 'requestTopic', 'paramUpdate', 'getBusInfo', 'getPid', 'system.multicall', 'nothing', '']


def serialized(message):
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


def length(rng):
    return rng.choice(LENGTHS) if rng.random() < 0.7 else rng.getrandbits(32)


def noise(rng):
    return bytes(rng.getrandbits(8) for _ in range(rng.choice([0, 1, 3, 4, 5, 30, 300, 2000])))


def spoiled(rng, body):
    """A message or request that is cut off, has wrong bytes, or a list that claims to be long."""
    body = bytearray(body)
    kind = rng.randrange(4)
    if kind == 0:
        return bytes(body[: rng.randrange(len(body) + 1)])
    if kind == 1:
        for _ in range(rng.randrange(1, 5)):
            body[rng.randrange(len(body))] = rng.randrange(256)
    if kind == 2:
        struct.pack_into('<I', body, rng.randrange(len(body) - 3), length(rng))
    return bytes(body) + (noise(rng) if kind == 3 else b'')


def mesh(rng):
    return serialized(OrganMesh(organ='spoiled', vertices=[0.5, 0.0, 0.0] * 4, triangles=[0, 1, 2], topology=rng.randrange(3)))


def vertices(rng):
    return serialized(OrganVertices(organ='spoiled', vertices=[0.5, 0.0, 0.0] * 4, topology=rng.randrange(3)))


def transforms(rng):
    return serialized(TFMessage([TransformStamped(child_frame_id='spoiled')] * rng.randrange(4)))


def query(rng):
    return serialized(QueryCollisionRequest(organ='good', mode=rng.randrange(3)))


def batch(rng):
    return serialized(QueryCollisionBatchRequest(organ='good', mode=rng.randrange(3)))


def tcpros(rng, services):
    """What is sent to the TCPROS port right after connecting."""
    kind = rng.randrange(6)
    if kind == 0:
        return noise(rng)
    if kind == 1:
        return struct.pack('<I', length(rng)) + noise(rng)
    if kind == 2:  # Fields of absurd lengths in a header of the right length.
        fields = b''.join(struct.pack('<I', length(rng)) + noise(rng)[:30] for _ in range(rng.randrange(4)))
        return peers.framed(fields)
    if kind == 3:
        return peers.packed(*(rng.choice([b'', b'=', b'topic', b'topic=', b'error=x', noise(rng)]) for _ in range(3)))
    if kind == 4:
        return peers.header(callerid='/peer', topic='/organ_collision/contacts', md5sum=rng.choice(['*', 'x', '']))
    md5sum = rng.choice(['*', 'x'])
    head = peers.header(callerid='/peer', service=rng.choice(services), md5sum=md5sum, persistent='1')
    return head + rng.choice([b'', struct.pack('<I', length(rng)), peers.framed(noise(rng)), noise(rng)])


def xml(rng):
    """What is sent to the XML-RPC port. No `shutdown`, which every node obeys."""
    kind = rng.randrange(4)
    if kind == 0:
        return noise(rng)
    parts = ['<value><%s>%s</%s></value>' % (name, rng.choice(VALUES), name)
             for name in rng.choices(TYPES, k=rng.randrange(4))]
    if rng.random() < 0.2:
        depth = rng.choice([10, 300])
        parts.append('<value><array><data>' * depth + '</data></array></value>' * rng.choice([0, depth]))
    body = '<?xml version="1.0"?><methodCall><methodName>%s</methodName><params>%s</params></methodCall>' % (
        rng.choice(METHODS), ''.join('<param>%s</param>' % part for part in parts))
    body = body[: rng.randrange(len(body) + 1)] if kind == 1 else body
    claimed = rng.choice([len(body), len(body) + 1, 0, -1, 2**31 - 1, 2**31, 10**30, 'x']) if kind == 2 else len(body)
    end = '\r\n\r\n' if rng.random() < 0.9 else ''
    return ('POST / HTTP/1.1\r\nContent-Length: %s%s%s' % (claimed, end, body)).encode()
