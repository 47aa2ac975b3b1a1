#!/usr/bin/python3
"""How the node starts. Illegal parameters stop it with a message, misspelt ones are reported, and
it accepts a latched mesh that is older than itself."""

import copy
import os
import sys

from organ_collision.msg import ContactArray, OrganMesh
import roslib.packages
import rospy
import rostest

from support import oracle, scenes
from support.contact_case import ContactCase
from support.node_client import NodeClient, shaft, wait_until
from support.node_starter import NodeStarter

TOOL = {
    'name': 'grasper',
    'trocar_frame': 'grasper_trocar',
    'tip_frame': 'grasper_tip',
    'radius': 0.005,
}
SHEET = scenes.sheet(0.1, 4)

# Parameters that are set in addition to one good tool, and the words that the message must contain:
# the parameter, the value, what is legal.
ILLEGAL = [
    ({'tools': 'grasper'}, ['tools', 'grasper', 'list']),
    ({'tools': 3}, ['tools', '3', 'list']),
    ({'tools': ['grasper']}, ['tools', 'grasper']),
    ({'picker': 'raytrace'}, ['picker', 'raytrace', 'feedback', 'select']),
    ({'picker': 7}, ['picker', '7', 'feedback', 'select', 'cpu']),
    ({'gl': 'glx'}, ['gl', 'glx', 'auto', 'osmesa', 'egl']),
    ({'rate': -1.5}, ['rate', '-1.5', '0']),
    ({'rate': 'fast'}, ['rate', 'fast', 'number']),
    ({'rate': float('nan')}, ['rate', 'nan', '0']),
    ({'organ_motion': 'maybe'}, ['organ_motion', 'maybe', 'true', 'false']),
    ({'motion_sample_sec': 0.0}, ['motion_sample_sec', '0']),
    ({'motion_sample_sec': -0.125}, ['motion_sample_sec', '-0.125', '0']),
    ({'motion_samples_max': 0}, ['motion_samples_max', '0', '1']),
    ({'motion_samples_max': 2.5}, ['motion_samples_max', '2.5', '1']),
    ({'tf_timeout_sec': -0.5}, ['tf_timeout_sec', '-0.5', '0']),
    ({'tf_timeout_sec': float('inf')}, ['tf_timeout_sec', 'inf', '0']),
    ({'mesh_timeout_sec': -2}, ['mesh_timeout_sec', '-2', '0']),
    ({'max_faces': 0}, ['max_faces', '0', '1']),
    ({'max_faces': -7}, ['max_faces', '-7', '1']),
    ({'max_faces': 2147483647}, ['max_faces', '2147483647', '83333333']),
    ({'max_batch': 0}, ['max_batch', '0', '1']),
    ({'max_batch_bytes': 2147483647}, ['max_batch_bytes', '2147483647', '1000000000']),
    ({'publish_regions': 'often'}, ['publish_regions', 'often', 'true', 'false']),
]
ILLEGAL_IN_TOOL = [
    ({'radius': 0.0}, ['radius', '0']),
    ({'radius': -0.25}, ['radius', '-0.25', '0']),
    ({'radius': float('nan')}, ['radius', 'nan', '0']),
    ({'radius': float('inf')}, ['radius', 'inf', '0']),
    ({'radius': 'thin'}, ['radius', 'thin', 'number']),
    ({'radius': None}, ['radius', 'missing']),
    ({'name': None}, ['name', 'missing']),
    ({'name': ''}, ['name']),
    ({'trocar_frame': None}, ['trocar_frame', 'missing']),
    ({'tip_frame': ''}, ['tip_frame']),
    ({'tip_frame': 'grasper_trocar'}, ['tip_frame', 'grasper_trocar']),
    ({'tip_frame': '/grasper_trocar'}, ['tip_frame', 'grasper_trocar']),
]


