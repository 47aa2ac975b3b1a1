#!/usr/bin/python3
"""Runs the node, then the nodelet, with a fast simulator and users of all services, and disturbs them all the time.
Then it kills nodes, and sends garbage to their ports.

Usage: soak.py [--help] [--minutes N] [--seed S] [--out FOLDER] [--sanitizer KIND] DEVEL

The run is a success if memory stays flat, no answer is wrong, and what was sent is all accounted for. DEVEL is the
devel space of a build with tests. The script starts its own ROS masters. It writes into FOLDER: soak.json, and what the
node and the nodelet have printed. A build with a sanitizer needs memory for itself, which is then not
judged."""

import argparse
import collections
import contextlib
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import threading
import time
import xmlrpc.client

FOLDER = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER.parent / 'rostest'))

from diagnostic_msgs.msg import DiagnosticArray  # noqa: E402
from dynamic_reconfigure.msg import BoolParameter  # noqa: E402
from dynamic_reconfigure.srv import Reconfigure, ReconfigureRequest  # noqa: E402
from geometry_msgs.msg import Point  # noqa: E402
from organ_collision.msg import ContactArray, ToolMotion  # noqa: E402
from organ_collision.srv import ListOrgans, QueryCollision, QueryCollisionBatch  # noqa: E402
import rospy  # noqa: E402
from std_srvs.srv import Empty, Trigger  # noqa: E402
from support.node_client import wait_until  # noqa: E402
from support.processes import OwnMaster, nodelet  # noqa: E402
from visualization_msgs.msg import MarkerArray  # noqa: E402

import garbage  # noqa: E402
import verdict  # noqa: E402

NODE, CONTACTS = '/organ_collision', '/organ_collision/contacts'
KINDS = ('node', 'nodelet')
# soak.hpp and second_evaluation.cpp know them, too.
TOOLS = [{'name': 'probe', 'trocar_frame': 'probe_trocar', 'tip_frame': 'probe_tip', 'radius': 0.002},
         {'name': 'needle', 'trocar_frame': 'needle_trocar', 'tip_frame': 'needle_tip', 'radius': 0.001, 'margin': 0.01,
          'max_near': 20},
         {'name': 'jaw', 'links': ['jaw']},
         {'name': 'stylus', 'trocar_frame': 'stylus_trocar', 'tip_pose_topic': '/stylus', 'radius': 0.0015}]
URDF = """<robot name="jaw"><link name="jaw"><collision><geometry><box size="0.004 0.003 0.02"/></geometry></collision></link>
</robot>"""
SETTLED = 60.0  # [s] at most, for the last messages to arrive
SHUT_DOWN = 30.0  # [s] at most, from Ctrl-C to the end of the node
PAUSE = (1.0, 3.0)  # [s] between two disturbances
MEMORY_PERIOD = 0.25  # [s]
BATCH = 50  # motions
LOST_CONNECTION = 'unable to receive data from sender'  # what rospy says of it
SILENT = {CONTACTS: ContactArray._type, '/organ_collision/markers': MarkerArray._type}


