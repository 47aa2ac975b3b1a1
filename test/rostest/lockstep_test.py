#!/usr/bin/python3
"""haptic_proxy with a tool in lockstep, as a slow simulator uses it: each shape of an organ has one answer, about this
shape. No test depends on how fast shapes are answered."""

import sys
import time

from geometry_msgs.msg import WrenchStamped
import numpy as np
from organ_collision.msg import OrganMesh, OrganVertices, ProxyState, VertexForces
import rospy
import rostest

from support import scenes
from support.node_client import LIMIT, Log, TfSender, is_heard, mesh_message, vertices_message, wait_until
from support.processes import NodeStarter

FRAME = 'tissue_frame'
STIFFNESS, CLEARANCE, RADIUS = 200.0, 1e-4, 0.005  # [N/m], [m], [m]
TIP = (0.004, -0.003, 0.0)  # [m] in the tip frame, which is turned
SHEET = scenes.sheet(0.1, 6)
SHAPES, PERIOD = 12, 0.1  # [s]
POSE = scenes.Pose((0.3, -0.5, 0.2, 0.7), (0.013, 0.007, 0.004))
BASE = (0.03, -0.02, 0.2)


def vector(message):
    return (message.x, message.y, message.z)


class LockstepTest(NodeStarter):
    def setUp(self):
        name = self.id().split('.')[-1]  # No static transform of another test may reach the node.
        self.name, self.tip_frame = '/' + name, name + '_tip'
        tool = dict(name='mover', trocar_frame=name + '_base', tip_frame=self.tip_frame, radius=RADIUS,
                    tip_offset=list(TIP), freedom='free', lockstep=True)
        self.start(self.name, {'tools': [tool], 'stiffness': STIFFNESS, 'max_torque': 10.0}, 'haptic_proxy')
        rospy.wait_for_service(self.name + '/reset', LIMIT)
        self.tf = TfSender()
        self.tf.send_resting((FRAME, name + '_base', BASE))
        self.meshes, self.shapes = (rospy.Publisher('%s/organ_%s' % (self.name, topic), kind, queue_size=10)
                                    for topic, kind in (('mesh', OrganMesh), ('vertices', OrganVertices)))
        self.states = Log(self.name + '/mover/state', ProxyState).wait_for_publisher()
        self.wrenches = Log(self.name + '/mover/wrench', WrenchStamped).wait_for_publisher()
        self.forces = Log(self.name + '/tissue/mover/vertex_forces', VertexForces)
        wait_until(lambda: all(is_heard(topic, self.name) for topic in (
            self.meshes, self.shapes, self.tf.moving, self.tf.resting)), 'connections')

    def begin(self, moves=True):
        """Sends the sheet far below the tool until its forces come back: their topic appears with the first answer."""

        def answered():
            stamp = rospy.Time.now()
            if moves:
                self.tf.send((FRAME, self.tip_frame, POSE, stamp))
            self.meshes.publish(mesh_message('tissue', SHEET.moved(lambda v: np.subtract(v, (0, 0, 0.05))), stamp, frame=FRAME))
            time.sleep(PERIOD)
            return self.forces.select(lambda forces: forces.mesh_stamp == stamp) and all(
                log.last().header.stamp == stamp for log in (self.states, self.wrenches))

        wait_until(answered, lambda: 'forces; the state is %s' % self.states.last())
        del self.forces.messages[:], self.states.messages[:], self.wrenches.messages[:]

    def step(self, height, moves=True):
        """Sends a sheet at a height, and waits for the forces on it. Returns them, and the sheet."""
        stamp, sheet = rospy.Time.now(), SHEET.moved(lambda v: np.add(v, (0, 0, height)))
        if moves:
            self.tf.send((FRAME, self.tip_frame, POSE, stamp))
        self.shapes.publish(vertices_message('tissue', sheet, stamp, frame=FRAME))
        return wait_until(lambda: self.forces.select(lambda forces: forces.mesh_stamp == stamp),
                          lambda: 'forces on the shape; the state is %s' % self.states.last())[0], sheet

    def check_steps(self, moves):
        """Each shape has one answer, with the whole force, which does not fade. The wrench is that of the forces."""
        tip, stamps = POSE.apply(TIP), []
        for i in range(SHAPES):
            height = 0.007 * min(i, 5) / 5 - 0.001
            forces, sheet = self.step(height, moves)
            stamps.append(forces.mesh_stamp)
            wrench = wait_until(lambda: len(self.wrenches.messages) > i and self.wrenches.messages[i], 'the wrench')
            self.assertEqual(wrench.header.frame_id, self.tip_frame)
            on_vertices = np.array([vector(each) for each in forces.forces]).reshape(-1, 3)
            arms = np.array([sheet.vertices[vertex] for vertex in forces.vertices]).reshape(-1, 3) - POSE.translation
            force, torque = -on_vertices.sum(axis=0), -np.cross(arms, on_vertices).sum(axis=0)
            turn = scenes.Pose(POSE.rotation, (0.0, 0.0, 0.0))
            for found, right, tolerance in ((wrench.wrench.force, force, 1e-6), (wrench.wrench.torque, torque, 1e-7)):
                self.assertLess(abs(turn.apply(vector(found)) - right).max(), tolerance)
            if i == SHAPES - 1:  # A long shaft also turns, so that the force is smaller than that of a ball.
                self.assertGreater(force[2], 0.5 * STIFFNESS * (height + RADIUS + CLEARANCE - tip[2]))
            time.sleep(PERIOD)
        wait_until(lambda: len(self.states.messages) >= SHAPES, 'the states')
        time.sleep(PERIOD)
        states = self.states.select(lambda state: True)
        self.assertEqual([forces.mesh_stamp for forces in self.forces.messages], stamps)
        self.assertEqual((len(states), len(self.wrenches.messages)), (SHAPES, SHAPES))
        self.assertEqual({state.state for state in states} - {ProxyState.FREE, ProxyState.TOUCHING}, set())
        self.assertFalse(any(state.fading for state in states))
        if moves:
            self.assertEqual([state.header.stamp for state in states], stamps)

    def test_each_shape_is_answered_once(self):
        self.begin()
        self.check_steps(moves=True)

    def test_a_tool_that_rests_on_tf_is_where_it_was_last(self):
        self.begin()
        self.check_steps(moves=False)

    def test_a_tool_of_static_transforms(self):
        self.tf.send_resting((FRAME, self.tip_frame, POSE))
        self.begin(moves=False)
        self.check_steps(moves=False)


if __name__ == '__main__':
    rospy.init_node('lockstep_test')
    rostest.rosrun('organ_collision', 'lockstep', LockstepTest, sys.argv)
