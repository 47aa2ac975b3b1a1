#!/usr/bin/python3
"""The markers show organs, tools and contacts, and of haptic_proxy hands, proxies and states, also to a viewer that
comes late. They leave nothing of what is gone. The view of RViz fits the organs that they show."""

import importlib.util
import os
import sys
import tempfile
import threading
import time
import unittest
import unittest.mock

from geometry_msgs.msg import Point
import numpy
import rospy
import rostest
from std_msgs.msg import Bool
from visualization_msgs.msg import Marker, MarkerArray
import yaml

from support.launch_case import PACKAGE
from support.node_client import NodeClient, TfSender, wait_until
from support.processes import NodeStarter
from support.tool_over_sheet import SHEET

TOOL = {'name': 'probe', 'trocar_frame': 'probe_trocar', 'tip_frame': 'probe_tip', 'radius': 0.005, 'margin': 0.02,
        'max_near': 50}
TROCAR = (0.01, 0.02, 0.3)
TOUCHING, ABOVE = -0.302, -0.2  # [m] z coordinate of the tip, relative to the trocar
FULL = {'surface/sheet', 'tools', 'touched', 'normals', 'names', 'near', 'clearance', 'status'}


class Viewer:
    """Keeps the markers of a topic as RViz does."""

    def __init__(self, topic):
        self.lock = threading.Lock()
        self.markers = {}
        self.subscriber = rospy.Subscriber(topic, MarkerArray, self._show, queue_size=4000)

    def _show(self, array):
        with self.lock:
            for marker in array.markers:
                assert marker.header.frame_id and marker.header.stamp.is_zero()
                if marker.action == Marker.DELETEALL:
                    self.markers.clear()
                elif marker.action == Marker.DELETE:
                    self.markers.pop((marker.ns, marker.id), None)
                else:
                    assert marker.lifetime > rospy.Duration(0)
                    self.markers[marker.ns, marker.id] = marker

    def namespaces(self):
        with self.lock:
            return {name for name, _ in self.markers}

    def of(self, namespace):
        with self.lock:
            return [m for (name, _), m in sorted(self.markers.items()) if name == namespace]

    def text(self, namespace):
        return ''.join(marker.text for marker in self.of(namespace))

    def wait_for(self, namespaces):
        wait_until(lambda: self.namespaces() == namespaces,
                   lambda: 'the markers %s; there are %s' % (namespaces, self.namespaces()))


class MarkersTest(NodeStarter):
    def test_what_is_there_is_shown_and_what_is_gone_is_not(self):
        process = self.start('/shown', {'tools': [TOOL]})
        client, transforms, viewer = NodeClient('/shown'), TfSender(), Viewer('/shown/markers')
        self.addCleanup(client.close)
        transforms.wait_for(client)
        transforms.send_resting((client.frame, 'probe_trocar', TROCAR))

        def step(height):
            """Sends the sheet and a pose of the tip, and waits for the answer."""
            now = rospy.Time.now()
            transforms.send(('probe_trocar', 'probe_tip', (0.0, 0.0, height), now))
            client.send_mesh('sheet', SHEET, now)
            return client.contacts.wait_for('sheet', 'probe', stamp=now)

        self.assertTrue(step(TOUCHING).contacts)
        for shown in (viewer, Viewer('/shown/markers')):
            shown.wait_for(FULL)
        surface = viewer.of('surface/sheet')[0]
        self.assertEqual(surface.header.frame_id, client.frame)
        corners = [(p.x, p.y, p.z) for p in surface.points]
        self.assertEqual(corners, [SHEET.vertices[i] for i in SHEET.flat_faces()])
        self.assertEqual(viewer.text('names'), 'probe')
        self.assertIn('probe: ', viewer.text('status'))
        self.assertEqual([m.type for m in viewer.of('tools')], [Marker.CYLINDER, Marker.SPHERE, Marker.SPHERE])
        step(ABOVE)  # This step begins with the contacts.
        self.assertFalse(step(ABOVE).contacts)
        viewer.wait_for({'surface/sheet', 'tools', 'status'})
        client.reset()  # The tool has no pose any more.
        viewer.wait_for({'surface/sheet', 'status'})
        client.remove('sheet')
        viewer.wait_for(set())
        self.stop(process)