class Subject:
    """The node or the nodelet, with its simulator and its judge, until its `with` block ends. `log`: a file for what
    the node prints."""

    def __init__(self, master, devel, kind, seed, log):
        self.kind, self.master, self.devel, self.memory = kind, master, devel, []
        self.counts, self.wrong_sums = {}, set()
        self._stack = contextlib.ExitStack()
        for name, value in (('/use_sim_time', True), ('/robot_description', URDF),
                            (NODE, {'tools': TOOLS, 'diagnostic_period_sec': 0.1})):
            master.ask('setParam', name, value)
        with contextlib.ExitStack() as stack:
            command = {'node': [self._program('organ_collision_node')],
                       'nodelet': nodelet('standalone', 'organ_collision/CollisionNodelet')}
            self.node = stack.enter_context(
                self._start(*command[kind], '__name:=organ_collision', stdout=log, stderr=log))
            wait_until(lambda: ('publisher', CONTACTS, NODE) in master.record(), 'the %s at the ROS master' % kind,
                       60.0)
            self.judge = stack.enter_context(self._start(self._program('soak'), 'judge', str(seed)))
            self._read(self.judge)
            subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, self._count)
            stack.callback(subscriber.unregister)
            self.simulator = stack.enter_context(self._start(self._program('soak'), 'simulator', str(seed)))
            self._read(self.simulator)
            self._ended = threading.Event()
            stack.callback(self._ended.set)
            threading.Thread(target=self._watch_memory, daemon=True).start()
            self._stack = stack.pop_all()

    def _count(self, message):
        """What the node itself counts, as /diagnostics tells it (doc/interface.md). All sums must be right."""
        for status in message.status:
            if status.name.endswith((': queries', ': messages')):
                self.counts.update((pair.key, int(pair.value)) for pair in status.values if pair.value.isdigit())
        if 'shapes due' in self.counts:
            self.wrong_sums.update(verdict.wrong_sums(self.counts, len(TOOLS)))

    def _watch_memory(self):
        """Samples (time [s] since the start, bytes of resident memory)."""
        start = time.monotonic()
        while not self._ended.wait(MEMORY_PERIOD) and self.node.poll() is None:
            with contextlib.suppress(OSError, IndexError):  # The process is gone.
                status = pathlib.Path('/proc/%d/status' % self.node.pid).read_text(encoding='ascii')
                self.memory.append((time.monotonic() - start, 1024 * int(status.split('VmRSS:')[1].split()[0])))

    def ended(self):
        """The programs that have ended before they should, with their exit codes."""
        programs = {self.kind: self.node, 'judge': self.judge, 'simulator': self.simulator}
        return {name: process.poll() for name, process in programs.items() if process.poll() is not None}

    def wait_until_judged(self):
        """On a busy machine, the judge may have had no time yet. Without disturbances, it gets some."""
        give_up = time.monotonic() + SETTLED
        while not self.ended() and time.monotonic() < give_up:
            judged = json.loads(self._ask(self.judge, 'report'))
            if all(judged[what] for what in verdict.WANTED):
                return
            time.sleep(1.0)

    def end(self):
        """Returns all that was measured, for verdict.py."""
        run = {'kind': self.kind, 'ended': self.ended(), 'memory': list(self.memory),
               'tools': [t['name'] for t in TOOLS]}
        if not run['ended']:
            run['sent'] = json.loads(self._ask(self.simulator, 'end'))
            give_up = time.monotonic() + SETTLED
            while True:
                time.sleep(0.5)
                run['judged'] = json.loads(self._ask(self.judge, 'report'))
                run['counts'], run['wrong sums'] = dict(self.counts), sorted(self.wrong_sums)
                if not verdict.open_accounts(run) or time.monotonic() > give_up:
                    break
            run['ended'] = self.ended()
            self.node.send_signal(signal.SIGINT)
            run['exit code'] = self.node.wait(SHUT_DOWN)
        return run

    @contextlib.contextmanager
    def _start(self, *command, stdout=subprocess.PIPE, stderr=None):
        process = subprocess.Popen([self.devel / 'env.sh', *command], stdin=subprocess.PIPE, stdout=stdout,
                                   stderr=stderr,
                                   text=True, env=self.master.environment)
        try:
            yield process
        finally:
            process.stdin.close()
            process.terminate()
            try:
                process.wait(timeout=20)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()

    def _program(self, name):
        return self.devel / 'lib/organ_collision' / name

    def _ask(self, process, line):
        process.stdin.write(line + '\n')
        process.stdin.flush()
        return self._read(process)

    @staticmethod
    def _read(process):
        """The next line that is empty or JSON. What roscpp logs begins with an escape sequence or a bracket."""
        for line in process.stdout:
            if line == '\n' or line.startswith('{'):
                return line
        raise RuntimeError('%s has ended: %d' % (process.args[1], process.wait()))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._stack.close()


