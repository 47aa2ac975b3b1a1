#!/usr/bin/python3
"""Collision nodes on another host than the simulators: with the right addresses contacts arrive, and with wrong ones
the signs are those of doc/hosts.md. The hosts are two network namespaces of this machine, joined by a cable. Each has
its own address and name. Needs iproute2, and the right to make network namespaces."""

import os
import signal
import subprocess
import sys
import tempfile
import unittest

ADDRESSES = '10.77.0.1', '10.77.0.2'
UNUSED_ADDRESS = '10.77.0.99'
SKIPPED = 77  # exit status
OWN_NAMESPACES = ['--net', '--uts', '--pid', '--mount-proc', '--fork', '--kill-child']
CABLE = ['ip', 'link', 'add', 'left', 'type', 'veth', 'peer', 'name', 'right']
INSIDE = '--inside'


def enter():
    """Runs this program again in namespaces of its own, which end with it. If the system does not permit them, ends
    with SKIPPED."""
    if INSIDE in sys.argv:
        sys.argv.remove(INSIDE)
        os.environ.pop('ROS_HOSTNAME', None)  # It would come before ROS_IP.
        return
    for rights in [], ['--user', '--map-root-user']:
        command = ['unshare', *rights, *OWN_NAMESPACES]
        tried = subprocess.run([*command, *CABLE], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if tried.returncode == 0:
            os.execvp('unshare', [*command, sys.executable, *sys.argv, INSIDE])
    print('skipped: this system permits no network namespaces: ' + tried.stdout)
    sys.exit(SKIPPED)


class Host:
    """`words`: what a command begins with to run on this host."""

    def __init__(self, address, words=()):
        self.address, self.words = address, list(words)

    def run(self, *command):
        subprocess.run([*self.words, *command], check=True)

    def configure(self, device, name):
        self.run('ip', 'link', 'set', 'lo', 'up')
        self.run('ip', 'address', 'add', self.address + '/24', 'dev', device)
        self.run('ip', 'link', 'set', device, 'up')
        self.run('hostname', name)

    def environment(self):
        """The variables that ROS needs on this host. The master is on the first one."""
        return {'ROS_MASTER_URI': 'http://%s:11311' % ADDRESSES[0], 'ROS_IP': self.address}

    def start(self, *command, **changes):
        """Starts a program. `changes`: other values of environment variables; None: not set."""
        variables = {**os.environ, **self.environment(), **changes}
        return Program([*self.words, *command], {k: v for k, v in variables.items() if v is not None})


class Program:
    """A program whose output goes to a file."""

    def __init__(self, command, environment):
        self.file = tempfile.NamedTemporaryFile()
        self.process = subprocess.Popen(command, env=environment, stdout=self.file, stderr=subprocess.STDOUT,
                                        start_new_session=True)

    def output(self):
        """All that it has printed so far."""
        with open(self.file.name, encoding='utf-8') as text:
            return text.read()

    def stop(self):
        if self.process.poll() is None:
            os.killpg(self.process.pid, signal.SIGINT)
            try:
                self.process.wait(timeout=20)
            except subprocess.TimeoutExpired:
                os.killpg(self.process.pid, signal.SIGKILL)
                self.process.wait()


def two_hosts():
    """The first one is where this program runs."""
    second = subprocess.Popen(['unshare', '--net', '--uts', 'sleep', 'infinity'])
    enter_second = ['nsenter', '--target', str(second.pid), '--net', '--uts']
    hosts = Host(ADDRESSES[0]), Host(ADDRESSES[1], enter_second)
    subprocess.run(CABLE, check=True)
    while os.readlink('/proc/self/ns/net') == os.readlink('/proc/%d/ns/net' % second.pid):
        pass  # Until unshare has made the other namespace.
    subprocess.run(['ip', 'link', 'set', 'right', 'netns', str(second.pid)], check=True)
    for host, device, name in zip(hosts, ('left', 'right'), ('simulation', 'collision')):
        host.configure(device, name)
    return hosts


enter()  # Before ROS looks for the address of this host.
sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'rostest'))
HOSTS = two_hosts()
os.environ.update(HOSTS[0].environment())

import rosgraph  # noqa: E402
import rospy  # noqa: E402

from organ_collision.msg import ContactArray  # noqa: E402
from organ_collision.srv import ListOrgans, QueryCollision, QueryCollisionRequest  # noqa: E402
from support.node_client import ContactLog, wait_until  # noqa: E402

