#!/usr/bin/python3
"""The ROS master is killed and started again, twice. All nodes of the package are listed again by themselves, with all
topics, services and parameters. What was connected stays connected, and new nodes connect."""

import os
import sys
import time
import unittest

FOLDER = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(FOLDER, '..'))

import roslib.packages  # noqa: E402
from support.node_client import wait_until  # noqa: E402
from support.own_master import OwnMaster  # noqa: E402

TOOLS = [
    {'name': name, 'trocar_frame': name + '_trocar', 'tip_frame': name + '_tip', 'radius': 0.005}
    for name in ('probe', 'needle', 'hook')
]
PARAMETERS = {
    '/organ_collision': {'tools': TOOLS, 'diagnostic_period': 0.2},
    '/nodelet': {'tools': TOOLS},
    '/haptic_proxy': {'tools': TOOLS, 'stiffness': 500.0, 'max_force': 1.0, 'max_torque': 1.0},
    '/organ_mesh_adapter': {'organs': [{'name': 'liver', 'topic': '/surface', 'frame': 'liver_frame'}]},
    '/contact_adapter': {'stiffness': 500.0},
}
NODES = set(PARAMETERS) - {'/nodelet'} | {'/manager'}


def program(name):
    return roslib.packages.find_node('organ_collision', name)[0]


class MasterRestartTest(unittest.TestCase):
    def setUp(self):
        self.master = OwnMaster()
        self.addCleanup(self.master.stop)
        for node, parameters in PARAMETERS.items():
            self.master.ask('setParam', node, parameters)
        for node in sorted(NODES - {'/manager'}):
            name = node.strip('/')
            self.master.run(program(name + '_node' if name == 'organ_collision' else name), '__name:=' + name)
        nodelet = roslib.packages.find_node('nodelet', 'nodelet')[0]
        prefix = os.environ.get('ORGAN_COLLISION_NODELET_PREFIX', '').split()
        self.master.run(*prefix, nodelet, 'manager', '__name:=manager')
        self.master.run(nodelet, 'load', 'organ_collision/CollisionNodelet', 'manager', '__name:=nodelet')

    def record(self):
        """What the master knows of the package's nodes."""
        return {entry for entry in self.master.record() if entry[2] in NODES}

    def start_simulator(self, organ, tool):
        self.master.run(os.path.join(FOLDER, 'fault_simulator.py'), organ, tool, '__name:=simulator_of_' + organ)

    def hear(self, organ, tool, topic='/organ_collision/contacts'):
        """A new subscriber gets contacts of the organ with a stamp of now."""
        self.master.output(
            'rostopic', 'echo', '-n', '1', topic, '--filter',
            'm.organ == "%s" and m.tool == "%s" and m.contacts and m.header.stamp.to_sec() > %f'
            % (organ, tool, time.time()),
        )

    def settled_record(self):
        """The record, when the nodes have run for long enough to have read it once, too."""
        services = {('service', '/organ_collision/query', '/organ_collision'),
                    ('service', '/nodelet/query_batch', '/manager'), ('service', '/haptic_proxy/reset', '/haptic_proxy'),
                    ('publisher', '/contact_adapter/old/probe/wrench', '/contact_adapter')}
        wait_until(lambda: services <= self.record() and NODES <= {entry[2] for entry in self.record()},
                   lambda: 'all nodes: %s' % sorted(self.record()))
        time.sleep(3.0)
        return self.record()

    def restart(self):
        self.master.kill()
        time.sleep(1.5)
        self.master.start()

    def test_the_nodes_are_back(self):
        self.start_simulator('old', 'probe')
        self.hear('old', 'probe')
        before = self.settled_record()
        for number, (organ, tool) in enumerate((('new', 'needle'), ('newer', 'hook')), 1):
            self.restart()
            wait_until(lambda: before <= self.record(),
                       lambda: 'registered again; missing: %s' % sorted(before - self.record()))
            for node, parameters in PARAMETERS.items():
                for name, value in parameters.items():
                    self.assertEqual(self.master.ask('getParam', node + '/' + name), value)
            # A new simulator is heard. The old one, which is not listed by itself, still is.
            self.start_simulator(organ, tool)
            self.hear(organ, tool)
            self.hear('old', 'probe')
            listed = self.master.output('rosservice', 'call', '/organ_collision/list_organs')
            self.assertIn('name: "old"', listed)
            self.assertIn('name: "%s"' % organ, listed)
            told = self.master.output(
                'rostopic', 'echo', '-n', '1', '/diagnostics', '--filter',
                'any(s.name.endswith("organ_collision: master") for s in m.status)'
            )
            self.assertRegex(told, r'key: "registered again"\s+value: "%d"' % number)
            self.assertIn('/organ_collision', self.master.output('rosnode', 'list').split())


if __name__ == '__main__':
    unittest.main(verbosity=2)
