#!/usr/bin/python3
"""Peers send a node and a nodelet what is no message, no request, no header and no XML, and legal messages with any
content, on all ports, and leave connections half open. The process lives, answers a query all the time, needs little
more memory, and its contacts keep their contract.

Usage: garbage_test.py [--seconds N] [--seed S] [--within SECONDS] [--only node|nodelet]
"""

import argparse
import os
import random
import shlex
import signal
import subprocess
import sys
import threading
import time
import unittest

FOLDER = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(FOLDER, '..', 'rostest'))

from organ_collision.msg import ContactArray, OrganMesh, OrganVertices  # noqa: E402
from organ_collision.srv import QueryCollision, QueryCollisionBatch, QueryCollisionRequest  # noqa: E402
import rospy  # noqa: E402
from tf2_msgs.msg import TFMessage  # noqa: E402

import garbage  # noqa: E402
from support.node_client import ContactLog, shaft, wait_until  # noqa: E402
from support.processes import OwnMaster, program  # noqa: E402

NODE = '/organ_collision'
TOOLS = [{'name': 'probe', 'trocar_frame': 'probe_trocar', 'tip_frame': 'probe_tip', 'radius': 0.005}]
MOST_MEMORY = 400.0  # [MB] that the process may have more than before
OPEN = 50  # connections that are left half open at a time


def resident(pid):
    """[MB] of memory that a process has now."""
    with open('/proc/%d/status' % pid) as status:
        return next(int(line.split()[1]) for line in status if line.startswith('VmRSS')) / 1024


class Watch(threading.Thread):
    """Asks one query after the other, and notes the longest wait and the most memory."""

    def __init__(self, pid):
        super().__init__(daemon=True)
        self.pid, self.before = pid, resident(pid)
        self.longest, self.answers, self.most, self.fault = 0.0, 0, self.before, None
        self.is_ended = threading.Event()
        self.query = rospy.ServiceProxy(NODE + '/query', QueryCollision, persistent=True)
        self.request = QueryCollisionRequest(organ='good', motion=shaft((0.01, 0.02, 0.3), (0.01, 0.02, 0.0), 0.005))
        self.request.header.frame_id = 'liver_frame'

    def run(self):
        while not self.is_ended.wait(0.01) and not self.fault:
            begin = time.monotonic()
            try:
                result = self.query(self.request).result
                if result.status != ContactArray.OK or not result.contacts:
                    self.fault = 'status %d, %s' % (result.status, result.message)
                self.most = max(self.most, resident(self.pid))
            except Exception as error:  # Any failure is one of the node.
                self.fault = repr(error)
            self.longest, self.answers = max(self.longest, time.monotonic() - begin), self.answers + 1


