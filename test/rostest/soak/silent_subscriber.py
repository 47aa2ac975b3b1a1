"""A subscriber that connects, and never reads."""

import socket
import struct
import xmlrpc.client

CALLER = '/silent'


def connect(node_address, topic, kind):
    """Subscribes at the node itself, so that no master is needed. Returns the connection, which fills up."""
    code, message, parameters = xmlrpc.client.ServerProxy(node_address).requestTopic(CALLER, topic, [['TCPROS']])
    if code != 1:
        raise RuntimeError(f'{topic}: {message}')
    connection = socket.create_connection((parameters[1], parameters[2]), timeout=30)
    fields = [f'callerid={CALLER}', f'topic={topic}', f'type={kind}', 'md5sum=*']
    header = b''.join(struct.pack('<I', len(field)) + field.encode() for field in fields)
    connection.sendall(struct.pack('<I', len(header)) + header)
    return connection
