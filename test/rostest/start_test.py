#!/usr/bin/python3
"""How programs start and end. Illegal parameters stop the node with a message, and misspelt ones are reported. Which
OpenGL it takes. It accepts a latched mesh that is older than itself. What it says about real-time scheduling is what
the system says. check_contacts ends with the right exit code."""

import os
import signal
import sys
import time

from diagnostic_msgs.msg import DiagnosticStatus
from organ_collision.msg import Contact, ContactArray
import roslib.packages
import rospy
import rostest
from std_srvs.srv import Trigger

from support.contact_case import ContactCase
from support.node_client import LIMIT, Diagnostics, NodeClient, is_heard, shaft, wait_until
from support.processes import NodeStarter
from support.tool_over_sheet import RADIUS, SHEET, at_height, depth_at

TOOL = {'name': 'grasper', 'trocar_frame': 'grasper_trocar', 'tip_frame': 'grasper_tip', 'radius': 0.005}
MISSING_GL = os.path.join(roslib.packages.get_pkg_dir('organ_collision'), 'test/data/missing_gl')
PRIORITY = 7
REALTIME = {'tools': [], 'diagnostic_period_sec': 0.1, 'realtime_priority': PRIORITY, 'lock_memory': True}
# Runs a command without the right to real-time scheduling and locked memory. Only root has the capabilities.
WITHOUT_RIGHTS = ['prlimit', '--rtprio=0:0', '--memlock=65536:65536'] + (
    ['setpriv', '--bounding-set', '-sys_nice,-ipc_lock'] if os.geteuid() == 0 else [])
# What roscpp starts with a node: its sockets, its XML-RPC server, its log, its queue, its timers.
THREADS_OF_ROSCPP = 5


def realtime_threads(process):
    def is_realtime(thread):
        policy = os.sched_getscheduler(thread) & ~os.SCHED_RESET_ON_FORK
        return policy == os.SCHED_FIFO and os.sched_getparam(thread).sched_priority == PRIORITY

    return [int(name) for name in os.listdir('/proc/%d/task' % process) if is_realtime(int(name))]


def locked_kilobytes(process):
    with open('/proc/%d/status' % process, encoding='utf-8') as status:
        return next(int(line.split()[1]) for line in status if line.startswith('VmLck:'))


