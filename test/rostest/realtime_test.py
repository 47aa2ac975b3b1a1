#!/usr/bin/python3
"""Real-time scheduling, locked memory and awake cores: what the node says on /diagnostics is what the system says
about its process, whether the system grants it or refuses it."""

import os
import sys
import xmlrpc.client

import rosgraph
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

from support.node_client import wait_until
from support.node_starter import NodeStarter

PRIORITY = 7
PARAMETERS = {
    'tools': [],
    'diagnostic_period': 0.1,
    'realtime_priority': PRIORITY,
    'lock_memory': True,
    'awake_cores': True,
}
# Commands that run another one without the right to real-time scheduling and locked memory.
WITHOUT_LIMITS = ['prlimit', '--rtprio=0:0', '--memlock=65536:65536']
WITHOUT_CAPABILITIES = ['setpriv', '--bounding-set', '-sys_nice,-ipc_lock']
# What roscpp starts with a node: its sockets, its XML-RPC server, its log, its queue, its timers.
THREADS_OF_ROSCPP = 5


def without_rights():
    """Only root has the capabilities, and only root can give them up."""
    return WITHOUT_LIMITS + (WITHOUT_CAPABILITIES if os.geteuid() == 0 else [])


def is_realtime(thread):
    policy = os.sched_getscheduler(thread) & ~os.SCHED_RESET_ON_FORK
    return policy == os.SCHED_FIFO and os.sched_getparam(thread).sched_priority == PRIORITY


def realtime_threads(process):
    threads = [int(name) for name in os.listdir('/proc/%d/task' % process)]
    return [thread for thread in threads if is_realtime(thread)]


def locked_kilobytes(process):
    with open('/proc/%d/status' % process, encoding='utf-8') as status:
        return [int(line.split()[1]) for line in status if line.startswith('VmLck:')][0]


def keeps_cores_awake(process):
    folder = '/proc/%d/fd/' % process

    def target(name):
        try:
            return os.readlink(folder + name)
        except FileNotFoundError:  # It was closed since the list was made.
            return ''

    return any(target(name) == '/dev/cpu_dma_latency' for name in os.listdir(folder))


def process_of(node):
    """The number of the process of a node."""
    address = rosgraph.Master(rospy.get_name()).lookupNode(node)
    return xmlrpc.client.ServerProxy(address).getPid(rospy.get_name())[2]


class RealtimeTest(NodeStarter):
    @classmethod
    def setUpClass(cls):
        cls.statuses = {}
        cls.subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, cls.keep)

    @classmethod
    def keep(cls, message):
        for status in message.status:
            cls.statuses[status.name.lstrip('/')] = status

    def scheduling(self, node):
        """The status about scheduling on /diagnostics, and its values. The first status says only
        that the node starts."""
        name = node.strip('/') + ': scheduling'
        wait_until(lambda: name in self.statuses and self.statuses[name].values, name)
        status = self.statuses[name]
        return status, {pair.key: pair.value for pair in status.values}

    def check(self, name, program):
        """A node with the rights of this test."""
        process = self.start(name, PARAMETERS, program)
        status, values = self.scheduling(name)
        granted = realtime_threads(process.pid)
        if granted:
            self.assertEqual(values['scheduling'], 'SCHED_FIFO, priority %d' % PRIORITY)
            self.assertIn(process.pid, granted)  # The main thread, which does the steps.
            self.assertGreaterEqual(len(granted), 1 + THREADS_OF_ROSCPP)
            self.assertLess(len(granted), len(os.listdir('/proc/%d/task' % process.pid)))
        else:
            self.assertEqual(values['scheduling'], 'ordinary')
        shown = float(values['locked memory of the process [MiB]'])
        self.assertEqual(shown > 0.0, locked_kilobytes(process.pid) > 0)
        is_awake = keeps_cores_awake(process.pid)
        self.assertEqual(values.get('idle cores') == 'awake', is_awake)
        is_whole = bool(granted) and shown > 0.0 and is_awake
        self.assertEqual(status.level, DiagnosticStatus.OK if is_whole else DiagnosticStatus.WARN)
        printed = self.stop(process)
        self.assertEqual('realtime_priority 7 is refused' in printed, not granted, printed)
        self.assertEqual('lock_memory is refused' in printed, shown == 0.0, printed)
        self.assertEqual('awake_cores is refused' in printed, not is_awake, printed)

    def test_the_node(self):
        self.check('/fast_node', 'organ_collision_node')

    def test_the_haptic_proxy(self):
        self.check('/fast_proxy', 'haptic_proxy')

    def test_without_rights_the_node_goes_on_and_says_what_to_do(self):
        for name, program in (('/node', 'organ_collision_node'), ('/proxy', 'haptic_proxy')):
            process = self.start(name, PARAMETERS, program, without_rights())
            status, values = self.scheduling(name)
            self.assertEqual(values['scheduling'], 'ordinary')
            self.assertEqual(values['locked memory of the process [MiB]'], '0')
            self.assertEqual(status.level, DiagnosticStatus.WARN)
            self.assertEqual(realtime_threads(process.pid), [])
            printed = self.stop(process)
            self.assertIn('realtime_priority 7 is refused: Operation not permitted', printed)
            self.assertIn('limit rtprio to at least 7', printed)
            self.assertIn('lock_memory is refused: locked memory is limited to 64 kB', printed)

    def test_a_nodelet_leaves_the_other_threads_of_its_manager_alone(self):
        values = self.scheduling('in_manager')[1]
        manager = process_of('/manager')
        granted = realtime_threads(manager)
        self.assertEqual(bool(granted), values['scheduling'].startswith('SCHED_FIFO'))
        self.assertNotIn(manager, granted)
        self.assertEqual(locked_kilobytes(manager), 0)
        self.assertFalse(keeps_cores_awake(manager))


if __name__ == '__main__':
    rospy.init_node('realtime_test')
    rostest.rosrun('organ_collision', 'realtime', RealtimeTest, sys.argv)
