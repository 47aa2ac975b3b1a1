#!/usr/bin/python3
"""The ROS master is killed and started again. All nodes of the package say in the log and on /diagnostics that they
must be restarted."""

import os
import shlex
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'rostest'))

from support.node_client import wait_until  # noqa: E402
from support.processes import OwnMaster, program  # noqa: E402

PROGRAMS = {'/organ_collision': ('organ_collision_node', {'tools': []}),
            '/haptic_proxy': ('haptic_proxy', {'tools': []}),
            '/organ_mesh_adapter': ('organ_mesh_adapter', {'organs': []}), '/contact_adapter': ('contact_adapter', {})}
FAULT = 'the ROS master does not list this node any more'


class MasterRestartTest(unittest.TestCase):
    def setUp(self):
        self.master = OwnMaster()
        self.addCleanup(self.master.stop)

    def log_of(self, *words):
        """Starts a program. Returns a function that returns what it has printed."""
        log = tempfile.NamedTemporaryFile('w')
        self.addCleanup(log.close)
        self.master.run(*words, stdout=log, stderr=log)

        def printed():
            with open(log.name) as text:
                return text.read()
        return printed

    def test_the_nodes_say_that_they_must_be_restarted(self):
        logs = {}
        for node, (name, parameters) in PROGRAMS.items():
            self.master.ask('setParam', node, {'diagnostic_period': 0.2, **parameters})
            logs[node] = self.log_of(program(name), '__name:=' + node.strip('/'))
        nodelet = program('nodelet', 'nodelet')
        self.master.ask('setParam', '/nodelet', {'tools': []})
        prefix = shlex.split(os.environ.get('ORGAN_COLLISION_NODELET_PREFIX', ''))
        logs['/nodelet'] = self.log_of(*prefix, nodelet, 'manager', '__name:=manager')
        self.master.run(nodelet, 'load', 'organ_collision/CollisionNodelet', 'manager', '__name:=nodelet')
        diagnostics = self.log_of(sys.executable, program('rostopic', 'rostopic'), 'echo', '/diagnostics')
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