class ViewTest(unittest.TestCase):
    """In place of RViz, a program waits until a file is gone, and this process has RViz's services."""

    def setUp(self):
        spec = importlib.util.spec_from_file_location('view', os.path.join(PACKAGE, 'scripts', 'view.py'))
        self.view = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(self.view)
        folder = tempfile.mkdtemp()
        self.path, self.rviz = os.path.join(folder, 'fitted.rviz'), os.path.join(folder, 'rviz')
        self.write_program('rviz', '#!/bin/sh\nwhile [ -e "$0" ]; do sleep 0.1; done\nexit 7\n')
        self.shown, self.loaded = None, 0  # the configuration in RViz, and how many came while it ran
        for name, answer in (('save_config', self.save), ('load_config_discarding_changes', self.load)):
            service = rospy.Service(rospy.get_name() + '_window/' + name, self.view.SendFilePath, answer)
            self.addCleanup(service.shutdown)
        self.topic = '/%s/markers' % self._testMethodName
        self.markers = rospy.Publisher(self.topic, MarkerArray, queue_size=100)
        self.organs = self.view.Organs(self.topic)
        self.addCleanup(self.organs.subscriber.unregister)
        wait_until(lambda: self.markers.get_num_connections(), 'a subscriber')

    def write_program(self, name, text):
        path = os.path.join(os.path.dirname(self.path), name)
        with open(path, 'w') as program:
            program.write(text)
        os.chmod(path, 0o755)

    def save(self, path):
        with open(path.data, 'w') as text:
            yaml.safe_dump(self.shown, text)
        return Bool(True)

    def load(self, path):
        with open(path.data) as text:
            self.shown = yaml.safe_load(text)
        self.loaded += 1
        return Bool(True)

    def send(self, low, high, frame='organ', parts=2):
        """Sends an organ as its node does: the surface in several messages, and then all other markers."""
        middle = numpy.linspace(low, high, 2 * parts)
        for number in range(parts):
            surface = Marker(ns='surface/organ', id=number, type=Marker.TRIANGLE_LIST, lifetime=rospy.Duration(60))
            surface.points = [Point(*middle[2 * number + k]) for k in (0, 1, 1)]
            surface.header.frame_id = frame
            self.markers.publish([surface])
        status = Marker(ns='status', type=Marker.TEXT_VIEW_FACING, text='organ')
        status.header.frame_id = frame
        self.markers.publish([status])
        wait_until(lambda: self.organs.box()[1] is not None
                   and numpy.allclose(self.organs.box()[1], (low, high)), self.organs.box)

    def assert_fits(self, low, high, frame='organ'):
        manager = self.shown['Visualization Manager']
        self.assertEqual(manager['Global Options']['Fixed Frame'], frame)
        view, (grid,) = manager['Views']['Current'], [d for d in manager['Displays'] if d['Class'] == 'rviz/Grid']
        size, centre = numpy.linalg.norm(numpy.subtract(high, low)), numpy.add(low, high) / 2
        focus, origin = (numpy.array([at[axis] for axis in 'XYZ']) for at in (view['Focal Point'], grid['Offset']))
        self.assertLess(numpy.linalg.norm(focus - centre), 0.3 * size)
        self.assertTrue(1.2 * size < view['Distance'] < 2.5 * size, view)
        numpy.testing.assert_allclose(origin[:2], centre[:2])
        self.assertTrue(0 < low[2] - origin[2] < size, origin)
        self.assertTrue(size / 20 < grid['Cell Size'] < size / 2, grid)

    def test_it_follows_other_organs_and_keeps_all_other_settings(self):
        first, deformed = ((-0.05, -0.03, 0.01), (0.05, 0.03, 0.05)), ((-0.06, -0.03, 0.01), (0.055, 0.03, 0.06))
        others = [((0.95, 0.4, -0.1), (1.35, 0.6, 0.1)),          # elsewhere and larger
                  ((1.14, 0.495, -0.005), (1.16, 0.505, 0.005))]  # at the same place and smaller
        self.send(*first)
        view = self.view.View(self.organs, self.topic, '', self.path)
        with open(self.path) as text:
            self.shown = yaml.safe_load(text)
        self.assert_fits(*first)
        codes = []
        running = threading.Thread(target=lambda: codes.append(view.show(self.rviz)))
        running.start()
        self.send(*deformed)
        time.sleep(2.5)
        self.assertEqual(self.loaded, 0)
        self.shown['Visualization Manager']['Views']['Current']['Pitch'] = 1.25  # Somebody turns the view.
        for number, other in enumerate(others):
            self.send(*other, frame='frame%d' % number, parts=1)
            wait_until(lambda: self.loaded == 1 + number, 'another view')
            self.assert_fits(*other, frame='frame%d' % number)
            self.assertEqual(self.shown['Visualization Manager']['Views']['Current']['Pitch'], 1.25)
        os.remove(self.rviz)
        running.join(30)
        self.assertEqual(codes, [7])


class AllTests(unittest.TestSuite):
    def __init__(self):
        super().__init__(unittest.defaultTestLoader.loadTestsFromTestCase(case) for case in (MarkersTest, ViewTest))


if __name__ == '__main__':
    rospy.init_node('markers_test')
    rostest.rosrun('organ_collision', 'markers', 'markers_test.AllTests', sys.argv)
