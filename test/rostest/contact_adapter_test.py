#!/usr/bin/python3
"""The forces, forces on vertices and lists of faces that contact_adapter publishes behind the real collision node. What
it does not publish, and its parameters."""

import sys

from dynamic_reconfigure.client import Client
from geometry_msgs.msg import WrenchStamped
from organ_collision.msg import ContactArray, ForceState, VertexForces
import rospy
import rostest
from std_msgs.msg import UInt32MultiArray

from support import scenes
from support.contact_case import faces_of, xyz
from support.node_client import LIMIT, Diagnostics, Log, wait_until
from support.processes import NodeStarter
from support.tool_case import ToolCase
from support.tool_over_sheet import SHEET, TROCAR, at_height
from support.vectors import cross

STIFFNESS = 500.0  # [N/m] in examples/forces.launch
RADIUS = 0.005  # [m] in examples/tools.yaml
TOLERANCE = 1e-6  # [N] or [N m]: vertices are 32-bit floats, and depths are exact to 1e-9 m
PLATE = scenes.one_face()
CLEAR = at_height(0.05)
PRESSED = at_height(0.002)  # 3 mm deep
PLACE = (TROCAR[0], TROCAR[1], 0.0)  # where it presses


class Outputs:
    """Everything that the adapter publishes about one organ and tool, in order."""

    def __init__(self, pair, node='/contact_adapter'):
        self.wrenches = Log('%s/%s/wrench' % (node, pair), WrenchStamped)
        self.vertex_forces = Log('%s/%s/vertex_forces' % (node, pair), VertexForces)
        self.faces = Log('%s/%s/faces' % (node, pair), UInt32MultiArray)

    def all_have_come(self):
        return self.wrenches.messages and self.vertex_forces.messages and self.faces.messages

    def of(self, stamp, log=None):
        return (log or self.wrenches).select(lambda message: message.header.stamp == stamp)

    def wait_for(self, stamp):
        """Waits for wrench and vertex forces with this stamp. Returns the wrench."""
        for log in (self.vertex_forces, self.wrenches):
            found = wait_until(lambda: self.of(stamp, log), 'the forces of %s' % stamp)[0]
        return found.wrench

    def wait_for_faces(self, faces):
        wait_until(lambda: list(self.faces.messages[-1].data) == faces,
                   lambda: 'faces %s; there are %s' % (faces, self.faces.messages[-1].data))


