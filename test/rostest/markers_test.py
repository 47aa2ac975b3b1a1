#!/usr/bin/python3
"""The markers show organs, tools and contacts, and of haptic_proxy hands, proxies and states, also to a viewer that
comes late. They leave nothing of what is gone."""

import math
import sys
import threading
import time

from geometry_msgs.msg import PoseStamped
from organ_collision.msg import OrganMesh
import rospy
import rostest
from visualization_msgs.msg import Marker, MarkerArray

from support.node_client import NodeClient, TfSender, mesh_message, pose_stamped, wait_until
from support.processes import NodeStarter
from support.tool_over_sheet import SHEET

TOOL = {'name': 'probe', 'trocar_frame': 'probe_trocar', 'tip_frame': 'probe_tip', 'radius': 0.005, 'margin': 0.02,
        'max_near': 50}
TROCAR = (0.01, 0.02, 0.3)
TOUCHING, ABOVE = -0.302, -0.2  # [m] z coordinate of the tip, relative to the trocar
FULL = {'surface/sheet', 'tools', 'touched', 'normals', 'names', 'near', 'clearance', 'crossings', 'status'}


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

    def test_hand_and_proxy(self):
        frame, height = 'organ', 0.02
        tool = {'name': 'probe', 'trocar_frame': 'hand_trocar', 'tip_pose_topic': '/probe/pose', 'radius': 0.005}
        hand = rospy.Publisher('/probe/pose', PoseStamped, queue_size=100)
        meshes = rospy.Publisher('/hands/organ_mesh', OrganMesh, queue_size=1, latch=True)
        transforms = TfSender()
        transforms.send_resting((frame, 'hand_trocar', (0, 0, 0.3)))
        process = self.start('/hands', {'tools': [tool], 'stiffness': 200.0, 'pose_timeout_sec': 0.3,
                                        'max_force': math.inf}, 'haptic_proxy')
        viewer = Viewer('/hands/markers')
        meshes.publish(mesh_message('sheet', SHEET, frame=frame))

        def holds(target, state, shown):
            """Moves the hand by a small step. Returns whether it is there and what is shown."""
            nonlocal height
            height += math.copysign(min(abs(target - height), 1e-3), target - height)
            hand.publish(pose_stamped(frame, (0.013, 0.007, height), rospy.Time.now()))
            time.sleep(0.005)
            return height == target and viewer.text('state') == state and viewer.namespaces() == shown

        shown = {'surface/sheet', 'status', 'state', 'proxy'}
        wait_until(lambda: holds(0.02, 'probe: FREE, 0.0 N', shown), viewer.namespaces)
        self.assertEqual([m.type for m in viewer.of('proxy')], [Marker.CYLINDER, Marker.SPHERE, Marker.SPHERE])
        shown |= {'hand', 'spring', 'loads'}
        wait_until(lambda: holds(-0.02, 'probe: TOUCHING, 5.0 N', shown), viewer.namespaces)
        # The hand is silent: there is no answer any more.
        wait_until(lambda: viewer.text('state').startswith('probe: NO_ANSWER: '), lambda: viewer.text('state'))
        viewer.wait_for({'surface/sheet', 'status', 'state', 'hand'})
        self.stop(process)


if __name__ == '__main__':
    rospy.init_node('markers_test')
    rostest.rosrun('organ_collision', 'markers', MarkersTest, sys.argv)
