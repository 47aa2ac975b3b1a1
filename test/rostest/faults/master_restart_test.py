#!/usr/bin/python3
"""The ROS master is killed and started again. All nodes of the package say in the log and on /diagnostics that they must
be restarted, and go on for those that are connected."""

import os
import sys
import tempfile
import unittest

FOLDER = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(FOLDER, '..'))

import roslib.packages  # noqa: E402
from support.node_client import wait_until  # noqa: E402
from support.own_master import OwnMaster  # noqa: E402

PROGRAMS = {'/organ_collision': ('organ_collision_node', {'tools': []}), '/haptic_proxy': ('haptic_proxy', {'tools': []}),
            '/organ_mesh_adapter': ('organ_mesh_adapter', {'organs': []}), '/contact_adapter': ('contact_adapter', {})}
FAULT = 'the ROS master does not list this node any more'


def program(package, name):
    return roslib.packages.find_node(package, name)[0]


class MasterRestartTest(unittest.TestCase):
    def setUp(self):
        self.master = OwnMaster()
        self.addCleanup(self.master.stop)

    def log_of(self, *words):
        """Starts a program. Returns a function that returns what it has printed."""
        log = tempfile.TemporaryFile('w+')
        self.addCleanup(log.close)
        self.master.run(*words, stdout=log, stderr=log)

        def printed():
            log.seek(0)
            return log.read()
        return printed

    def test_the_nodes_say_that_they_must_be_restarted(self):
        logs = {}
        for node, (name, parameters) in PROGRAMS.items():
            self.master.ask('setParam', node, {'diagnostic_period': 0.2, **parameters})
            logs[node] = self.log_of(program('organ_collision', name), '__name:=' + node.strip('/'))
        nodelet = program('nodelet', 'nodelet')
        self.master.ask('setParam', '/nodelet', {'tools': []})
        prefix = os.environ.get('ORGAN_COLLISION_NODELET_PREFIX', '').split()
        logs['/nodelet'] = self.log_of(*prefix, nodelet, 'manager', '__name:=manager')
        self.master.run(nodelet, 'load', 'organ_collision/CollisionNodelet', 'manager', '__name:=nodelet')
        diagnostics = self.log_of(program('rostopic', 'rostopic'), 'echo', '/diagnostics')
        names = ['%s: master' % node.strip('/') for node in logs]
        wait_until(lambda: all(name in diagnostics() for name in names), 'all nodes on /diagnostics')
        self.assertNotIn(FAULT, diagnostics())
        self.master.kill()
        wait_until(lambda: 'does not answer' in diagnostics(), 'a node misses the master')
        self.master.start()
        wait_until(lambda: all(FAULT in printed() for printed in logs.values()), 'the logs tell it')
        wait_until(lambda: diagnostics().count(FAULT) > 5 * len(names), '/diagnostics tells it again and again')


if __name__ == '__main__':
    unittest.main(verbosity=2)