ORGANS = {'/liver_collision': ('liver', 'stabber'), '/sheet_collision': ('tissue', 'probe')}
LIMIT = 60.0  # [s]


class TwoHostsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.simulation, cls.collision = HOSTS
        cls.roscore = cls.simulation.start('roscore', '-p', '11311')
        cls.addClassCleanup(cls.roscore.stop)
        cls.master = rosgraph.Master('two_hosts_test')
        wait_until(cls.master.is_online, 'the master', LIMIT)
        rospy.init_node('two_hosts_test')
        cls.addClassCleanup(rospy.signal_shutdown, 'the tests have ended')

    def start(self, host, *command, **environment):
        program = host.start(*command, **environment)
        self.addCleanup(program.stop)
        return program

    def launch(self, host, *arguments, **environment):
        return self.start(host, 'roslaunch', '--wait', 'organ_collision', 'two_hosts.launch', *arguments, **environment)

    def service_address(self, name, address):
        """Waits until a node has registered a service under this address."""
        def registered():
            try:
                return self.master.lookupService(name).startswith('rosrpc://%s:' % address)
            except rosgraph.MasterException:
                return False
        wait_until(registered, '%s at %s' % (name, address), LIMIT)

    def start_node(self, **environment):
        """The node of simulator.py, on the other host."""
        rospy.set_param('/organ_collision', {'tools': []})
        return self.start(self.collision, 'rosrun', 'organ_collision', 'organ_collision_node', **environment)

    def said(self, *command):
        """What a command of ROS says on the first host."""
        program = self.start(self.simulation, *command)
        program.process.wait(timeout=LIMIT)
        return program.output()

    def test_contacts_of_two_organs_come_from_the_other_host(self):
        logs = {node: ContactLog(node + '/contacts') for node in ORGANS}
        nodes = self.launch(self.collision, 'simulators:=false')
        simulators = self.launch(self.simulation, 'nodes:=false')
        for node, (organ, tool) in ORGANS.items():
            self.service_address(node + '/query', self.collision.address)
            wait_until(lambda: [m for m in logs[node].of(organ, tool, status=ContactArray.OK) if m.contacts],
                       lambda: 'contacts of %s; the launch files said: %s %s'
                       % (organ, nodes.output(), simulators.output()), LIMIT)
            self.assertEqual({(m.organ, m.tool) for m in logs[node].messages}, {(organ, tool)})
            answer = rospy.ServiceProxy(node + '/query', QueryCollision)(QueryCollisionRequest(organ=organ, tool=tool))
            self.assertEqual(answer.result.organ, organ)

    def test_a_node_with_a_wrong_address_or_without_one_is_out_of_reach(self):
        """Without an address, it gives the name of its host, which the other one does not know."""
        for given, shown in ((UNUSED_ADDRESS, UNUSED_ADDRESS), (None, 'collision')):
            node = self.start_node(ROS_IP=given)
            self.service_address('/organ_collision/list_organs', shown)
            said = self.said('rosservice', 'call', '/organ_collision/list_organs')
            self.assertIn('address [rosrpc://%s:' % shown, said)
            self.check_no_reply('/organ_collision')
            node.stop()

    def check_no_reply(self, node):
        self.assertRegex(self.said('rosnode', 'ping', '-c', '1', node), 'failed|timed out')

    def test_organs_of_a_simulator_with_a_wrong_address_do_not_arrive(self):
        self.start_node()
        self.service_address('/organ_collision/list_organs', self.collision.address)
        self.start(self.simulation, 'rosrun', 'organ_collision', 'simulator.py', ROS_IP=UNUSED_ADDRESS)
        wait_until(lambda: self.publishes('/simulator', '/organ_collision/organ_mesh'), 'the simulator', LIMIT)
        self.check_no_reply('/simulator')
        self.assertEqual(rospy.ServiceProxy('/organ_collision/list_organs', ListOrgans)().organs, [])

    def publishes(self, node, topic):
        publishers, _, _ = self.master.getSystemState()
        return [topic, node] in [[name, one] for name, nodes in publishers for one in nodes]

    def test_roslaunch_refuses_an_address_that_is_not_the_hosts(self):
        for address in (UNUSED_ADDRESS, None):
            launched = self.launch(self.collision, 'simulators:=false', ROS_IP=address)
            launched.process.wait(timeout=LIMIT)
            self.assertNotEqual(launched.process.returncode, 0)
            self.assertIn('Unable to contact my own server at [http://%s:' % (address or 'collision'), launched.output())


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1], verbosity=2)
