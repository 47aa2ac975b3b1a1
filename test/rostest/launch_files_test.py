#!/usr/bin/python3
"""Every file in launch/ starts all its nodes and stops cleanly, every configuration file loads, and what RViz is to
show exists. Other tests run the launch files of examples/."""

import os
import re
import subprocess
import sys
import tempfile

from geometry_msgs.msg import PoseStamped
from organ_collision.msg import ContactArray, OrganMesh, ProxyState, VertexForces
import roslaunch
import rospy
import rostest
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray
import yaml

from support.launch_case import FrameLog, LaunchCase, PACKAGE, files
from support.node_client import LIMIT, Log, NodeClient, pose_stamped, wait_until
from support.processes import NodeStarter, nodes_online, program

# The tools of haptic_proxy.
HANDS = {'config/demo_hands.yaml', 'examples/haptics.yaml', 'examples/lockstep.yaml', 'examples/ambf/hand.yaml',
         'examples/sofa/hand.yaml'}
# AMBF and trial_report.py read them.
OF_OTHERS = {'examples/ambf/scene.yaml', 'examples/ambf/environment.yaml', 'examples/limits.yaml'}


def shown_topics(displays):
    """The topics of all displays, including those in groups."""
    found = set()
    for display in displays:
        found |= shown_topics(display.get('Displays', []))
        found |= {value for key, value in display.items() if key.endswith('Topic') and isinstance(value, str) and value}
    return found


