"""What a peer may send to a node, most of it wrong: as legal messages, as bytes of messages and requests, as headers,
and as XML. All comes from one random generator. Peers speak TCPROS and XML-RPC by hand, so that they can speak them
wrongly."""

import io
import socket
import struct
import threading
import urllib.parse
import xmlrpc.client
import xmlrpc.server

from geometry_msgs.msg import Point, TransformStamped
from organ_collision.msg import OrganMesh, OrganVertices, ToolMotion
from organ_collision.srv import QueryCollisionBatchRequest, QueryCollisionRequest
import rospy
from tf2_msgs.msg import TFMessage

PATIENCE = 5.0  # [s] for any answer
LENGTHS = [0, 1, 255, 2**16, 2**24, 2**28, 2**30, 2**30 + 1, 10**9, 10**9 + 1, 2**31 - 1, 2**31, 2**32 - 2, 2**32 - 1]
ODD = [0.0, -0.0, 1e-45, 1e-20, 0.01, -0.5, 1e6, 3e38, -3e38, float('nan'), float('inf'), -float('inf')]
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


def number(rng):
    return rng.choice(ODD) if rng.random() < 0.2 else rng.uniform(-0.1, 0.1)


def headed(rng, message):
    message.header.frame_id = rng.choice(['', 'liver_frame', 'liver_frame', 'a b', '/', '☃'])
    message.header.stamp = rospy.Time(rng.choice([0, 1, 2**32 - 1]), rng.randrange(10**9))
    return message


def coordinates(rng):
    is_bad = rng.random() < 0.5
    return [number(rng) if is_bad else rng.uniform(-0.1, 0.1) for _ in range(rng.choice([0, 1, 2, 3, 9, 30, 75]))]


def mesh(rng):
    message = OrganMesh(organ=rng.choice(['', 'a', 'b', 'ø\n']), vertices=coordinates(rng), topology=rng.randrange(3))
    most = max(1, len(message.vertices) // 3)
    if rng.random() < 0.3:
        most = rng.choice([2**32, most + 1])
    message.triangles = [rng.randrange(most) for _ in range(rng.choice([0, 1, 3, 30, 96]))]
    return serialized(headed(rng, message))


def vertices(rng):
    message = OrganVertices(organ=rng.choice(['', 'a', 'b', 'c']), vertices=coordinates(rng), topology=rng.randrange(3))
    return serialized(headed(rng, message))


def transforms(rng):
    return serialized(TFMessage([headed(rng, TransformStamped(child_frame_id='spoiled'))
                                 for _ in range(rng.randrange(4))]))


def motion(rng):
    return ToolMotion(*[Point(*(number(rng) for _ in range(3))) for _ in range(4)],
                      rng.choice([0.005, 0.05, number(rng)]))


def query(rng):
    request = QueryCollisionRequest(organ=rng.choice(['liver', 'liver', 'a', '']),
                                    mode=rng.choice([0, 1, 2, 3, 4, 5, 255]),
                                    tool=rng.choice(['', '', 'probe', 'saw']), motion=motion(rng),
                                    regions=rng.random() < 0.5)
    return serialized(headed(rng, request))


def batch(rng):
    request = QueryCollisionBatchRequest(organ='liver', mode=rng.randrange(5), motions=[motion(rng)] * rng.randrange(4))
    return serialized(headed(rng, request))


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


def read_block(peer):
    size, data = None, b''
    while size is None or len(data) < size:
        part = peer.recv((size or 4) - len(data))
        if not part:
            raise ConnectionError('closed')
        data += part
        if size is None and len(data) == 4:
            (size,), data = struct.unpack('<I', data), b''


def said(peer, data):
    """Sends, even if the other side hangs up. Returns whether it did not."""
    try:
        peer.sendall(data)
        return True
    except OSError:
        return False


def request(place, service, service_class, data):
    """Calls a service with these bytes, which may be no request, and hangs up without waiting for an answer."""
    with connected(place) as peer:
        said(peer, header(callerid='/peer', service=service, md5sum=service_class._md5sum, persistent='0'))
        try:
            read_block(peer)
        except OSError:
            return
        said(peer, data)


class Publisher:
    """A publisher that is registered at the master, and sends its subscribers any bytes."""

    def __init__(self, master_uri, name, topic, message_class):
        self.name, self.topic, self.message_class = name, topic, message_class
        self.master = xmlrpc.client.ServerProxy(master_uri)
        self.lock, self.subscribers = threading.Lock(), []
        self.listener = socket.create_server(('localhost', 0))
        self.slave = xmlrpc.server.SimpleXMLRPCServer(('localhost', 0), logRequests=False, allow_none=True)
        self.slave.register_function(
            lambda caller, topic, protocols: [1, '', ['TCPROS', 'localhost', self.listener.getsockname()[1]]],
            'requestTopic')
        self.slave.register_function(lambda caller: [1, '', 0], 'getPid')
        self.uri = 'http://localhost:%d/' % self.slave.server_address[1]
        for work in (self.slave.serve_forever, self.accept):
            threading.Thread(target=work, daemon=True).start()
        self.register()

    def register(self):
        self.master.registerPublisher(self.name, self.topic, self.message_class._type, self.uri)

    def accept(self):
        greeting = header(callerid=self.name, topic=self.topic, type=self.message_class._type,
                          md5sum=self.message_class._md5sum, message_definition='', latching='0')
        while True:
            try:
                peer, _ = self.listener.accept()
                peer.settimeout(PATIENCE)
                read_block(peer)
                peer.sendall(greeting)
            except OSError:
                if self.listener.fileno() < 0:
                    return
                continue
            with self.lock:
                self.subscribers.append(peer)

    def send(self, data):
        """Sends to all subscribers. Forgets those that hang up. Returns how many are left."""
        with self.lock:
            self.subscribers = [peer for peer in self.subscribers if said(peer, data)]
            return len(self.subscribers)

    def leave(self):
        self.master.unregisterPublisher(self.name, self.topic, self.uri)
        with self.lock:
            for peer in self.subscribers:
                peer.close()
            self.subscribers = []

    def start_anew(self):
        """Hangs up, and leaves the master for a moment. roscpp does not always connect again by itself."""
        self.leave()
        self.register()

    def close(self):
        self.leave()
        self.listener.close()
        self.slave.shutdown()
        self.slave.server_close()