class Users:
    """Users of all services, each in a thread of its own, until stop(). `findings`: what they got and should not."""

    def __init__(self, seed):
        self.findings, self.counts, self.ended = set(), collections.Counter(), threading.Event()
        works = [(0.005, self.ask), (0.02, self.ask_batch), (1.3, self.operate), (0.2, self.look)]
        self.threads = [threading.Thread(target=self._repeat, args=(pause, work, random.Random('%s %d' % (seed, i))))
                        for i, (pause, work) in enumerate(works)]
        for thread in self.threads:
            thread.start()

    def stop(self):
        self.ended.set()
        for thread in self.threads:
            thread.join()

    def _repeat(self, pause, work, rng):
        while not self.ended.wait(pause * rng.uniform(0.5, 1.5)):
            try:
                work(rng)
                self.counts[work.__name__] += 1
            except (rospy.ServiceException, rospy.ROSException) as error:
                self.findings.add('%s: %s' % (work.__name__, error))

    def call(self, name, kind, *request):
        """The answer of a service of the node. A connection can end without an answer: on a busy machine, this was seen
        once in some 10^5 calls, and only roscpp closes connections. As any user must, this one repeats such a call,
        but only once."""
        try:
            return rospy.ServiceProxy(NODE + name, kind)(*request)
        except rospy.ServiceException as error:
            if LOST_CONNECTION not in str(error):
                raise
            self.counts['repeated calls'] += 1
            return rospy.ServiceProxy(NODE + name, kind)(*request)

    @staticmethod
    def motion(rng):
        """A shaft that goes through the sheet."""
        x = rng.uniform(-0.02, 0.02)
        trocar = Point(0.02, 0.01, 0.15)
        return ToolMotion(trocar, Point(x, 0.0, 0.01), trocar, Point(x, 0.005, -0.01), 0.002)

    @staticmethod
    def request(kind, rng, **fields):
        request = kind._request_class(organ=rng.choice(['sheet', 'sheet', 'brief0', 'no_such_organ']),
                                      mode=rng.choice([ContactArray.STATIC, ContactArray.SWEPT]),
                                      organ_rests=rng.random() < 0.5, margin=rng.choice([0.0, 0.0, 0.01]), **fields)
        request.header.frame_id = 'sheet'
        return request

    def check(self, answer):
        contacts_are_legal = all(0.0 <= contact.fraction <= 1.0 for contact in answer.contacts)
        if answer.status not in verdict.LEGAL | {ContactArray.UNKNOWN_ORGAN, ContactArray.UNKNOWN_TOOL}:
            self.findings.add('a query has the status %d: %s' % (answer.status, answer.message))
        if not contacts_are_legal or (answer.status != ContactArray.OK and (answer.contacts or not answer.message)):
            self.findings.add('an illegal answer of status %d to a query' % answer.status)

    def ask(self, rng):
        tool = rng.choice(['', 'probe', 'needle', 'jaw', 'stylus', 'no_such_tool'])
        given = {} if tool else {'motion': self.motion(rng)}
        request = self.request(QueryCollision, rng, tool=tool, placement=rng.random() < 0.2, **given)
        self.check(self.call('/query', QueryCollision, request).result)

    def ask_batch(self, rng):
        motions = [self.motion(rng) for _ in range(BATCH)]
        answer = self.call('/query_batch', QueryCollisionBatch, self.request(QueryCollisionBatch, rng, motions=motions))
        if len(answer.results) != (BATCH if answer.status == ContactArray.OK else 0):
            self.findings.add('a batch with status %d has %d results' % (answer.status, len(answer.results)))
        for result in answer.results:
            self.check(result)

    def operate(self, rng):
        """Tools are reloaded in another order, which changes none of them."""
        kind = rng.randrange(4)
        if kind == 0:
            self.call('/reset', Empty)
        elif kind == 1:
            rospy.set_param(NODE + '/tools', rng.sample(TOOLS, len(TOOLS)))
            answer = self.call('/reload_tools', Trigger)
            if not answer.success or 'changed: ' in answer.message.replace('unchanged: ', ''):
                self.findings.add('reload_tools: ' + answer.message)
        elif kind == 2:
            request = ReconfigureRequest()
            request.config.bools = [BoolParameter(name, rng.random() < 0.5)
                                    for name in ('publish_regions', 'publish_placement')]
            self.call('/set_parameters', Reconfigure, request)
        else:
            self.call('/list_organs', ListOrgans)

    def look(self, rng):
        """Subscribes for a moment."""
        topic, kind = rng.choice([(CONTACTS, ContactArray), ('/organ_collision/markers', MarkerArray)])
        subscriber = rospy.Subscriber(topic, kind, lambda message: None)
        time.sleep(0.05)
        subscriber.unregister()


def connect_silently(node_address, topic, kind):
    """A subscriber that connects at the node itself, and never reads. Returns the connection, which fills up."""
    code, message, parameters = xmlrpc.client.ServerProxy(node_address).requestTopic('/silent', topic, [['TCPROS']])
    if code != 1:
        raise RuntimeError('%s: %s' % (topic, message))
    connection = garbage.connected((parameters[1], parameters[2]))
    connection.sendall(garbage.header(callerid='/silent', topic=topic, type=kind, md5sum='*'))
    return connection


