#!/usr/bin/python3
"""The markers of haptic_proxy show organ, proxy, hand and state. They are those of the last answer, and say it if there
is none."""

import math
import sys
import time

from geometry_msgs.msg import PoseStamped
from organ_collision.msg import OrganMesh
import rospy
import rostest
from visualization_msgs.msg import Marker

from support import scenes
from support.marker_viewer import Viewer
from support.node_client import TfSender, wait_until
from support.node_starter import NodeStarter

FRAME = 'organ'
TOOL = {'name': 'probe', 'trocar_frame': 'probe_trocar', 'tip_pose_topic': '/probe/pose', 'radius': 0.005}
SHEET = scenes.sheet(0.1, 4)
X, Y = 0.013, 0.007  # [m] of the tip
CLEARANCE = 1e-4  # [m]
STIFFNESS = 200.0  # [N/m]


class ProxyMarkersTest(NodeStarter):
    def setUp(self):
        self.hand = rospy.Publisher('/probe/pose', PoseStamped, queue_size=100)
        self.meshes = rospy.Publisher('/hands/organ_mesh', OrganMesh, queue_size=1, latch=True)
        self.transforms = TfSender()
        self.transforms.send_resting((FRAME, 'probe_trocar', scenes.Pose((0, 0, 0, 1), (0, 0, 0.3))))
        parameters = {'tools': [TOOL], 'stiffness': STIFFNESS, 'pose_timeout_sec': 0.3}
        self.process = self.start('/hands', parameters, 'haptic_proxy')
        self.viewer = Viewer('/hands/markers')
        self.height = 0.02

    def send_sheet(self):
        mesh = OrganMesh(organ='sheet', vertices=SHEET.flat_vertices(), triangles=SHEET.flat_faces())
        mesh.header.frame_id = FRAME
        self.meshes.publish(mesh)

    def hold_until(self, height, condition, what):
        """Moves the hand to a height, in small steps, and holds it there until the condition holds."""

        def holds():
            way = height - self.height
            self.height += math.copysign(min(abs(way), 1e-3), way)
            pose = PoseStamped()
            pose.header.frame_id, pose.header.stamp = FRAME, rospy.Time.now()
            pose.pose.position.x, pose.pose.position.y, pose.pose.position.z = X, Y, self.height
            pose.pose.orientation.w = 1.0
            self.hand.publish(pose)
            time.sleep(0.005)
            return self.height == height and condition()

        wait_until(holds, lambda: '%s; there is %s %s' % (what, self.viewer.namespaces(), self.state()))

    def state(self):
        return ''.join(marker.text for marker in self.viewer.of('state'))

    def test_hand_and_proxy(self):
        self.send_sheet()
        self.hold_until(0.02, lambda: self.state() == 'probe: FREE, 0.0 N', 'a free probe')
        shown = {'surface/sheet', 'status', 'state', 'proxy'}
        self.assertEqual(self.viewer.namespaces(), shown)
        self.assertEqual(
            [m.type for m in self.viewer.of('proxy')], [Marker.CYLINDER, Marker.SPHERE, Marker.SPHERE]
        )

        self.hold_until(-0.02, lambda: self.state() == 'probe: TOUCHING, 5.0 N', 'a probe that is held')
        self.assertEqual(self.viewer.namespaces(), shown | {'hand', 'spring', 'loads'})
        start, end = self.viewer.of('spring')[0].points
        self.assertAlmostEqual(start.z, -0.02, delta=1e-9)
        self.assertAlmostEqual(end.z, TOOL['radius'] + CLEARANCE, delta=1e-5)

        # The hand is silent: there is no answer any more.
        wait_until(lambda: self.state().startswith('probe: NO_ANSWER: '), self.state)
        self.viewer.wait_for({'surface/sheet', 'status', 'state', 'hand'})
        self.viewer.close()
        self.stop(self.process)


if __name__ == '__main__':
    rospy.init_node('proxy_markers_test')
    rostest.rosrun('organ_collision', 'proxy_markers', ProxyMarkersTest, sys.argv)
