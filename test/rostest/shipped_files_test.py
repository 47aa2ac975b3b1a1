#!/usr/bin/python3
"""Every launch file starts all its nodes and stops cleanly, every configuration file loads, TF
knows the robots of the URDF files, and what RViz is to show exists."""

import os
import re
import subprocess
import sys
import tempfile
from xml.etree import ElementTree

from geometry_msgs.msg import WrenchStamped
from organ_collision.msg import Contact, ContactArray, OrganMesh, OrganVertices, ProxyState
import roslib.packages
import rospy
import rostest
from sensor_msgs.msg import JointState
from shape_msgs.msg import Mesh
from tf2_msgs.msg import TFMessage
import yaml

from support import oracle, scenes
from support.contact_case import ContactCase
from support.foreign_meshes import shape_mesh
from support.launched import Launched, nodes_online
from support.mesh_adapter_case import MessageLog
from support.node_client import NodeClient, shaft, wait_until
from support.node_starter import NodeStarter

PACKAGE = roslib.packages.get_pkg_dir('organ_collision')
HANDS = ['config/demo_hands.yaml', 'examples/haptics.yaml']  # The tools of haptic_proxy.
SHEET = scenes.sheet(0.1, 4)
AXIS = ((0.01, 0.02, 0.3), (0.011, 0.017, 0.002))
# What these nodes of Python send once all their topics are registered at the ROS master. None may be
# stopped before: rospy's signal handler calls the ROS master, and waits forever if it interrupted
# such a call.
FIRST_MESSAGES = {
    '/simulator': ('/organ_collision/organ_vertices', OrganVertices),
    '/sheet': ('/sheet_collision/organ_vertices', OrganVertices),
    '/dvrk_robot': ('/PSM2/jaw/measured_js', JointState),
    '/dvrk_organ': ('/organ_collision/organ_vertices', OrganVertices),
    '/MTML/force': ('/MTML/body/servo_cf', WrenchStamped),
    '/MTMR/force': ('/MTMR/body/servo_cf', WrenchStamped),
}


def files(folder, ending):
    return sorted(
        os.path.join(PACKAGE, folder, name)
        for name in os.listdir(os.path.join(PACKAGE, folder))
        if name.endswith(ending)
    )


def named_in(path, folder, ending):
    """The files of a folder of the package that a launch file mentions."""
    with open(path) as text:
        names = re.findall(r'find organ_collision\)/%s/(\w+\%s)"' % (folder, ending), text.read())
    return [os.path.join(PACKAGE, folder, name) for name in names]


class FrameLog:
    """The names of all frames that TF knows."""

    def __init__(self):
        self.names = set()
        self.subscribers = [
            rospy.Subscriber(topic, TFMessage, self._add) for topic in ('/tf', '/tf_static')
        ]

    def _add(self, message):
        for transform in message.transforms:
            self.names |= {transform.header.frame_id, transform.child_frame_id}

    def close(self):
        for subscriber in self.subscribers:
            subscriber.unregister()


