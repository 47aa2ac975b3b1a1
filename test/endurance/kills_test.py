#!/usr/bin/python3
"""A node with respawn="true" is killed at random times by SIGKILL, also while it starts. After each kill, contacts flow
again by themselves. No step reaches back into the life before. The simulators know nothing of all this.

Usage: kills_test.py [--seconds N] [--seed S]
"""

import argparse
import os
import random
import signal
import statistics
import subprocess
import sys
import threading
import time
import unittest

FOLDER = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(FOLDER, '..', 'rostest'))

from organ_collision.msg import ContactArray  # noqa: E402
import rospy  # noqa: E402
from support.node_client import wait_until  # noqa: E402
from support.processes import OwnMaster, program  # noqa: E402

PAIRS = {('liver', 'probe'), ('kidney', 'needle')}  # of organ and tool, one for each simulator
PROCESS = 'organ_collision_node'[:15]  # Linux keeps 15 letters.
LIMIT = 30.0  # [s] from the start of a node until contacts of all pairs flow
LONGEST_LIFE = 0.3  # [s] from then on until the next kill
LONGEST_START = 0.6  # [s] of a life that ends while the node starts


def children(parent):
    """{process id: name of its program} of the children of a process."""
    found = {}
    for entry in filter(str.isdigit, os.listdir('/proc')):
        try:
            with open('/proc/%s/stat' % entry) as file:
                name, fields = file.read().rsplit(')', 1)
        except OSError:  # It has ended.
            continue
        if int(fields.split()[1]) == parent:
            found[int(entry)] = name.split('(', 1)[1]
    return found


class Answers:
    """What came on `contacts` since `begin()`, with stamps of after it. `pairs` are those that touch."""

    def __init__(self):
        self.lock = threading.Lock()
        self.begin()
        self.subscriber = rospy.Subscriber('/organ_collision/contacts', ContactArray, self.take, queue_size=1000)

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


class KillsTest(unittest.TestCase):
    options = None

    def setUp(self):
        self.random = random.Random(self.options.seed)
        self.master = OwnMaster()
        self.addCleanup(self.master.stop)
        os.environ.update(self.master.environment)
        self.launch = self.master.run('roslaunch', os.path.join(FOLDER, 'respawned.launch'), stdout=subprocess.DEVNULL,
                                      stderr=subprocess.DEVNULL)
        for organ, tool in sorted(PAIRS):
            self.master.run(os.path.join(FOLDER, 'fault_simulator.py'), organ, tool, '__name:=simulator_of_' + organ)
        self.checker = self.master.run(program('check_contacts'))
        rospy.init_node('kills_test', disable_signals=True)
        self.answers = Answers()

    def node(self):
        """The process id of the running node; None: it is not started yet."""
        found = [pid for pid, name in children(self.launch.pid).items() if name == PROCESS]
        return found[0] if found else None

    def kill(self):
        """Kills the node, and returns when roslaunch has started the next one."""
        killed = wait_until(self.node, 'a process of the node', LIMIT)
        self.answers.begin()
        os.kill(killed, signal.SIGKILL)
        wait_until(lambda: self.node() not in (None, killed), 'the next process of the node', LIMIT)

    def wait_for_contacts(self):
        """Returns how long it took [s]."""
        begin = time.monotonic()
        wait_until(lambda: self.answers.pairs >= PAIRS,
                   lambda: 'contacts of all pairs; there are those of %s' % self.answers.pairs, LIMIT)
        return time.monotonic() - begin

    def test_contacts_flow_again(self):
        self.wait_for_contacts()
        waited, killed, with_static, end = [], 0, 0, time.monotonic() + self.options.seconds
        while time.monotonic() < end or not waited:
            for longest in [LONGEST_LIFE] + [LONGEST_START] * (self.random.random() < 0.5):
                time.sleep(self.random.uniform(0.0, longest))
                self.kill()
                killed += 1
            waited.append(self.wait_for_contacts())
            self.assertEqual(self.answers.too_long, [])
            with_static += self.answers.has_seen_static
        self.checker.send_signal(signal.SIGINT)
        self.assertEqual(self.checker.wait(LIMIT), 0)
        print('%d kills, %d of them while the node started; contacts came again after %.2f s (median), %.2f s (longest); '
              'the first static step was seen %d of %d times' % (
                  killed, killed - len(waited), statistics.median(waited), max(waited), with_static, len(waited)))


if __name__ == '__main__':
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--seconds', type=float, default=10.0)
    parser.add_argument('--seed', type=int, default=4711, help='of the random times')
    KillsTest.options = parser.parse_args()
    unittest.main(argv=sys.argv[:1], verbosity=2)
