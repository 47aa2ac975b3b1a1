#!/usr/bin/python3
"""Faults from outside: the node is killed at random times, node and simulators hang, and the ROS master is restarted.
The simulators know nothing of all this.

Usage: faults_test.py [--seconds N] [--seed S]. run_soak runs it for long."""

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

from organ_collision.msg import ContactArray, OrganMesh, OrganVertices
import rospy
import rostest

from support import scenes
from support.node_client import LIMIT, TfSender, mesh_message, vertices_message, wait_until
from support.processes import OwnMaster, nodelet, program

NODE, FRAME = '/organ_collision', 'liver_frame'
PAIRS = {('liver', 'probe'), ('kidney', 'needle')}  # of organ and tool, one for each simulator
LONGEST_LIFE = 0.3  # [s] from the first contacts until the next kill
LONGEST_START = 0.6  # [s] of a life that ends while the node starts
LONGEST_HANG = 0.5  # [s]
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


class Answers:
    """What came on `contacts` since `begin()`, with stamps of after it. `pairs` are those that touch."""

    def __init__(self):
        self.lock = threading.Lock()
        self.begin()
        self.subscriber = rospy.Subscriber(NODE + '/contacts', ContactArray, self.take, queue_size=1000)

    def begin(self):
        with self.lock:
            self.begun = rospy.Time.now()
            self.pairs, self.too_long = set(), []

    def take(self, answer):
        with self.lock:
            if answer.status != ContactArray.OK or answer.header.stamp < self.begun:
                return
            if answer.contacts:
                self.pairs.add((answer.organ, answer.tool))
            if answer.step_start < self.begun:
                self.too_long.append('%s and %s: from %s to %s, in a life that began at %s' % (
                    answer.organ, answer.tool, answer.step_start, answer.header.stamp, self.begun))

    def wait_for_all(self):
        """Waits until all pairs touch. Returns how long it took [s]."""
        begin = time.monotonic()
        wait_until(lambda: self.pairs >= PAIRS, lambda: 'contacts of all pairs; there are %s' % self.pairs)
        return time.monotonic() - begin


class FaultsTest(unittest.TestCase):
    master = options = None

    def setUp(self):
        self.rng = random.Random(self.options.seed)
        self.addCleanup(self.master.stop_programs)

    def start(self, *words):
        return self.master.run(*words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def hang(self, process):
        process.send_signal(signal.SIGSTOP)
        time.sleep(self.rng.uniform(0.0, LONGEST_HANG))
        process.send_signal(signal.SIGCONT)

    def test_kills_and_hangs(self):
        """A node that is killed by SIGKILL, also while it starts, is started again. Node and simulators stop and go on.
        Contacts flow again by themselves, and all answers keep their contract. No step reaches back into the life
        before."""
        tools = [{'name': tool, 'trocar_frame': tool + '_trocar', 'tip_frame': tool + '_tip', 'radius': 0.005}
                 for _, tool in sorted(PAIRS)]
        self.master.ask('setParam', NODE, {'tools': tools})
        simulators = [self.start(os.path.abspath(__file__), 'simulate', organ, tool, '__name:=simulator_of_' + organ)
                      for organ, tool in sorted(PAIRS)]
        checker = self.start(program('check_contacts'))
        answers = Answers()
        self.addCleanup(answers.subscriber.unregister)
        node = self.start(program('organ_collision_node'))
        answers.wait_for_all()
        waited, killed, end = [], 0, time.monotonic() + self.options.seconds
        while time.monotonic() < end or not waited:
            self.hang(self.rng.choice(simulators + [node]))
            for longest in [LONGEST_LIFE] + [LONGEST_START] * (self.rng.random() < 0.5):
                time.sleep(self.rng.uniform(0.0, longest))
                answers.begin()
                node.kill()
                node.wait()
                node = self.start(program('organ_collision_node'))
                killed += 1
            waited.append(answers.wait_for_all())
            self.assertEqual(answers.too_long, [])
        checker.send_signal(signal.SIGINT)
        self.assertEqual(checker.wait(LIMIT), 0, 'check_contacts has found something')
        print('%d hangs, %d kills; contacts came again after %.2f s (median), %.2f s (longest)' % (
            len(waited), killed, statistics.median(waited), max(waited)))

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
        self.master.ask('setParam', NODE, {'tools': [], 'diagnostic_period_sec': 0.2})
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
    parser.add_argument('--seconds', type=float, default=60.0, help='of kills and hangs')
    parser.add_argument('--seed', type=int, default=1, help='of the random times')
    FaultsTest.options, others = parser.parse_known_args()
    FaultsTest.master = OwnMaster()
    os.environ['ROS_MASTER_URI'] = FaultsTest.master.uri
    rospy.init_node('faults_test', disable_signals=True, disable_rosout=True)
    try:
        rostest.rosrun('organ_collision', 'faults', FaultsTest, sys.argv[:1] + others)
    finally:
        FaultsTest.master.stop()
