"""Peers of a node that speak TCPROS and XML-RPC by hand, so that they can speak them wrongly."""

import socket
import struct
import threading
import urllib.parse
import xmlrpc.client
import xmlrpc.server

PATIENCE = 5.0  # [s] for any answer


def packed(*fields):
    """A TCPROS header: fields KEY=VALUE as bytes, each with its length, and the length of all."""
    body = b''.join(struct.pack('<I', len(field)) + field for field in fields)
    return struct.pack('<I', len(body)) + body


def header(**fields):
    return packed(*(('%s=%s' % field).encode() for field in fields.items()))


def framed(body):
    """A message or request: its length, and its bytes."""
    return struct.pack('<I', len(body)) + body


def address(uri):
    parts = urllib.parse.urlparse(uri)
    return parts.hostname, parts.port


def connected(place):
    peer = socket.create_connection(place, PATIENCE)
    peer.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return peer


def received(peer, count):
    data = b''
    while len(data) < count:
        part = peer.recv(count - len(data))
        if not part:
            raise ConnectionError('closed')
        data += part
    return data


def read_block(peer):
    return received(peer, struct.unpack('<I', received(peer, 4))[0])


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
        self.slave.register_function(self.request_topic, 'requestTopic')
        self.slave.register_function(lambda caller: [1, '', 0], 'getPid')
        self.uri = 'http://localhost:%d/' % self.slave.server_address[1]
        for work in (self.slave.serve_forever, self.accept):
            threading.Thread(target=work, daemon=True).start()
        self.register()

    def register(self):
        self.master.registerPublisher(self.name, self.topic, self.message_class._type, self.uri)

    def unregister(self):
        self.master.unregisterPublisher(self.name, self.topic, self.uri)

    def request_topic(self, caller, topic, protocols):
        return [1, '', ['TCPROS', 'localhost', self.listener.getsockname()[1]]]

    def accept(self):
        while True:
            try:
                peer, _ = self.listener.accept()
                peer.settimeout(PATIENCE)
                read_block(peer)
                peer.sendall(
                    header(
                        callerid=self.name, topic=self.topic, type=self.message_class._type,
                        md5sum=self.message_class._md5sum, message_definition='', latching='0',
                    )
                )
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

    def start_anew(self):
        """Hangs up, and leaves the master for a moment. roscpp does not always connect again by itself."""
        self.unregister()
        self.hang_up()
        self.register()

    def hang_up(self):
        with self.lock:
            for peer in self.subscribers:
                peer.close()
            self.subscribers = []

    def close(self):
        self.unregister()
        self.hang_up()
        self.listener.close()
        self.slave.shutdown()
        self.slave.server_close()