class GarbageTest(unittest.TestCase):
    options = None

    @classmethod
    def setUpClass(cls):
        cls.master = OwnMaster()
        cls.addClassCleanup(cls.master.stop)
        os.environ.update(cls.master.environment)
        rospy.init_node('garbage_test', disable_signals=True, disable_rosout=True)

    def setUp(self):
        self.rng = random.Random(self.options.seed)
        self.pieces = self.sent = self.delivered = 0  # The last two are messages of topics.
        self.half_open = []
        self.addCleanup(self.master.stop_programs)
        self.master.ask('setParam', NODE, {'tools': TOOLS, 'max_faces': 1000})

    def start(self, *words):
        """Starts a program. Garbage makes roscpp print much."""
        return self.master.run(*words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def connect(self, place, data):
        """Sends data to a port, and leaves some of the connections half open."""
        peer = garbage.connected(place)
        garbage.said(peer, data)
        if self.rng.random() < 0.1:
            self.half_open.append(peer)
        else:
            peer.close()
        if len(self.half_open) > OPEN:
            for slow in self.half_open:
                garbage.said(slow, bytes([self.rng.randrange(256)]))
            self.half_open.pop(0).close()

    def send_piece(self, publishers, uri):
        rng, kind = self.rng, self.rng.randrange(8)
        self.pieces += 1
        if kind < 4:
            publisher, body = rng.choice(publishers)
            self.sent += 1
            self.delivered += publisher.send(garbage.framed(garbage.spoiled(rng, body(rng)))) > 0
            if rng.random() < 0.001:  # A length that does not fit; after it, nothing can be understood.
                publisher.send(garbage.noise(rng))
                publisher.start_anew()
                wait_until(lambda: publisher.subscribers, 'the node subscribes again to ' + publisher.topic)
        elif kind == 4:
            self.connect(self.ports[0], garbage.tcpros(rng, self.services))
        elif kind == 5:
            self.connect(uri, garbage.xml(rng))
        else:
            service, types, body = rng.choice(((0, QueryCollision, garbage.query),
                                               (1, QueryCollisionBatch, garbage.batch)))
            data = garbage.spoiled(rng, body(rng))
            garbage.request(self.ports[service], self.services[service], types,
                            rng.choice([garbage.framed(data), data, garbage.framed(data)[:-1]]))

    def send_all(self, name):
        uri = garbage.address(self.master.ask('lookupNode', name))
        publishers = [(garbage.Publisher(self.master.uri, '/evil_%d' % number, topic, kind), body)
                      for number, (topic, kind, body) in enumerate(((NODE + '/organ_mesh', OrganMesh, garbage.mesh),
                                                                    (NODE + '/organ_vertices', OrganVertices,
                                                                     garbage.vertices),
                                                                    ('/tf', TFMessage, garbage.transforms)))]
        for publisher, _ in publishers:
            wait_until(lambda: publisher.subscribers, 'the node subscribes to ' + publisher.topic)
        end = time.monotonic() + self.options.seconds / 2
        while time.monotonic() < end:
            self.send_piece(publishers, uri)
            self.assertIsNone(self.process.poll(), 'the process died')
        for publisher, _ in publishers:
            publisher.close()
        for peer in self.half_open:
            peer.close()

    def check(self, name):
        self.start(os.path.join(FOLDER, 'fault_simulator.py'), 'good', 'probe')
        checker = self.start(program('check_contacts'))
        self.services = [NODE + '/query', NODE + '/query_batch']
        wait_until(lambda: all(self.master.ask('lookupService', service) for service in self.services), 'the services')
        self.ports = [garbage.address(self.master.ask('lookupService', service)) for service in self.services]
        watch = Watch(self.process.pid)
        wait_until(lambda: watch.query(watch.request).result.status == ContactArray.OK, 'the organ')
        watch.start()
        self.send_all(name)
        # The node still answers the steps of the simulator.
        log = ContactLog(NODE + '/contacts')
        wait_until(lambda: any(answer.contacts for answer in log.of('good', status=ContactArray.OK)),
                   'contacts after it')
        log.subscriber.unregister()
        watch.is_ended.set()
        watch.join(self.options.within)
        self.assertFalse(watch.is_alive(), 'the last query has no answer')
        print('%s: %d pieces of garbage; %d queries, the slowest after %.3f s; memory %.0f MB before, at most %.0f MB' % (
            name, self.pieces, watch.answers, watch.longest, watch.before, watch.most))
        self.assertIsNone(watch.fault)
        self.assertGreater(self.delivered, 0.99 * self.sent)
        self.assertGreater(watch.answers, 10)
        self.assertLess(watch.longest, self.options.within)
        self.assertLess(watch.most - watch.before, MOST_MEMORY)
        checker.send_signal(signal.SIGINT)
        self.assertEqual(checker.wait(20.0), 0, 'check_contacts has found something')

    def test_node(self):
        self.process = self.start(program('organ_collision_node'))
        self.check(NODE)

    def test_nodelet(self):
        prefix = shlex.split(os.environ.get('ORGAN_COLLISION_NODELET_PREFIX', ''))
        nodelet = program('nodelet', 'nodelet')
        self.process = self.start(*prefix, nodelet, 'manager', '__name:=manager')
        self.start(nodelet, 'load', 'organ_collision/CollisionNodelet', 'manager', '--no-bond',
                   '__name:=organ_collision')
        self.check('/manager')


if __name__ == '__main__':
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--seconds', type=float, default=10.0, help='in all')
    parser.add_argument('--seed', type=int, default=4711, help='of the garbage')
    parser.add_argument('--within', type=float, default=20.0,
                        help='each query must be answered [s]; long, on a busy machine')
    parser.add_argument('--only', choices=['node', 'nodelet'], help='not both')
    GarbageTest.options = parser.parse_args()
    names = ['GarbageTest.test_' + GarbageTest.options.only] if GarbageTest.options.only else []
    unittest.main(argv=sys.argv[:1] + names, verbosity=2)
