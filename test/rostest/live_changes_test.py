#!/usr/bin/python3
"""Tools and parameters change while the node makes steps. What did not change goes on as before."""

import sys
import tempfile
import threading

from dynamic_reconfigure.client import Client
from geometry_msgs.msg import PoseStamped
from organ_collision.msg import ContactArray
import rospy
import rostest
from std_srvs.srv import Trigger

from support.contact_case import KeepsContract
from support.node_client import LIMIT, is_heard, pose_stamped, wait_until
from support.tool_case import ToolCase
from support.tool_over_sheet import SHEET, at_height

STATIC, SWEPT = ContactArray.STATIC, ContactArray.SWEPT
NODE = '/live'
AT_START = {'rate': 0.0, 'publish_regions': False, 'publish_placement': True, 'tf_timeout_sec': 5.0,
            'mesh_timeout_sec': 0.0}


def shaft(name, radius=0.005, **more):
    return dict(name=name, trocar_frame=name + '_trocar', tip_frame=name + '_tip', radius=radius, **more)


class LiveChangesTest(KeepsContract, ToolCase):
    node_name = NODE
    link_frames = {'pincers': ('pincers/upper', 'pincers/lower')}

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.reload_service = rospy.ServiceProxy(NODE + '/reload_tools', Trigger)
        cls.client = Client(NODE, timeout=LIMIT)

    def reload(self, *tools):
        rospy.set_param(NODE + '/tools', list(tools))
        return self.reload_service()

    def reloaded(self, *tools):
        """Reloads legal tools, and returns what the answer says about them."""
        answer = self.reload(*tools)
        self.assertTrue(answer.success, answer.message)
        return answer.message

    def answers(self, tool):
        return self.node.contacts.of(self.organ, tool)

    def assert_no_gap(self, tool):
        """Each step of the tool begins where the one before it ended."""
        answers = self.answers(tool)
        self.assertEqual([a.mode for a in answers], [STATIC] + [SWEPT] * (len(answers) - 1))
        for earlier, later in zip(answers, answers[1:]):
            self.assert_ok(later)
            self.assertEqual(later.step_start, earlier.header.stamp)

    def test_unchanged_tools_keep_their_history(self):
        """The tools are reloaded several times while steps are made. The kept tool has another place in the list each
        time. At the end, there is none."""
        self.reloaded(shaft('kept'), shaft('hook'))
        axes = {'kept': at_height(0.05), 'hook': at_height(0.0055)}
        self.step(SHEET, axes)
        self.assertEqual(self.step(SHEET, axes, vertices=True)['hook'].contacts, [])
        messages, thicker = [], shaft('hook', radius=0.006)
        lists = [[thicker, shaft('kept')], [shaft('saw'), thicker, shaft('kept')], [shaft('kept')]]
        thread = threading.Thread(target=lambda: messages.extend(self.reload(*tools).message for tools in lists))
        thread.start()
        steps = 0
        while thread.is_alive() or steps == 0:
            self.step(SHEET, {'kept': at_height(0.05 if steps % 2 else -0.05)}, vertices=True)
            steps += 1
        thread.join()
        self.assertEqual(messages, ["unchanged: 'kept'; changed: 'hook'", "unchanged: 'hook', 'kept'; new: 'saw'",
                                    "unchanged: 'kept'; removed: 'saw', 'hook'"])
        self.assert_no_gap('kept')
        self.assertGreater(max(len(a.contacts) for a in self.answers('kept')), 0)
        self.assertEqual(self.node.query(self.organ, tool='saw').status, ContactArray.UNKNOWN_TOOL)
        self.assertEqual(self.reloaded(), "removed: 'kept'")
        self.node.diagnostics.wait_for_summary('tools', '~tools is empty')

    def test_steps_go_on_while_a_robot_is_read_that_takes_long(self):
        """The parser of URDF needs seconds for such a depth, and then more than its stack."""
        self.reloaded(shaft('kept'))
        self.step(SHEET, {'kept': at_height(0.05)})
        answers, steps = [], 0
        with tempfile.NamedTemporaryFile('w', suffix='.urdf') as urdf:
            urdf.write('<robot name="slow"><link name="tip"/>' + 300000 * '<a>' + 300000 * '</a>' + '</robot>')
            urdf.flush()
            slow = dict(name='slow', urdf=urdf.name, links=['tip'])
            thread = threading.Thread(target=lambda: answers.append(self.reload(shaft('kept'), slow)))
            thread.start()
            while thread.is_alive():
                self.step(SHEET, {'kept': at_height(0.05 if steps % 2 else -0.05)}, vertices=True)
                steps += 1
                rospy.sleep(0.01)  # Otherwise the stamps of the steps run ahead of the clock.
            thread.join()
        self.assertFalse(answers[0].success)
        self.assertRegex(answers[0].message, 'robot_reader (was ended by signal|took more than 30 s)')
        self.assertGreater(steps, 2)
        self.assert_no_gap('kept')
        self.assertEqual(self.reloaded(), "removed: 'kept'")

    def test_no_pose_is_lost(self):
        """The tip's poses come on a topic while the tool changes its place in the list."""
        probe = {'name': 'probe', 'trocar_frame': 'probe_trocar', 'radius': 0.005, 'tip_pose_topic': '/probe_pose'}
        self.reloaded(probe)
        self.node.bring(self.organ, SHEET)
        self.tf.send_resting((self.node.frame, 'probe_trocar', (0.013, 0.007, 0.4)))
        poses = rospy.Publisher('/probe_pose', PoseStamped, queue_size=10)
        wait_until(lambda: is_heard(poses, NODE), 'the node to listen to /probe_pose')

        def send(height):
            pose = pose_stamped(self.node.frame, (0.013, 0.007, height), rospy.Time.now())
            poses.publish(pose)
            return self.node.contacts.wait_for(self.organ, 'probe', stamp=pose.header.stamp, status=ContactArray.OK)

        self.assertEqual(send(0.05).mode, STATIC)
        for i, height in enumerate((-0.05, 0.05, -0.05)):
            self.reloaded(*[shaft('other_%d_%d' % (i, j)) for j in range(i + 1)], probe)
            self.assertEqual(poses.get_num_connections(), 1)
            answer = send(height)
            self.assertEqual(answer.mode, SWEPT)
            self.assertGreater(len(answer.contacts), 0)

    def test_parameters_change(self):
        """A rate, regions, the timeout of meshes, and placement."""
        self.reloaded(shaft('hook'))
        axis = {'hook': at_height(-0.003)}
        first = self.step(SHEET, axis)['hook']
        self.assertEqual((first.regions, len(first.placement.crossings)), ([], 1))
        try:
            now = self.client.update_configuration({'rate': 50, 'publish_regions': True})
            self.assertEqual((now['rate'], now['publish_regions'], rospy.get_param(NODE + '/rate')), (50.0, True, 50.0))
            wait_until(lambda: len(self.answers('hook')) > 5 and self.answers('hook')[-1].regions, 'ticks with regions')
            self.client.update_configuration({'mesh_timeout_sec': 1e-3})
            self.node.contacts.wait_for(self.organ, 'hook', status=ContactArray.STALE_MESH)
            self.client.update_configuration({'mesh_timeout_sec': 0.0, 'rate': 0.0, 'publish_placement': False})
            self.assertEqual(self.step(SHEET, axis, vertices=True)['hook'].placement.crossings, [])
        finally:
            self.client.update_configuration(AT_START)
        self.assertEqual(len(self.step(SHEET, axis, vertices=True)['hook'].placement.crossings), 1)


if __name__ == '__main__':
    rospy.init_node('live_changes_test')
    rostest.rosrun('organ_collision', 'live_changes', LiveChangesTest, sys.argv)