class LaunchFilesTest(LaunchCase, NodeStarter):
    def test_every_launch_file(self):
        self.markers = rospy.Publisher('/organ_collision/markers', MarkerArray, queue_size=1)
        checks = {'organ_collision': lambda: self.check_collision_node('/organ_collision'),
                  'nodelet': lambda: self.check_collision_node('/organ_collision', '/organ_collision_manager'),
                  'demo': self.check_demo, 'view': self.check_view,
                  'pose_adapter': lambda: self.check_pose_adapter(rospy.get_param('/pose_adapter/sources')),
                  'haptic_proxy': lambda: self.check_hands('/haptic_proxy', rospy.get_param('/haptic_proxy/tools')),
                  'tool_guard': self.check_guard,
                  'organ_mesh_adapter': lambda: self.check_mesh_adapter(rospy.get_param('/organ_mesh_adapter/organs'))}
        self.assertEqual({'launch/%s.launch' % name for name in checks}, files('launch', '.launch'))
        for name, check in checks.items():
            with self.launched('launch/%s.launch' % name) as launched:
                check()
            if name == 'demo':
                self.check_report(launched.printed)

    def check_view(self):
        """The view listens to a publisher that was there before it, so its call that registers the subscriber has
        ended. It publishes nothing, so it gets no row in FIRST_MESSAGES."""
        wait_until(lambda: self.markers.get_num_connections() > 0, 'the subscriber of the markers')

    def check_guard(self):
        """Without a collision node, no tool is known, and nothing is said."""
        wait_until(lambda: '/tool_guard' in nodes_online(), 'the guard')

    def check_pose_adapter(self, sources):
        """A pose on each topic reaches TF, or the topic of poses."""
        for source in sources:
            child = source.get('child_frame')
            out = Log('/tf' if child else source['pose_topic'], TFMessage if child else PoseStamped)
            publisher = rospy.Publisher(source['topic'], PoseStamped, queue_size=1)
            pose = pose_stamped(source.get('frame', 'world'), (0, 0, 1), rospy.Time.now())
            came = lambda m: child in (t.child_frame_id for t in m.transforms) if child else m.pose.position.z > 0
            wait_until(lambda: publisher.publish(pose) or rospy.sleep(0.05) or out.last(came), source['topic'])
            publisher.unregister()

    def check_hands(self, name, tools):
        """haptic_proxy knows the tools, and they have no organ."""
        for tool in tools:
            state = rospy.wait_for_message('%s/%s/state' % (name, tool['name']), ProxyState, timeout=LIMIT)
            self.assertEqual(state.state, ProxyState.NO_ANSWER)
            self.assertIn('organ', state.message)

    def check_demo(self):
        """The organ and the tools move and touch. The RViz configuration, as view.py fits it to the organs that are
        there, shows only existing topics and frames."""
        node, forces = NodeClient(), Log('/haptic_proxy/liver/palpator/vertex_forces', VertexForces)
        touched = wait_until(lambda: node.contacts.select(lambda answer: answer.contacts), 'contacts in the scene')[0]
        self.assertEqual(touched.status, ContactArray.OK)
        path = os.path.join(tempfile.mkdtemp(), 'fitted.rviz')
        subprocess.check_call([program('view.py'), '--save', path], timeout=60)
        with open(path) as text:
            manager = yaml.safe_load(text)['Visualization Manager']
        shown = shown_topics(manager['Displays'])
        self.assertEqual(shown, {'/organ_collision/markers', '/haptic_proxy/markers'})
        self.assertEqual(shown - {topic for topic, _ in rospy.get_published_topics()}, set())
        fixed, view = manager['Global Options']['Fixed Frame'], manager['Views']['Current']
        FrameLog().wait_for({fixed})
        self.assertEqual(fixed, touched.header.frame_id)
        # The liver is about 0.2 m long, near the origin of its frame.
        self.assertTrue(0.2 < view['Distance'] < 0.8, view)
        self.assertTrue(all(abs(view['Focal Point'][axis]) < 0.1 for axis in 'XYZ'), view)
        # After the cut, contacts and forces are about the new triangles.
        cut = wait_until(lambda: node.contacts.select(lambda answer: answer.topology > 0 and answer.contacts),
                         'contacts after the cut')[0]
        mesh = rospy.wait_for_message('/organ_collision/organ_mesh', OrganMesh, timeout=LIMIT)
        self.assertEqual(mesh.topology, cut.topology)
        self.assertLess(max(contact.face for contact in cut.contacts), len(mesh.triangles) // 3)
        wait_until(lambda: forces.select(lambda its: its.topology > 0 and its.vertices), 'forces after the cut')
        node.close()

    def check_report(self, printed):
        """What demo_report.py prints while the demo runs, and at its end."""
        self.assertRegex(printed, r' [1-9]\d* shapes/s +[1-9]\d* answers/s  stabber \d+ faces .*palpator '
                                  r'(FREE|TOUCHING), up to \d+\.\d N, [1-9]\d* poses/s\n')
        self.assertRegex(printed, r'\n        a cut: \d+ faces\n')
        summary = re.search(r'\nIn \d+ s: (\d+) contacts\. A static test .* missed (\d+) of them', printed)
        self.assertTrue(0 < int(summary[2]) <= int(summary[1]), summary[0])
        self.assertRegex(printed, r"\nThe palpator's hand: [1-9]\d* poses, ")

    def test_every_launch_file_clears_the_parameters_of_its_nodes(self):
        paths = set().union(*(files(folder, '.launch') for folder in
                              ('launch', 'examples', 'examples/ambf', 'examples/sofa')))
        for path in sorted(paths - {'launch/view.launch'}):
            for clears in (True, False):
                words = [] if clears else ['clear_params:=false']
                loaded = roslaunch.config.load_config_default([(os.path.join(PACKAGE, path), words)], None)
                ours = {node.namespace + node.name for node in loaded.nodes
                        if node.package == 'organ_collision' or 'load organ_collision/' in node.args}
                cleared = {name.rstrip('/') for name in loaded.clear_params}
                self.assertTrue(ours <= cleared if clears else not cleared, (path, ours - cleared))

    def test_every_configuration_file(self):
        """A file with tools starts a collision node that answers, or a haptic_proxy that tells the state of each of
        them, and a file with organs a mesh adapter that accepts their meshes. None reports an unknown name."""
        started = set()
        folders = 'config', 'examples', 'examples/ambf', 'examples/sofa'
        for path in sorted(set().union(*(files(folder, '.yaml') for folder in folders)) - OF_OTHERS):
            with open(os.path.join(PACKAGE, path)) as text:
                parameters = yaml.safe_load(text)
            name = '/from_' + re.sub(r'\W', '_', path)
            if path in HANDS:
                process = self.start(name, parameters, 'haptic_proxy')
                self.check_hands(name, parameters['tools'])
            elif 'tools' in parameters:
                process = self.start(name, parameters)
                self.check_collision_node(name)
            elif 'latency' in parameters:
                process = self.start(name, parameters, 'tool_guard')
                wait_until(lambda: name in nodes_online(), name)
            elif 'sources' in parameters:
                process = self.start(name, parameters, 'pose_adapter.py')
                self.check_pose_adapter(parameters['sources'])
            else:
                process = self.start(name, dict(parameters, collision_node=name + '_node'), 'organ_mesh_adapter')
                self.check_mesh_adapter(parameters['organs'], name + '_node')
            self.assertNotIn('is no parameter', self.stop(process), path)
            started.add(path)
        self.assertLessEqual({'config/tools.yaml', 'config/organs.yaml', 'config/poses.yaml', *HANDS}, started)


if __name__ == '__main__':
    rospy.init_node('launch_files_test')
    rostest.rosrun('organ_collision', 'launch_files', LaunchFilesTest, sys.argv)
