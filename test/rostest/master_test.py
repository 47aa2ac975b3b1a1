#!/usr/bin/python3
"""Nodes that are held up. Their process pauses, and the force does not jump. The ROS master hangs, and ends, while hands press, organs appear, tools are reloaded and parameters are set. No answer
waits for it. The test has a master of its own. It counts poses, not time: a node that waits for 3 s lets hundreds pass."""

import os
import signal
import sys
import threading
import time

from dynamic_reconfigure.msg import DoubleParameter
from dynamic_reconfigure.srv import Reconfigure, ReconfigureRequest
from geometry_msgs.msg import PoseStamped, WrenchStamped
from organ_collision.msg import ContactArray, OrganMesh, ProxyState
import rospy
import rostest
from std_srvs.srv import Trigger

from support import scenes
from support.node_client import LIMIT, Log, TfSender, is_heard, mesh_message, pose_stamped, wait_until
from support.processes import NodeStarter, OwnMaster

FRAME, SHEET = 'liver_frame', scenes.sheet(0.1, 4)
PERIOD, HANG = 0.005, 3.0  # [s] between two poses; how long the master hangs
MOST = 60  # [poses] 0.3 s: the most poses between two answers
NEW_TOOLS = 100
RATE, DEPTH = 100.0, -0.004  # [N/s], [m]


def tool(name):
    return dict(name=name, trocar_frame='trocar', tip_frame=name + '_tip', tip_pose_topic='/pose', radius=0.003)


class Watched:
    """A node with a tool whose hand presses. It notes how many poses at most were sent between two answers of a topic.
    Its services are connected, since the master may hang later."""

    def __init__(self, name, process, topic, kind, parameter):
        self.name, self.process, self.parameter = name, process, parameter
        self.sent = self.answered = self.most = 0
        for service in ('/set_parameters', '/reload_tools'):
            rospy.wait_for_service(name + service, LIMIT)
        self.set_parameters, self.reload = (rospy.ServiceProxy(name + service, kind, persistent=True) for service, kind in (
            ('/set_parameters', Reconfigure), ('/reload_tools', Trigger)))
        self.meshes = rospy.Publisher(name + '/organ_mesh', OrganMesh, queue_size=10)
        self.answers = Log(name + topic, kind)
        self.counter = rospy.Subscriber(name + topic, kind, self.note, queue_size=1000)

    def note(self, _):
        self.most = max(self.most, self.sent - self.answered)
        self.answered = self.sent

    def send_organ(self, organ):
        self.meshes.publish(mesh_message(organ, SHEET, rospy.Time.now(), frame=FRAME))

    def change(self, value):
        request = ReconfigureRequest()
        request.config.doubles = [DoubleParameter(self.parameter, value)]
        return self.set_parameters(request)

    def force(self):
        """[N] of haptic_proxy."""
        return self.answers.last().wrench.force.z

    def cpu_times(self):
        """[s] The processor time of the main thread, and of all threads."""
        def of(path):
            with open(path) as stat:
                return sum(int(field) for field in stat.read().rsplit(')', 1)[1].split()[11:13]) / os.sysconf('SC_CLK_TCK')
        return of('/proc/%d/task/%d/stat' % (self.process.pid, self.process.pid)), of('/proc/%d/stat' % self.process.pid)


