#!/usr/bin/python3
"""The markers show organs, tools and contacts, also to a viewer that comes late, and leave nothing
of what is gone."""

import sys

import rospy
import rostest
from visualization_msgs.msg import Marker

from support import scenes
from support.marker_viewer import Viewer
from support.node_client import NodeClient, TfSender, wait_until
from support.node_starter import NodeStarter
from support.scenes import Pose

TOOL = {
    'name': 'probe',
    'trocar_frame': 'probe_trocar',
    'tip_frame': 'probe_tip',
    'radius': 0.005,
    'margin': 0.02,
    'max_near': 50,
}
SHEET = scenes.sheet(0.1, 4)
NO_TURN = (0.0, 0.0, 0.0, 1.0)
TROCAR = Pose(NO_TURN, (0.01, 0.02, 0.3))
TOUCHING, ABOVE = -0.302, -0.2  # [m] z coordinate of the tip, relative to the trocar
FULL = {
    'surface/sheet', 'tools', 'touched', 'normals', 'names', 'near', 'clearance', 'crossings', 'status'
}


class MarkersTest(NodeStarter):
    def start_node(self, name, **parameters):
        """A node with one tool, its client, and a sender of its transforms."""
        process = self.start(name, dict(parameters, tools=[TOOL]))
        client = NodeClient(name)
        self.addCleanup(client.close)
        transforms = TfSender()
        transforms.wait_for(client)
        transforms.send_resting((client.frame, 'probe_trocar', TROCAR))
        return process, client, transforms

    def step(self, client, transforms, height, organ='sheet'):
        """Sends the sheet and a pose of the tip, and waits for the answer."""
        now = rospy.Time.now()
        transforms.send(('probe_trocar', 'probe_tip', Pose(NO_TURN, (0.0, 0.0, height)), now))
        client.send_mesh(organ, SHEET, now)
        return client.contacts.wait_for(organ, 'probe', stamp=now)

    def test_what_is_there_is_shown_and_what_is_gone_is_not(self):
        process, client, transforms = self.start_node('/shown')
        viewer = Viewer('/shown/markers')
        self.assertTrue(self.step(client, transforms, TOUCHING).contacts)
        viewer.wait_for(FULL)

        surface = viewer.of('surface/sheet')[0]
        self.assertEqual(surface.header.frame_id, client.frame)
        corners = [(p.x, p.y, p.z) for p in surface.points]
        self.assertEqual(corners, [SHEET.vertices[i] for i in SHEET.flat_faces()])
        self.assertEqual([m.text for m in viewer.of('names')], ['probe'])
        self.assertIn('probe: ', viewer.of('status')[0].text)
        self.assertEqual(
            [m.type for m in viewer.of('tools')], [Marker.CYLINDER, Marker.SPHERE, Marker.SPHERE]
        )

        self.check_late_viewer()

        self.step(client, transforms, ABOVE)  # This step begins with the contacts.
        self.assertFalse(self.step(client, transforms, ABOVE).contacts)
        viewer.wait_for({'surface/sheet', 'tools', 'status'})
        client.reset()  # The tool has no pose any more.
        viewer.wait_for({'surface/sheet', 'status'})
        client.remove('sheet')
        viewer.wait_for(set())
        viewer.close()
        self.stop(process)

    def check_late_viewer(self):
        """Checks that a viewer that comes while nothing moves gets everything."""
        late = Viewer('/shown/markers')
        late.wait_for(FULL)
        late.close()

    def test_rates(self):
        """Surfaces are sent at their rate, and not at all if it is 0."""
        process, client, transforms = self.start_node('/slow', surface_rate=5.0, markers_rate=100.0)
        viewer = Viewer('/slow/markers')
        start, steps = rospy.get_time(), 0
        while rospy.get_time() < start + 1.0 or viewer.surfaces < 3:
            self.step(client, transforms, ABOVE)
            steps += 1
        self.assertLessEqual(viewer.surfaces, 2 + 5.0 * (rospy.get_time() - start))
        viewer.close()
        self.stop(process)

        process, client, transforms = self.start_node('/bare', surface_rate=0)
        viewer = Viewer('/bare/markers')
        self.step(client, transforms, TOUCHING)
        viewer.wait_for(FULL - {'surface/sheet'})
        viewer.close()
        self.stop(process)

    def test_an_organ_is_shown_without_transforms(self):
        """The status says why nothing is answered about it."""
        process = self.start('/lone', {'tools': [TOOL]})
        client = NodeClient('/lone')
        self.addCleanup(client.close)
        viewer = Viewer('/lone/markers')
        client.send_mesh('sheet', SHEET, rospy.Time.now())
        viewer.wait_for({'surface/sheet', 'status'})
        wait_until(lambda: 'no transform' in viewer.of('status')[0].text, 'the reason')
        viewer.close()
        self.stop(process)


if __name__ == '__main__':
    rospy.init_node('markers_test')
    rostest.rosrun('organ_collision', 'markers', MarkersTest, sys.argv)