class StartTest(ContactCase, NodeStarter):
    def setUp(self):
        self.name = '/' + self.id().split('.')[-1]

    def start_each(self, **parameters):
        """The three nodes, by name. The parameters are those of the nodes with organs."""
        rows = {'organ_collision_node': dict(parameters, tools=parameters.get('tools', [TOOL])), 'tool_guard': {}}
        rows['haptic_proxy'] = {key: value for key, value in rows['organ_collision_node'].items() if key != 'rate'}
        return {self.name + program: self.start(self.name + program, dict(row, diagnostic_period_sec=0.1), program)
                for program, row in rows.items()}

    def test_sigterm_and_sigint_end_all_nodes_with_0(self):
        for end in (signal.SIGTERM, signal.SIGINT):
            nodes = self.start_each()
            for name, process in nodes.items():
                Diagnostics(name).wait_for_summary('master', 'listed')
                process.send_signal(end)
            for name, process in nodes.items():
                printed, _ = process.communicate(timeout=LIMIT)
                self.assertEqual(process.returncode, 0, (name, end, printed))

    def test_simulated_time_that_does_not_begin_is_told(self):
        rospy.set_param('/use_sim_time', True)
        self.addCleanup(rospy.delete_param, '/use_sim_time')
        nodes = self.start_each()
        for name in nodes:
            Diagnostics(name).wait_for_summary('clock', '/clock', level=DiagnosticStatus.WARN)
        time.sleep(5.0)  # The log says it after 3 s.
        for process in nodes.values():
            self.assertIn('no time has come on /clock', self.stop(process))

    def without(self, libraries):
        """The words of a command that runs a node where these GL libraries are missing: files that are no libraries
        come first."""
        paths = os.path.join(MISSING_GL, libraries), os.environ.get('LD_LIBRARY_PATH', '')
        return ['env', 'LD_LIBRARY_PATH=%s:%s' % paths]

    def assert_finds_contacts(self, node):
        self.assert_depth(node.query('sheet', shaft(*at_height(0.002), RADIUS)), depth_at(0.002))

    def test_without_osmesa_there_is_egl_and_without_both_the_cpu_picks(self):
        for libraries, picker, said in (('osmesa', 'feedback', 'on EGL'), ('osmesa_egl', 'cpu', 'GL none')):
            parameters = {'tools': [TOOL], 'picker': picker}
            process = self.start(self.name + picker, parameters, through=self.without(libraries))
            node = NodeClient(self.name + picker)
            node.bring('sheet', SHEET, rospy.Time(1))
            self.assert_finds_contacts(node)
            self.assertIn(said, self.stop(process))

    @staticmethod
    def scheduling(node):
        """The level of the status about scheduling on /diagnostics, and all values."""
        said = Diagnostics(node)
        wait_until(lambda: 'scheduling' in said.levels and 'scheduling' in said.values, node)
        return said.levels['scheduling'], said.values

    def test_real_time_with_the_rights_of_this_test(self):
        for name, program in (('/fast_node', 'organ_collision_node'), ('/fast_proxy', 'haptic_proxy')):
            process = self.start(name, REALTIME, program)
            level, values = self.scheduling(name)
            granted = realtime_threads(process.pid)
            self.assertEqual(values['scheduling'], 'SCHED_FIFO, priority %d' % PRIORITY if granted else 'ordinary')
            if granted:
                self.assertIn(process.pid, granted)  # The main thread, which does the steps.
                self.assertIn(len(granted),
                              range(1 + THREADS_OF_ROSCPP, len(os.listdir('/proc/%d/task' % process.pid))))
            has_locked = float(values['locked memory of the process [MiB]']) > 0.0
            self.assertEqual(has_locked, locked_kilobytes(process.pid) > 0)
            self.assertEqual(level, DiagnosticStatus.OK if granted and has_locked else DiagnosticStatus.WARN)
            self.stop(process)

    def test_real_time_without_rights(self):
        """The node goes on, and says what to do."""
        process = self.start('/slow_node', REALTIME, through=WITHOUT_RIGHTS)
        level, values = self.scheduling('/slow_node')
        self.assertEqual((level, values['scheduling'], values['locked memory of the process [MiB]']),
                         (DiagnosticStatus.WARN, 'ordinary', '0'))
        self.assertEqual(realtime_threads(process.pid), [])
        printed = self.stop(process)
        for words in ('realtime_priority 7 is refused: Operation not permitted', 'limit rtprio to at least 7',
                      'lock_memory is refused: locked memory is limited to 64 kB'):
            self.assertIn(words, printed)

    def test_exit_codes_of_check_contacts(self):
        """By the answers on its topics: good, bad, and none."""

        def answer(fraction):
            found = ContactArray(organ='liver', tool='probe', mode=ContactArray.SWEPT)
            found.header.frame_id, found.header.stamp, found.step_start = 'liver_frame', rospy.Time(2), rospy.Time(1)
            found.contacts = [Contact(link=-1, fraction=fraction, barycentric=[0.2, 0.3, 0.5])]
            found.contacts[0].normal.z = 1.0
            return found

        for topic, fractions, code, words in (
            ('/good', (0.5,), 0, ['1 answers came, 1 with status OK']),
            ('/bad', (0.5, float('nan'), 1.5), 1,
             ["'liver'", "'probe'", 'fraction of contacts[0] (face 0) is nan', 'shares 2']),
            ('/silent', (), 3, ['0 answers came']),
        ):
            publisher, name = rospy.Publisher(topic, ContactArray, queue_size=10), topic + '_watcher'
            process = self.start(name, {}, 'check_contacts', arguments=[topic])
            wait_until(lambda: is_heard(publisher, name), 'connections')
            for fraction in fractions:
                publisher.publish(answer(fraction))
            rospy.wait_for_service(name + '/summary', LIMIT)
            ask = rospy.ServiceProxy(name + '/summary', Trigger)
            wait_until(lambda: ask().message.startswith('%d answers' % len(fractions)), lambda: ask().message)
            self.assertEqual(ask().success, code != 1)
            printed = self.stop(process, code)
            for word in words:
                self.assertIn(word, printed)


if __name__ == '__main__':
    rospy.init_node('start_test')
    rostest.rosrun('organ_collision', 'start', StartTest, sys.argv)
