#!/usr/bin/python3
"""Faults from outside: the node is killed at random times, garbage is sent to all ports of the node and of a nodelet,
and the ROS master is restarted. The simulators know nothing of all this.

Usage: faults_test.py [--seconds N] [--seed S] [--within SECONDS] [--only kills|garbage_node|garbage_nodelet|master]
"""

import argparse
import contextlib
import math
import os
import random
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'rostest'))

from organ_collision.msg import ContactArray, OrganMesh, OrganVertices  # noqa: E402
from organ_collision.srv import QueryCollision, QueryCollisionBatch, QueryCollisionRequest  # noqa: E402
import rospy  # noqa: E402
from tf2_msgs.msg import TFMessage  # noqa: E402

import garbage  # noqa: E402
from support import scenes  # noqa: E402
from support.node_client import TfSender, mesh_message, shaft, vertices_message, wait_until  # noqa: E402
from support.processes import OwnMaster, nodelet, program  # noqa: E402

NODE, FRAME = '/organ_collision', 'liver_frame'
PAIRS = {('liver', 'probe'), ('kidney', 'needle')}  # of organ and tool, one for each simulator
LIMIT = 30.0  # [s] from the start of a node until contacts of all pairs flow
LONGEST_LIFE = 0.3  # [s] from then on until the next kill
LONGEST_START = 0.6  # [s] of a life that ends while the node starts
MOST_MEMORY = 400.0  # [MB] that the process may have more than before the garbage
OPEN = 50  # connections that are left half open at a time
OTHERS = {'/haptic_proxy': {'tools': []}, '/organ_mesh_adapter': {'organs': []}}
NOT_LISTED = 'the ROS master does not list this node any more'


def simulate(organ, tool):
    """A simulator that runs until it is stopped, and needs no help: a sheet that waves, and a tool that moves through
    it. Publishes the mesh once, latched, and its vertices and the tool's poses on TF 50 times a second. It never looks
    whether anybody listens."""
    rospy.init_node('simulator')
    sheet, tf = scenes.sheet(0.1, 8), TfSender()
    meshes = rospy.Publisher(NODE + '/organ_mesh', OrganMesh, queue_size=1, latch=True)
    shapes = rospy.Publisher(NODE + '/organ_vertices', OrganVertices, queue_size=1)
    meshes.publish(mesh_message(organ, sheet, rospy.Time.now()))
    tf.send_resting((FRAME, tool + '_trocar', (0.01, 0.02, 0.3)))
    rate = rospy.Rate(50.0)
    while not rospy.is_shutdown():
        now = rospy.Time.now()
        phase = 2 * math.pi * now.to_sec()
        tf.send((FRAME, tool + '_tip', (0.012, 0.017, 0.01 * math.cos(phase)), now))
        waved = sheet.moved(lambda v: (v[0], v[1], 0.002 * math.sin(phase + 50 * v[0])))
        shapes.publish(vertices_message(organ, waved, now))
        rate.sleep()


def resident(pid):
    """[MB] of memory that a process has now."""
    with open('/proc/%d/status' % pid) as status:
        return next(int(line.split()[1]) for line in status if line.startswith('VmRSS')) / 1024


class Answers:
    """What came on `contacts` since `begin()`, with stamps of after it. `pairs` are those that touch."""

    def __init__(self):
        self.lock = threading.Lock()
        self.begin()
        self.subscriber = rospy.Subscriber(NODE + '/contacts', ContactArray, self.take, queue_size=1000)

    def begin(self):
        with self.lock:
            self.begun = rospy.Time.now()
            self.pairs, self.too_long, self.has_seen_static = set(), [], False

    def take(self, answer):
        with self.lock:
            if answer.status != ContactArray.OK or answer.header.stamp < self.begun:
                return
            if answer.contacts:
                self.pairs.add((answer.organ, answer.tool))
            self.has_seen_static |= answer.mode == ContactArray.STATIC
            if answer.step_start < self.begun:
                self.too_long.append('%s and %s: from %s to %s, in a life that began at %s' % (
                    answer.organ, answer.tool, answer.step_start, answer.header.stamp, self.begun))

    def wait_for_all(self):
        """Waits until all pairs touch. Returns how long it took [s]."""
        begin = time.monotonic()
        wait_until(lambda: self.pairs >= PAIRS, lambda: 'contacts of all pairs; there are %s' % self.pairs, LIMIT)
        return time.monotonic() - begin