class Disturbances:
    """What happens to the processes, in an order that depends only on the random numbers. The simulator itself disturbs
    the node by its messages."""

    def __init__(self, subject, rng):
        self.subject, self.rng, self.counts, self.silent = subject, rng, collections.Counter(), {}
        self.address = subject.master.ask('lookupNode', NODE)
        for topic in SILENT:  # From the beginning, so that what waits for them is part of the warm-up.
            self.silent[topic] = connect_silently(self.address, topic, SILENT[topic])

    def run(self, seconds):
        """Each of them once, in any order, and again, until the time has passed."""
        kinds, end = [self.stop_node, self.stop_simulator, self.starve, self.fall_silent], time.monotonic() + seconds
        while True:
            self.rng.shuffle(kinds)
            for kind in kinds:
                time.sleep(max(0.0, min(self.rng.uniform(*PAUSE), end - time.monotonic())))
                if time.monotonic() >= end or self.subject.ended():
                    for connection in self.silent.values():
                        connection.close()
                    return
                self.counts[kind.__name__.replace('_', ' ')] += 1
                kind()

    def _stop(self, process, longest):
        process.send_signal(signal.SIGSTOP)
        time.sleep(self.rng.uniform(0.05, longest))
        process.send_signal(signal.SIGCONT)

    def stop_node(self):
        self._stop(self.subject.node, 0.8)

    def stop_simulator(self):
        self._stop(self.subject.simulator, 2.0)

    def starve(self):
        """Two endless loops for each core."""
        loops = [subprocess.Popen(['sh', '-c', 'while :; do :; done']) for _ in range(2 * os.cpu_count())]
        time.sleep(self.rng.uniform(0.5, 2.5))
        for loop in loops:
            loop.kill()
            loop.wait()

    def fall_silent(self):
        """A subscriber that never reads hangs up, and another one takes its place."""
        topic = self.rng.choice(list(SILENT))
        self.silent[topic].close()
        self.silent[topic] = connect_silently(self.address, topic, SILENT[topic])


def run_kind(kind, master, options):
    """One subject for its share of the minutes. Returns all that was measured."""
    with open(options.out / (kind + '.log'), 'w', encoding='utf-8') as log, \
            Subject(master, options.devel.resolve(), kind, options.seed, log) as subject:
        disturbances, users = Disturbances(subject, random.Random('%d %s' % (options.seed, kind))), Users(options.seed)
        disturbances.run(0.5 * 60.0 * options.minutes / len(KINDS))
        subject.wait_until_judged()
        users.stop()
        run = subject.end()
    run.update({'disturbances': {**disturbances.counts, **users.counts}, 'users': sorted(users.findings),
                'with memory': not options.sanitizer})
    return run


def run_others(options):
    """Kills and garbage, each for a quarter of the minutes, and a restart of the master. Returns what has failed."""
    names = ['kills', 'garbage_node', 'garbage_nodelet', 'master']
    if options.sanitizer == 'thread':
        names = ['kills', 'master']  # roscpp reads beyond the end of headers, where the sanitizer has no memory.
    command = [options.devel / 'env.sh', FOLDER / 'faults_test.py', '--seconds', str(15.0 * options.minutes),
               '--seed', str(options.seed), '--only']
    return ['%s: faults_test.py has failed' % name for name in names if subprocess.call([*command, name])]


def main():
    parser = argparse.ArgumentParser(usage=__doc__, add_help=False)
    parser.add_argument('--minutes', type=float, default=1.0)
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--out', type=pathlib.Path, default='soak')
    parser.add_argument('--sanitizer', choices=['address', 'thread'])
    parser.add_argument('devel', type=pathlib.Path)
    if {'-h', '--help'} & set(sys.argv[1:]):
        print(__doc__)
        return 0
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    master = OwnMaster()
    os.environ.update(master.environment)
    try:
        master.ask('setParam', '/use_sim_time', True)
        rospy.init_node('soak', disable_signals=True, disable_rosout=True)
        runs = {kind: run_kind(kind, master, options) for kind in KINDS}
    finally:
        master.stop()
    wrong = run_others(options)
    wrong += ['%s: %s' % (kind, finding) for kind, run in runs.items() for finding in verdict.findings(run)]
    result = {'minutes': options.minutes, 'seed': options.seed, 'findings': wrong, 'runs': runs}
    (options.out / 'soak.json').write_text(json.dumps(result, indent=1) + '\n', encoding='utf-8')
    print(verdict.told(result))
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