class MasterTest(NodeStarter):
    master = None

    def send_poses(self):
        while self.goes_on:
            self.poses.publish(pose_stamped(FRAME, (0.013, 0.007, self.height), rospy.Time.now()))
            for node in self.nodes:
                node.sent += 1
            time.sleep(PERIOD)

    def setUp(self):
        self.tf, self.poses = TfSender(), rospy.Publisher('/pose', PoseStamped, queue_size=1000)
        self.tf.send_resting((FRAME, 'trocar', (0.02, -0.01, 0.3)))
        tools = {'tools': [tool('needle')], 'rate': 0.0, 'max_force_rate': RATE}
        self.nodes = self.proxy, _ = [Watched(name, self.start(name, tools, program), *rest) for name, program, *rest in (
            ('/proxy', 'haptic_proxy', '/needle/state', ProxyState, 'max_force'),
            ('/node', 'organ_collision_node', '/contacts', ContactArray, 'tf_timeout_sec'))]
        wait_until(lambda: all(is_heard(p, node.name) for node in self.nodes
                               for p in (node.meshes, self.tf.resting, self.poses)), 'connections')
        self.goes_on, self.height = True, DEPTH
        self.addCleanup(setattr, self, 'goes_on', False)
        threading.Thread(target=self.send_poses, daemon=True).start()
        for node in self.nodes:
            node.send_organ('first')
            node.change(2.5)
            self.assertTrue(node.reload().success)
            wait_until(lambda: node.answered > 100, lambda: 'answers; the last one is %s' % node.answers.last())
        wait_until(lambda: self.proxy.force() > 1.0, lambda: 'a force: %s' % self.proxy.answers.last())

    def trouble(self, act, organ, value):
        """Lets `act` do something to the master while an organ appears, a parameter is set and tools are reloaded.
        Returns what reload_tools answers."""
        said, threads = [], []
        act()
        for node in self.nodes:
            node.most = 0
            node.send_organ(organ)
            threads += [threading.Thread(target=node.change, args=(value,)),
                        threading.Thread(target=lambda node=node: said.append(node.reload()))]
        for thread in threads:
            thread.start()
        end = self.proxy.sent + HANG / PERIOD
        wait_until(lambda: self.proxy.sent > end, 'poses')
        for node in self.nodes:
            self.assertLess(max(node.most, node.sent - node.answered), MOST, node.name)
        self.master.master.send_signal(signal.SIGCONT)
        for thread in threads:
            thread.join(LIMIT)
        return said

    def test_a_pause_of_the_process_makes_no_jump(self):
        """The hand is in the air before it, and in tissue afterwards. All poses are answered at once then."""
        self.height = 0.02
        wait_until(lambda: self.proxy.force() == 0.0, 'no force')
        self.proxy.process.send_signal(signal.SIGSTOP)
        end = self.proxy.sent + 1.0 / PERIOD
        self.height = DEPTH
        wait_until(lambda: self.proxy.sent > end, 'poses')
        del self.proxy.answers.messages[:]
        self.proxy.process.send_signal(signal.SIGCONT)
        wait_until(lambda: self.proxy.answers.messages and self.proxy.force() > 1.0, 'a force')
        states = self.proxy.answers.select(lambda state: True)
        for earlier, later in zip(states, states[1:]):
            self.assertEqual(later.header.seq, earlier.header.seq + 1, 'a state was lost')
            self.assertLess(abs(later.wrench.force.z - earlier.wrench.force.z), RATE * 0.01)

    def test_nodes_answer_while_the_master_does_not(self):
        # 100 new tools: the thread of the ticks makes none of their pickers, which need most of the time.
        self.proxy.most = 0
        rospy.set_param('/proxy/tools', [tool('needle')] + [tool('new_%d' % i) for i in range(NEW_TOOLS)])
        before = self.proxy.cpu_times()
        self.assertTrue(self.proxy.reload().success)
        own, all_threads = (after - at for after, at in zip(self.proxy.cpu_times(), before))
        self.assertLess(own, 0.3 * all_threads)
        self.assertLess(self.proxy.most, MOST)
        rospy.set_param('/proxy/tools', [tool('needle')])
        self.assertTrue(self.proxy.reload().success)
        for answer in self.trouble(lambda: self.master.master.send_signal(signal.SIGSTOP), 'second', 2.0):
            self.assertTrue(answer.success, answer.message)
        wrenches = Log('/proxy/second/needle/wrench', WrenchStamped)
        wait_until(wrenches.last, 'the wrench of the second organ, whose topic came when the master went on')
        self.assertAlmostEqual(self.proxy.force(), 2.0, delta=0.1)
        for answer in self.trouble(self.master.kill, 'third', 1.5):
            self.assertFalse(answer.success)
            self.assertIn('the ROS master does not answer', answer.message)
        self.assertAlmostEqual(self.proxy.force(), 1.5, delta=0.1)
        for node in self.nodes:
            self.stop(node.process)
        self.assertEqual((self.proxy.answers.last().state, self.proxy.force()), (ProxyState.NO_ANSWER, 0.0))


if __name__ == '__main__':
    MasterTest.master = OwnMaster()
    os.environ['ROS_MASTER_URI'] = MasterTest.master.uri
    rospy.init_node('master_test')
    try:
        rostest.rosrun('organ_collision', 'master', MasterTest, sys.argv)
    finally:
        MasterTest.master.stop()