class StartTest(ContactCase, NodeStarter):
    def setUp(self):
        self.name = '/' + self.id().split('.')[-1]

    def refused(self, cases):
        """`cases`: [(parameters, words)]. Starts a node for each at once. Each must stop and print
        its words."""
        started = [
            (self.start('%s_%d' % (self.name, i), parameters), words)
            for i, (parameters, words) in enumerate(cases)
        ]
        for process, words in started:
            self.assert_refused(process, words)

    def test_illegal_parameters(self):
        self.refused([(dict({'tools': [TOOL]}, **change), words) for change, words in ILLEGAL])

    def test_illegal_tools(self):
        cases = []
        for change, words in ILLEGAL_IN_TOOL:
            tool = {k: v for k, v in dict(TOOL, **change).items() if v is not None}
            cases.append(({'tools': [dict(TOOL, name='other'), tool]}, ['tools'] + words))
        cases.append(({'tools': [TOOL, copy.copy(TOOL)]}, ['tools', 'grasper', 'unique']))
        self.refused(cases)

    def test_drivers_of_opengl(self):
        """Mesa ends the process if it does not know the driver."""
        for platform in ('osmesa', 'egl'):
            parameters = {'tools': [TOOL], 'gl': platform}
            node = self.start(self.name + '_' + platform, parameters, through=('env', 'GALLIUM_DRIVER=nonsense'))
            self.assert_refused(node, ['GALLIUM_DRIVER', 'nonsense', 'llvmpipe', 'softpipe'])

    def test_tools_are_required(self):
        self.refused(
            [({}, ['tools', 'missing']), ({'tool': [TOOL]}, ['tools', "'tools'", 'tool '])]
        )

    def test_misspelt_names_and_implausible_sizes_are_reported(self):
        process = self.start(
            self.name,
            {
                'tools': [dict(TOOL, colour='red', radius=5.0)],
                'tf_timeout': 0.5,
                'publish_region': True,
            },
        )
        NodeClient(self.name)
        printed = self.stop(process)
        for word in ('tf_timeout ', 'tf_timeout_sec', 'publish_region ', 'colour'):
            self.assertIn(word, printed)
        self.assertIn("tool 'grasper' has a radius of 5 m", printed)
        self.assertIn('ready: 1 tool,', printed)

    def test_an_empty_list_of_tools_is_said(self):
        """The node starts, says what follows, and answers queries that give a motion."""
        process = self.start(self.name, {'tools': []})
        node = NodeClient(self.name)
        node.send_mesh('sheet', SHEET, rospy.Time(1))
        node.wait_for_shape('sheet', rospy.Time(1))
        wait_until(lambda: 'tools' in node.summaries, '/diagnostics')
        self.assertIn('~tools is empty', node.summaries['tools'])
        self.assertIn('~tools is empty', self.stop(process))

    def test_legal_parameters_at_their_limits(self):
        process = self.start(
            self.name,
            {
                'tools': [dict(TOOL, radius=1)],
                'picker': 'select',
                'rate': 0,
                'organ_motion': False,
                'motion_sample_sec': 1,
                'motion_samples_max': 1,
                'tf_timeout_sec': 0,
                'mesh_timeout_sec': 0,
                'max_faces': 32,
                'publish_regions': True,
            },
        )
        node = NodeClient(self.name)
        node.send_mesh('sheet', SHEET, rospy.Time(1))  # 32 faces
        node.wait_for_shape('sheet', rospy.Time(1))
        self.stop(process)

    def without(self, libraries):
        """The words of a command that runs a node where these GL libraries are missing: files that
        are no libraries come first."""
        return ['env', 'LD_LIBRARY_PATH=%s:%s' % (
            os.path.join(roslib.packages.get_pkg_dir('organ_collision'), 'test/data/missing_gl', libraries),
            os.environ.get('LD_LIBRARY_PATH', ''))]

    def assert_finds_contacts(self):
        node = NodeClient(self.name)
        node.send_mesh('sheet', SHEET, rospy.Time(1))
        node.wait_for_shape('sheet', rospy.Time(1))
        axis = ((0.01, 0.02, 0.3), (0.011, 0.017, 0.002))
        self.assert_contacts(
            node.query('sheet', shaft(*axis, 0.005)), oracle.static_contacts(SHEET, axis, 0.005)
        )

    def test_without_osmesa_there_is_egl(self):
        process = self.start(self.name, {'tools': [TOOL]}, through=self.without('osmesa'))
        self.assert_finds_contacts()
        self.assertIn('on EGL', self.stop(process))

    def test_without_any_opengl_it_stops_and_names_the_way_out(self):
        process = self.start(self.name, {'tools': [TOOL]}, through=self.without('osmesa_egl'))
        self.assert_refused(process, ['libOSMesa.so.8', 'libEGL.so.1', 'picker: cpu'])

    def test_without_any_opengl_the_cpu_picks(self):
        process = self.start(
            self.name, {'tools': [TOOL], 'picker': 'cpu'}, through=self.without('osmesa_egl')
        )
        self.assert_finds_contacts()
        self.assertIn('GL none', self.stop(process))

    def test_a_latched_mesh_waits_for_the_node(self):
        """The organ is sent once, before the node starts. The node starts, is killed, and starts
        again."""
        latched = rospy.Publisher(self.name + '/organ_mesh', OrganMesh, queue_size=1, latch=True)
        message = OrganMesh(
            organ='sheet', topology=3, vertices=SHEET.flat_vertices(), triangles=SHEET.flat_faces()
        )
        message.header.frame_id = 'liver_frame'
        message.header.stamp = rospy.Time(1)
        latched.publish(message)
        axis = ((0.01, 0.02, 0.3), (0.011, 0.017, 0.002))
        for _ in range(2):
            process = self.start(self.name, {'tools': [TOOL]})
            node = NodeClient(self.name)
            node.wait_for_shape('sheet', rospy.Time(1), topology=3)
            self.assert_contacts(
                node.query('sheet', shaft(*axis, 0.005)), oracle.static_contacts(SHEET, axis, 0.005)
            )
            self.stop(process)

    def test_a_node_without_any_mesh_says_so(self):
        process = self.start(self.name, {'tools': [TOOL]})
        node = NodeClient(self.name)
        motion = shaft((0.0, 0.0, 0.1), (0.0, 0.0, 0.0), 0.005)
        for result in [node.query('liver', motion), node.query('liver', tool='grasper')]:
            self.assertIn(result.status, (ContactArray.NO_MESH, ContactArray.UNKNOWN_ORGAN))
            self.assertEqual(result.contacts, [])
            self.assertIn('liver', result.message)
        self.stop(process)


if __name__ == '__main__':
    rospy.init_node('start_test')
    rostest.rosrun('organ_collision', 'start', StartTest, sys.argv)