class Watch(threading.Thread):
    """Asks one query after the other, and notes the longest wait and the most memory."""

    def __init__(self, pid):
        super().__init__(daemon=True)
        self.pid, self.before = pid, resident(pid)
        self.longest, self.answers, self.most, self.fault = 0.0, 0, self.before, None
        self.is_ended = threading.Event()
        self.query = rospy.ServiceProxy(NODE + '/query', QueryCollision, persistent=True)
        self.request = QueryCollisionRequest(organ='liver', motion=shaft((0.01, 0.02, 0.3), (0.01, 0.02, 0.0), 0.005))
        self.request.header.frame_id = FRAME

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


class FaultsTest(unittest.TestCase):
    options = None

    @classmethod
    def setUpClass(cls):
        cls.master = OwnMaster()
        cls.addClassCleanup(cls.master.stop)
        os.environ.update(cls.master.environment)
        rospy.init_node('faults_test', disable_signals=True, disable_rosout=True)

    def setUp(self):
        self.rng = random.Random(self.options.seed)
        self.addCleanup(self.master.stop_programs)
        tools = [{'name': tool, 'trocar_frame': tool + '_trocar', 'tip_frame': tool + '_tip', 'radius': 0.005}
                 for _, tool in sorted(PAIRS)]
        self.master.ask('setParam', NODE, {'tools': tools, 'max_faces': 1000, 'diagnostic_period_sec': 0.2})

    def start(self, *words):
        """Starts a program. Garbage makes roscpp print much."""
        return self.master.run(*words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def start_simulators(self):
        for organ, tool in sorted(PAIRS):
            self.start(os.path.abspath(__file__), 'simulate', organ, tool, '__name:=simulator_of_' + organ)
        self.checker = self.start(program('check_contacts'))
        self.answers = Answers()
        self.addCleanup(self.answers.subscriber.unregister)

    def assert_all_answers_kept_their_contract(self):
        self.checker.send_signal(signal.SIGINT)
        self.assertEqual(self.checker.wait(LIMIT), 0, 'check_contacts has found something')

    def test_kills(self):
        """A node that is killed by SIGKILL, also while it starts, is started again. Contacts flow again by themselves.
        No step reaches back into the life before."""
        self.start_simulators()
        node = self.start(program('organ_collision_node'))
        self.answers.wait_for_all()
        waited, killed, with_static, end = [], 0, 0, time.monotonic() + self.options.seconds
        while time.monotonic() < end or not waited:
            for longest in [LONGEST_LIFE] + [LONGEST_START] * (self.rng.random() < 0.5):
                time.sleep(self.rng.uniform(0.0, longest))
                self.answers.begin()
                node.kill()
                node.wait()
                node = self.start(program('organ_collision_node'))
                killed += 1
            waited.append(self.answers.wait_for_all())
            self.assertEqual(self.answers.too_long, [])
            with_static += self.answers.has_seen_static
        self.assert_all_answers_kept_their_contract()
        print('%d kills, %d of them while the node started; contacts came again after %.2f s (median), %.2f s (longest); '
              'the first static step was seen %d of %d times' % (
                  killed, killed - len(waited), statistics.median(waited), max(waited), with_static, len(waited)))

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
            publisher, bodies = rng.choice(publishers)
            self.sent += 1
            self.delivered += publisher.get_num_connections() > 0
            publisher.publish(publisher.data_class(garbage.spoiled(rng, rng.choice(bodies))))
        elif kind == 4:
            self.connect(self.port, garbage.tcpros(rng, [service.resolved_name for service, _ in self.services]))
        elif kind == 5:
            self.connect(uri, garbage.xml(rng))
        else:
            service, bodies = rng.choice(self.services)
            with contextlib.suppress(rospy.ServiceException):  # The node may refuse it.
                service(service.request_class(garbage.spoiled(rng, rng.choice(bodies))))

    def send_pieces(self, name, process):
        uri = garbage.address(self.master.ask('lookupNode', name))
        publishers = [(rospy.Publisher(topic, garbage.raw(kind), queue_size=None), garbage.messages(*bodies))
                      for topic, kind, bodies in ((NODE + '/organ_mesh', OrganMesh, ('node_messages', 0)),
                                                  (NODE + '/organ_vertices', OrganVertices, ('node_messages', 1)),
                                                  ('/tf', TFMessage, ('node_messages', 2)))]
        for publisher, _ in publishers:
            self.addCleanup(publisher.unregister)
            wait_until(publisher.get_num_connections, 'the node subscribes to ' + publisher.name)
        end = time.monotonic() + self.options.seconds / 2
        while time.monotonic() < end:
            self.send_piece(publishers, uri)
            self.assertIsNone(process.poll(), 'the process died')
        for peer in self.half_open:
            peer.close()

    def check_garbage(self, name, process):
        """Peers send what is no message, no request, no header and no XML, and legal messages with any content, and
        leave connections half open. The process lives, answers a query all the time, and needs little more memory."""
        self.pieces = self.sent = self.delivered = 0  # The last two are messages of topics.
        self.half_open = []
        self.start_simulators()
        kinds = {NODE + '/query': QueryCollision, NODE + '/query_batch': QueryCollisionBatch}
        self.services = []
        for number, (name_of_service, kind) in enumerate(kinds.items()):
            rospy.wait_for_service(name_of_service, LIMIT)
            self.services.append((rospy.ServiceProxy(name_of_service, garbage.raw_service(kind)),
                                  garbage.messages('query_requests', number)))
        self.port = garbage.address(self.master.ask('lookupService', NODE + '/query'))
        self.answers.wait_for_all()
        watch = Watch(process.pid)
        watch.start()
        self.send_pieces(name, process)
        self.answers.begin()
        self.answers.wait_for_all()
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
        self.assert_all_answers_kept_their_contract()

    def test_garbage_node(self):
        self.check_garbage(NODE, self.start(program('organ_collision_node')))

    def test_garbage_nodelet(self):
        manager = self.start(*nodelet('manager', '__name:=manager'))
        self.start(*nodelet('load', 'organ_collision/CollisionNodelet', 'manager', '--no-bond',
                            '__name:=organ_collision'))
        self.check_garbage('/manager', manager)

    def log_of(self, *words):
        """Starts a program. Returns a function that returns what it has printed."""
        log = tempfile.NamedTemporaryFile('w')
        self.addCleanup(log.close)
        self.master.run(*words, stdout=log, stderr=log)

        def printed():
            with open(log.name) as text:
                return text.read()
        return printed

    def test_master(self):
        """All nodes of the package say in the log and on /diagnostics that they must be restarted."""
        logs = {NODE: self.log_of(program('organ_collision_node'), '__name:=organ_collision')}
        for name, parameters in OTHERS.items():
            self.master.ask('setParam', name, {'diagnostic_period_sec': 0.2, **parameters})
            logs[name] = self.log_of(program(name.strip('/')), '__name:=' + name.strip('/'))
        self.master.ask('setParam', '/nodelet', {'tools': []})
        logs['/nodelet'] = self.log_of(*nodelet('manager', '__name:=manager'))
        self.start(*nodelet('load', 'organ_collision/CollisionNodelet', 'manager', '__name:=nodelet'))
        diagnostics = self.log_of(sys.executable, program('rostopic', 'rostopic'), 'echo', '/diagnostics')
        names = ['%s: master' % node.strip('/') for node in logs]
        wait_until(lambda: all(name in diagnostics() for name in names), 'all nodes on /diagnostics')
        self.assertNotIn(NOT_LISTED, diagnostics())
        self.master.kill()
        wait_until(lambda: 'does not answer' in diagnostics(), 'a node misses the master')
        self.master.start()
        wait_until(lambda: all(NOT_LISTED in printed() for printed in logs.values()), 'the logs tell it')
        wait_until(lambda: diagnostics().count(NOT_LISTED) > 5 * len(names), '/diagnostics tells it again and again')


if __name__ == '__main__':
    if sys.argv[1:2] == ['simulate']:
        with contextlib.suppress(rospy.ROSInterruptException):
            simulate(*sys.argv[2:4])
        sys.exit()
    parser = argparse.ArgumentParser(description=__doc__.split('.')[0])
    parser.add_argument('--seconds', type=float, default=10.0, help='of kills, and of garbage for node and nodelet')
    parser.add_argument('--seed', type=int, default=4711, help='of the random times and of the garbage')
    parser.add_argument('--within', type=float, default=20.0,
                        help='each query must be answered [s]; long, on a busy machine')
    parser.add_argument('--only', choices=['kills', 'garbage_node', 'garbage_nodelet', 'master'], help='not all')
    FaultsTest.options = parser.parse_args()
    names = ['FaultsTest.test_' + FaultsTest.options.only] if FaultsTest.options.only else []
    # rospy leaves sockets open, and Python would warn of each.
    unittest.main(argv=sys.argv[:1] + names, verbosity=2, warnings='ignore')
