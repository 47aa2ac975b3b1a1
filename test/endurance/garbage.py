"""What a peer may send to a node, most of it wrong: as bytes of messages and requests, as headers, and as XML. All comes
from one random generator. """

import pathlib
import socket
import struct
import urllib.parse

CORPORA = pathlib.Path(__file__).resolve().parent.parent / 'fuzz' / 'corpus'
PATIENCE = 5.0  # [s] for any answer
LENGTHS = [0, 1, 255, 2**16, 2**24, 2**28, 2**30, 2**30 + 1, 10**9, 10**9 + 1, 2**31 - 1, 2**31, 2**32 - 2, 2**32 - 1]
TYPES = ['i4', 'int', 'boolean', 'double', 'string', 'base64', 'dateTime.iso8601', 'array', 'struct', 'nonsense']
VALUES = ['', '0', '-1', '99999999999999999999', '1e999', 'nan', '####', 'A' * 5000, '<value>', '</value>', '<data>']
METHODS = ['publisherUpdate', 'requestTopic', 'getBusInfo', 'getPid', 'system.multicall', 'nothing', '']


def length(rng):
    return rng.choice(LENGTHS) if rng.random() < 0.7 else rng.getrandbits(32)


def noise(rng):
    return bytes(rng.getrandbits(8) for _ in range(rng.choice([0, 1, 3, 4, 5, 30, 300, 2000])))


def spoiled(rng, body):
    """A message or request that is cut off, has wrong bytes, or a list that claims to be long; or that is as it was."""
    body = bytearray(body)
    kind = rng.randrange(5)
    if kind == 0:
        return bytes(body[: rng.randrange(len(body) + 1)])
    if kind == 1:
        for _ in range(rng.randrange(1, 5)):
            body[rng.randrange(len(body))] = rng.randrange(256)
    if kind == 2:
        struct.pack_into('<I', body, rng.randrange(len(body) - 3), length(rng))
    return bytes(body) + (noise(rng) if kind == 3 else b'')


def messages(folder, kind):
    """The messages of one kind in the inputs with which fuzzing begins, as bytes (test/fuzz/make_corpus.py). They do
    not change the organ that a test asks about."""
    bodies = []
    for file in sorted((CORPORA / folder).iterdir()):
        data = file.read_bytes()
        while data:
            found = data[0]
            size = {5: -2, 6: -1, 7: -2}.get(found)  # These kinds have no message.
            if size is None:
                (size,) = struct.unpack_from('<H', data, 1)
            bodies += [data[3:3 + size].replace(b'liver', b'other')] * (found == kind)
            data = data[3 + size:]
    return bodies


def raw(kind):
    """A type of messages that are any bytes. It passes for the type `kind`."""
    class Raw(kind):
        def __init__(self, body=b''):
            super().__init__()
            self.body = body

        def serialize(self, buff):
            buff.write(self.body)
    return Raw


def raw_service(kind):
    """A service whose requests are any bytes."""
    return type('Raw', (kind,), {'_request_class': raw(kind._request_class)})


def tcpros(rng, services):
    """What is sent to the TCPROS port right after connecting."""
    kind = rng.randrange(6)
    if kind == 0:
        return noise(rng)
    if kind == 1:
        return struct.pack('<I', length(rng)) + noise(rng)
    if kind == 2:  # Fields of absurd lengths in a header of the right length.
        fields = b''.join(struct.pack('<I', length(rng)) + noise(rng)[:30] for _ in range(rng.randrange(4)))
        return framed(fields)
    if kind == 3:
        return packed(*(rng.choice([b'', b'=', b'topic', b'topic=', b'error=x', noise(rng)]) for _ in range(3)))
    if kind == 4:
        return header(callerid='/peer', topic='/organ_collision/contacts', md5sum=rng.choice(['*', 'x', '']))
    head = header(callerid='/peer', service=rng.choice(services), md5sum=rng.choice(['*', 'x']), persistent='1')
    return head + rng.choice([b'', struct.pack('<I', length(rng)), framed(noise(rng)), noise(rng)])


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


def framed(body):
    """A message or request: its length, and its bytes."""
    return struct.pack('<I', len(body)) + body


def packed(*fields):
    """A TCPROS header: fields KEY=VALUE as bytes, each with its length, and the length of all."""
    return framed(b''.join(framed(field) for field in fields))


def header(**fields):
    return packed(*(('%s=%s' % field).encode() for field in fields.items()))


def address(uri):
    parts = urllib.parse.urlparse(uri)
    return parts.hostname, parts.port


def connected(place):
    peer = socket.create_connection(place, PATIENCE)
    peer.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return peer


def said(peer, data):
    """Sends, even if the other side hangs up. Returns whether it did not."""
    try:
        peer.sendall(data)
        return True
    except OSError:
        return False