class ShippedFilesTest(ContactCase, NodeStarter):
    def check_collision_node(self, name, process=None):
        """Checks that the collision node answers about an organ that only it has."""
        node = NodeClient(name, process=process)
        node.send_mesh('sheet', SHEET, rospy.Time(1))
        node.wait_for_shape('sheet', rospy.Time(1))
        self.assert_contacts(
            node.query('sheet', shaft(*AXIS, 0.005)), oracle.static_contacts(SHEET, AXIS, 0.005)
        )
        node.close()

    def check_mesh_adapter(self, organs, collision_node='/organ_collision'):
        """Checks that a mesh on each organ's topic reaches the collision node."""
        meshes = MessageLog(collision_node + '/organ_mesh', OrganMesh)
        for organ in organs:
            publisher = rospy.Publisher(organ['topic'], Mesh, queue_size=1)
            wait_until(lambda: publisher.get_num_connections() > 0, organ['topic'])
            publisher.publish(shape_mesh(SHEET))
            wait_until(lambda: meshes.of(organ['name']), 'a mesh of ' + organ['name'])
            publisher.unregister()
        meshes.subscriber.unregister()

    def test_every_launch_file(self):
        launch_files = files('launch', '.launch') + files('examples', '.launch')
        self.assertTrue(
            {
                'organ_collision.launch',
                'nodelet.launch',
                'demo.launch',
                'contact_adapter.launch',
                'haptic_proxy.launch',
                'haptics.launch',
                'organ_mesh_adapter.launch',
                'view.launch',
            }
            <= {os.path.basename(path) for path in launch_files},
            launch_files,
        )
        scenes_shown, robots = 0, set()
        for path in launch_files:
            urdf_files = named_in(path, 'urdf', '.urdf')
            robots |= set(urdf_files)
            with Launched(path) as launched:
                launched.wait_for_nodes()
                self.assertGreater(len(launched.nodes), 0, path)
                if '/organ_collision' in launched.nodes:
                    manager = [name for name in launched.nodes if name.endswith('_manager')]
                    self.check_collision_node('/organ_collision', *manager)
                if os.path.basename(path) == 'contact_adapter.launch':
                    self.check_contact_adapter()
                if '/fem_tissue' in launched.nodes:
                    # It runs the collision node, which has no name of its own in this list.
                    rospy.wait_for_message('/fem_tissue/impulse', WrenchStamped, timeout=30.0)
                for node in set(FIRST_MESSAGES) & set(launched.nodes):
                    rospy.wait_for_message(*FIRST_MESSAGES[node], timeout=30.0)
                if '/organ_mesh_adapter' in launched.nodes:
                    self.check_mesh_adapter(rospy.get_param('/organ_mesh_adapter/organs'))
                for urdf_file in urdf_files:
                    self.check_robot(urdf_file)
                if '/liver_simulator' in launched.nodes:
                    self.check_scene(proxies='/haptic_proxy' in launched.nodes)
                    scenes_shown += 1
            wait_until(lambda: not set(launched.nodes) & nodes_online(), 'the end of ' + path)
            self.assertNotIn('has died', launched.printed, path)
            self.assertNotIn('escalating', launched.printed, path)
        self.assertEqual(scenes_shown, 2)
        self.assertEqual(robots, set(files('urdf', '.urdf')))
        # test/examples/grasper_files_test.py expands them.
        self.assertLessEqual({path[: -len('.xacro')] for path in files('urdf', '.xacro')}, robots)

    def check_contact_adapter(self):
        """Checks that a contact of 1 mm depth gives 0.3 N, with the default stiffness."""
        contacts = rospy.Publisher('/organ_collision/contacts', ContactArray, queue_size=10)
        wrenches = []
        subscriber = rospy.Subscriber(
            '/contact_adapter/sheet/probe/wrench', WrenchStamped, wrenches.append
        )
        message = ContactArray(organ='sheet', tool='probe', contacts=[Contact(depth=0.001)])
        message.header.frame_id, message.contacts[0].normal.z = 'world', -1.0

        def wrench_comes():
            """Sends contacts until a wrench arrives: its topic appears only after the first
            ones."""
            contacts.publish(message)
            return wrenches

        force = wait_until(wrench_comes, 'a wrench')[0].wrench.force
        self.assert_near((force.x, force.y, force.z), (0.0, 0.0, 0.3), 1e-9, 'force')
        subscriber.unregister()
        contacts.unregister()

    def check_robot(self, urdf_file):
        """Checks that TF knows all links of the robot, and that its mesh files exist. The links of
        psm.urdf are named after the arm."""
        with open(urdf_file) as text:
            robot = ElementTree.fromstring(text.read().replace('PSM_', 'PSM1_'))
        frames = FrameLog()
        links = {link.get('name') for link in robot.iter('link')}
        wait_until(
            lambda: links <= frames.names, lambda: 'links %s of TF' % (links - frames.names)
        )
        frames.close()
        for mesh in robot.iter('mesh'):
            path = mesh.get('filename').replace('package://organ_collision', PACKAGE)
            self.assertTrue(os.path.exists(path), path)

    def check_scene(self, proxies):
        """Checks that the organ and the tools move and touch, and that the RViz configuration for
        this scene shows only existing topics and frames."""
        node = NodeClient()
        touched = wait_until(
            lambda: [m for m in list(node.contacts.messages) if m.contacts],
            'contacts in the scene',
            30.0,
        )
        self.assertTrue(all(m.status == ContactArray.OK for m in touched))
        manager = self.fitted_configuration()['Visualization Manager']
        shown = self.shown_topics(manager['Displays'])
        self.assertEqual(shown, {'/organ_collision/markers', '/haptic_proxy/markers'})
        topics = {topic for topic, _ in rospy.get_published_topics()}
        without_proxy = set() if proxies else {'/haptic_proxy/markers'}
        self.assertEqual(shown - topics, without_proxy)
        frames, fixed = FrameLog(), manager['Global Options']['Fixed Frame']
        wait_until(lambda: fixed in frames.names, 'the fixed frame ' + fixed)
        frames.close()
        self.assertEqual(fixed, touched[0].header.frame_id)
        view = manager['Views']['Current']
        # The liver is about 0.2 m long, near the origin of its frame.
        self.assertTrue(0.2 < view['Distance'] < 0.8, view)
        self.assertTrue(all(abs(view['Focal Point'][axis]) < 0.1 for axis in 'XYZ'), view)
        node.close()

    def fitted_configuration(self):
        """The RViz configuration, as view.py fits it to the organs that are there."""
        path = os.path.join(tempfile.mkdtemp(), 'fitted.rviz')
        program = roslib.packages.find_node('organ_collision', 'view.py')[0]
        subprocess.check_call([program, '--save', path], timeout=60)
        with open(path) as text:
            return yaml.safe_load(text)

    def test_the_rviz_file_names_displays_that_rviz_has(self):
        with open(os.path.join(PACKAGE, 'config', 'organ_collision.rviz')) as text:
            configuration = yaml.safe_load(text)
        self.assertEqual(len(files('config', '.rviz')), 1)
        manager = configuration['Visualization Manager']
        named = configuration['Panels'] + manager['Displays'] + manager['Tools']
        named.append(manager['Views']['Current'])
        self.assertGreaterEqual(
            {part['Class'] for part in named}, {'rviz/MarkerArray', 'rviz/Displays', 'rviz/Orbit'}
        )
        for part in named:
            self.assertRegex(part['Class'], r'^rviz/\w+$')
        try:
            plugins = os.path.join(roslib.packages.get_pkg_dir('rviz'), 'plugin_description.xml')
        except roslib.packages.InvalidROSPkgException:
            return  # RViz is not installed.
        with open(plugins) as text:
            known = set(re.findall(r'class name="(rviz/\w+)"', text.read())) | {'rviz/Displays'}
        self.assertEqual({part['Class'] for part in named} - known, set())

    def shown_topics(self, displays):
        """The topics of all displays, including those in groups."""
        found = set()
        for display in displays:
            found |= self.shown_topics(display.get('Displays', []))
            found |= {
                value
                for key, value in display.items()
                if key.endswith('Topic') and isinstance(value, str) and value
            }
        return found

    def test_every_configuration_file(self):
        """Each yaml file parses. A file with tools starts a collision node that answers, or a
        haptic_proxy that tells the state of each of them, and a file with organs a mesh adapter
        that accepts their meshes. None reports an unknown name."""
        yaml_files = files('config', '.yaml') + files('examples', '.yaml')
        started = set()
        for path in yaml_files:
            with open(path) as text:
                parameters = yaml.safe_load(text)
            self.assertIsInstance(parameters, dict, path)
            name = '/from_%d_%s' % (len(started), os.path.basename(path).replace('.', '_'))
            if os.path.relpath(path, PACKAGE) in HANDS:
                process = self.start(name, parameters, 'haptic_proxy')
                self.check_hands(name, parameters['tools'])
            elif 'tools' in parameters:
                process = self.start(name, parameters)
                self.check_collision_node(name)
            elif 'organs' in parameters:
                parameters['collision_node'] = name + '_collision'
                process = self.start(name, parameters, 'organ_mesh_adapter')
                self.check_mesh_adapter(parameters['organs'], parameters['collision_node'])
            else:
                continue
            self.assertNotIn('is no parameter', self.stop(process), path)
            started.add(os.path.relpath(path, PACKAGE))
        self.assertTrue({'config/tools.yaml', 'config/organs.yaml', *HANDS} <= started, started)

    def check_hands(self, name, tools):
        """Checks that haptic_proxy knows the tools, and that they have no organ."""
        for tool in tools:
            state = rospy.wait_for_message(
                '%s/%s/state' % (name, tool['name']), ProxyState, timeout=30.0
            )
            self.assertEqual(state.state, ProxyState.NO_ANSWER)
            self.assertIn('organ', state.message)


if __name__ == '__main__':
    rospy.init_node('shipped_files_test')
    rostest.rosrun('organ_collision', 'shipped_files', ShippedFilesTest, sys.argv)