class ContactAdapterTest(ToolCase, NodeStarter):
    def move(self, shape, axis):
        """A step of the probe. Returns the answer."""
        return self.step(shape, {'probe': axis}, vertices=True)['probe']

    def connect(self, shape=SHEET, node='/contact_adapter'):
        """Connects to the outputs of this test's organ. Their topics appear with the organ's first step, so this sends
        steps until the outputs arrive."""
        outputs = Outputs(self.organ + '/probe', node)

        def all_come():
            self.step(shape, {'probe': CLEAR})
            return outputs.all_have_come()

        wait_until(all_come, 'outputs of ' + self.organ)
        outputs.wait_for(self.stamp)  # From now on, no earlier wrench can arrive.
        return outputs

    def assert_wrench(self, wrench, force, torque):
        self.assert_near(xyz(wrench.force), force, TOLERANCE, 'force')
        self.assert_near(xyz(wrench.torque), torque, TOLERANCE, 'torque')

    def test_pressed_in_and_out_again(self):
        """The force is stiffness * depth along the outward normal, at the place of the touch, and zero once the tool
        has left. Those on vertices are minus the wrench. The faces are those of `contacts`."""
        outputs = self.connect(PLATE)
        contacts = self.move(PLATE, PRESSED)
        force = (0.0, 0.0, STIFFNESS * (RADIUS - 0.002))
        self.assert_wrench(outputs.wait_for(self.stamp), force, cross(PLACE, force))
        self.assertEqual(outputs.of(self.stamp)[0].header.frame_id, 'liver_frame')
        (on,) = outputs.of(self.stamp, outputs.vertex_forces)
        self.assertEqual((on.organ, on.tool, on.header.frame_id, on.topology, list(on.vertices)),
                         (self.organ, 'probe', 'liver_frame', contacts.topology, [0, 1, 2]))
        total = [sum(axis) for axis in zip(*map(xyz, on.forces))]
        self.assert_near(total, [-x for x in force], TOLERANCE, 'sum')
        outputs.wait_for_faces(faces_of(contacts))
        self.assertGreater(len(self.move(PLATE, CLEAR).contacts), 0)  # touched and left
        self.assert_wrench(outputs.wait_for(self.stamp), (0, 0, 0), (0, 0, 0))
        self.move(PLATE, CLEAR)
        outputs.wait_for_faces([])

    def test_nothing_comes_while_a_transform_is_missing(self):
        """Outputs before and after the gap are waited for, so that nothing can arrive later."""
        outputs, diagnostics = self.connect(), Diagnostics('contact_adapter')
        states = Log('/contact_adapter/%s/probe/state' % self.organ, ForceState).wait_for_publisher()
        self.move(SHEET, PRESSED)
        outputs.wait_for(self.stamp)
        wait_until(lambda: outputs.faces.messages[-1].data, 'the faces before the gap')
        counts = len(outputs.wrenches.messages), len(outputs.faces.messages)
        missing = self.next_stamp()
        self.node.send_vertices(self.organ, SHEET, missing)
        failed = self.node.contacts.wait_for(self.organ, 'probe', mesh_stamp=missing)
        self.assertEqual(failed.status, ContactArray.NO_TRANSFORM)
        state = wait_until(lambda: states.last(lambda state: not state.known), 'the state that says why')
        self.assertEqual((state.organ, state.tool, state.message), (self.organ, 'probe', failed.message))
        self.assertTrue(states.last(lambda state: state.known and not state.message))
        for _ in range(2):  # the first step leaves the sheet, the second stays clear of it
            self.move(SHEET, CLEAR)
        outputs.wait_for(self.stamp)
        outputs.wait_for_faces([])
        self.assertEqual(outputs.of(missing), [])
        self.assertEqual((len(outputs.wrenches.messages), len(outputs.faces.messages)), tuple(n + 2 for n in counts))
        diagnostics.wait_for_count('unpublished, no transform')

    def test_parameters(self):
        """A force larger than max_force is clipped to it at the same place, which log and /diagnostics report. Both
        parameters may change. A misspelt name is reported."""
        name, diagnostics = '/tested_adapter', Diagnostics('tested_adapter')
        process = self.start(name, {'stiffness': STIFFNESS, 'max_force': 1.0, 'stifness': 7}, 'contact_adapter')
        outputs, client = self.connect(PLATE, node=name), Client(name, timeout=LIMIT)
        self.move(PLATE, PRESSED)
        self.assert_wrench(outputs.wait_for(self.stamp), (0.0, 0.0, 1.0), cross(PLACE, (0.0, 0.0, 1.0)))
        diagnostics.wait_for_count('clipped, max_force')
        diagnostics.wait_for_summary('contacts', 'stifness')
        for changes, newtons in (({'stiffness': 200.0}, 0.6), ({'max_force': 0.5}, 0.5), ({'stiffness': -1.0}, 0.5)):
            client.update_configuration(changes)

            def has_this_force():
                self.move(PLATE, PRESSED)
                return abs(outputs.wait_for(self.stamp).force.z - newtons) < TOLERANCE

            wait_until(has_this_force, '%g N' % newtons)
        printed = self.stop(process)
        self.assertIn('the force is clipped to 1.000000 N', printed)
        self.assertIn("stifness is no parameter; nearest is 'stiffness'", printed)


if __name__ == '__main__':
    rospy.init_node('contact_adapter_test')
    rostest.rosrun('organ_collision', 'forces', ContactAdapterTest, sys.argv)
