#!/usr/bin/python3
"""The forces, forces on vertices and lists of faces that contact_adapter publishes behind the real collision node. What
it does not publish, and its parameters."""

import sys
import time

from dynamic_reconfigure.client import Client
from geometry_msgs.msg import WrenchStamped
from organ_collision.msg import Clearance, Contact, ContactArray, ToolPlacement, VertexForces
import rospy
import rostest
from std_msgs.msg import UInt32MultiArray
from std_srvs.srv import Trigger

from support import scenes
from support.contact_case import faces_of, xyz
from support.node_client import LIMIT, Diagnostics, Log, is_heard, wait_until
from support.processes import NodeStarter
from support.tool_case import ToolCase
from support.vectors import cross, length, sub

STIFFNESS = 500.0  # [N/m] in examples/forces.launch
RADIUS = 0.005  # [m] in examples/tools.yaml
TOLERANCE = 1e-6  # [N] or [N m]: vertices are 32-bit floats, and depths are exact to 1e-9 m
SHEET = scenes.sheet(0.1, 4)
TROCAR = (0.013, 0.007, 0.4)
BLOCK = scenes.box((0.09, 0.08, 0.06))  # [m] its upper side is at z = 0.03


def at_height(height):
    """The tool, straight above (0.013, 0.007), with its tip at this height."""
    return (TROCAR, (TROCAR[0], TROCAR[1], height))


CLEAR = at_height(0.05)
PRESSED = at_height(0.002)  # 3 mm deep


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

    def connect(self, shape=SHEET, pair=None, node='/contact_adapter'):
        """Connects to the outputs of this test's organ. Their topics appear with the organ's first step, so this sends
        steps until the outputs arrive."""
        outputs = Outputs(pair or self.organ + '/probe', node)

        def all_come():
            self.step(shape, {'probe': CLEAR})
            return outputs.all_have_come()

        wait_until(all_come, 'outputs of ' + self.organ)
        outputs.wait_for(self.stamp)  # From now on, no earlier wrench can arrive.
        return outputs

    def sender(self):
        """Another sender of contacts."""
        sender = rospy.Publisher('/organ_collision/contacts', ContactArray, queue_size=10)
        self.addCleanup(sender.unregister)
        wait_until(lambda: is_heard(sender, '/contact_adapter'), 'the adapter to listen')
        return sender

    def assert_wrench(self, wrench, force, torque=None, tolerance=TOLERANCE):
        self.assert_near(xyz(wrench.force), force, tolerance, 'force')
        if torque is not None:
            self.assert_near(xyz(wrench.torque), torque, tolerance, 'torque')

    def assert_vertex_forces(self, outputs, shape, answer):
        """Their sum and torque are minus the wrench of the last step. Returns the vertices."""
        wrench, (found,) = outputs.wait_for(self.stamp), outputs.of(self.stamp, outputs.vertex_forces)
        self.assertEqual((found.organ, found.tool, found.header.frame_id, found.topology),
                         (self.organ, answer.tool, 'liver_frame', answer.topology))
        self.assertEqual(list(found.vertices), sorted(set(found.vertices)))
        forces = [xyz(force) for force in found.forces]
        torques = [cross(shape.vertices[vertex], force) for vertex, force in zip(found.vertices, forces)]
        for vectors, minus in ((forces, wrench.force), (torques, wrench.torque)):
            total = [sum(axis) for axis in zip((0.0, 0.0, 0.0), *vectors)]
            self.assert_near(total, [-x for x in xyz(minus)], 1e-9, 'sum')
        return list(found.vertices)

    def test_pressed_in_and_out_again(self):
        """The force is stiffness * depth along the outward normal, at the place of the touch, and zero once the tool
        has left. The faces are those of `contacts`."""
        outputs, shape = self.connect(scenes.one_face()), scenes.one_face()
        contacts = self.move(shape, PRESSED)
        force, place = (0.0, 0.0, STIFFNESS * (RADIUS - 0.002)), (TROCAR[0], TROCAR[1], 0.0)
        self.assert_wrench(outputs.wait_for(self.stamp), force, cross(place, force))
        self.assertEqual(outputs.of(self.stamp)[0].header.frame_id, 'liver_frame')
        outputs.wait_for_faces(faces_of(contacts))
        self.assertGreater(len(self.move(shape, CLEAR).contacts), 0)  # touched and left
        self.assert_wrench(outputs.wait_for(self.stamp), (0, 0, 0), (0, 0, 0))
        self.move(shape, CLEAR)
        outputs.wait_for_faces([])

    def test_vertex_forces_are_minus_the_wrench(self):
        """Also where the force is clipped, and when the tool leaves the tissue."""
        outputs, count = self.connect(), 0
        lying = ((-0.03, 0.007, 0.001), (0.03, 0.007, 0.0005))
        for axis in (PRESSED, at_height(0.0007), lying, at_height(-0.01), CLEAR, CLEAR):
            vertices = self.assert_vertex_forces(outputs, SHEET, self.move(SHEET, axis))
            count += len(vertices)
        self.assertGreater(count, 10)
        self.assertEqual(vertices, [])  # clear of the tissue

    def test_a_finer_mesh_gives_the_same_force(self):
        """The tool presses, pierces, and leans; the sheet has 2 to 7200 faces."""
        leaning = ((0.1, 0.05, 0.3), (0.013, 0.007, 0.0015))
        for cells in (1, 4, 60):
            self.organ = 'sheet_of_%d' % cells
            shape = scenes.sheet(0.1, cells)
            outputs = self.connect(shape)
            for axis, height in ((PRESSED, 0.002), (at_height(-0.0005), -0.0005), (leaning, None), (leaning, 0.0015)):
                self.move(shape, axis)
                wrench = outputs.wait_for(self.stamp)
                if height is not None:  # The step into the lean begins inside the tissue.
                    self.assert_wrench(wrench, (0.0, 0.0, STIFFNESS * (RADIUS - height)))

    def test_a_shaft_that_sinks_past_its_radius_is_pushed_on(self):
        """Even when the axis lies below the sheet, the force keeps its direction and grows."""
        outputs = self.connect()
        for height in (0.002, 0.0005, -0.0005, -0.0009):
            self.move(SHEET, ((-0.03, 0.007, height), (0.03, 0.007, height)))
            force = (0.0, 0.0, STIFFNESS * (RADIUS - height))
            self.assert_wrench(outputs.wait_for(self.stamp), force, tolerance=STIFFNESS * 0.001)

    def test_the_way_out_of_a_closed_organ(self):
        """A short shaft sinks into a block and is drawn out again. Wholly inside, the force is along the nearest way
        out, grows with the depth, without jumps, and is divided among the vertices."""
        short = lambda height: ((0.004, -0.003, height + 0.006), (0.004, -0.003, height))
        rospy.set_param('/organ_collision/tools',
                        [dict(tool, margin=0.05) for tool in rospy.get_param('/organ_collision/tools')])
        self.assertTrue(rospy.ServiceProxy('/organ_collision/reload_tools', Trigger)().success)
        limit = Client('/contact_adapter', timeout=LIMIT)
        limit.update_configuration({'max_force': float('inf')})
        self.addCleanup(limit.update_configuration, {'max_force': 3.0})
        outputs = self.connect(BLOCK)
        wait_until(lambda: self.move(BLOCK, short(0.05)).placement.tip == ToolPlacement.OUTSIDE,
                   'the sides of the block')
        outputs.wait_for(self.stamp)
        heights = [0.037 - 0.001 * i for i in range(26)]
        last, forces, before_last = (0.0, 0.0, 0.0), {}, time.monotonic()
        for height in heights + heights[::-1]:
            begin = time.monotonic()
            answer = self.move(BLOCK, short(height))
            self.assert_vertex_forces(outputs, BLOCK, answer)
            force = xyz(outputs.wait_for(self.stamp).force)
            # The last answer came after the last step had begun.
            bound = STIFFNESS * (4 * 0.001 + 0.05 * (time.monotonic() - before_last))
            if answer.contacts or answer.placement.tip != ToolPlacement.OUTSIDE:
                self.assertLessEqual(length(sub(force, last)), bound, height)
            if not answer.contacts and answer.placement.tip == ToolPlacement.INSIDE:
                self.assertEqual(answer.clearance.state, Clearance.KNOWN)
                forces.setdefault(height, force)
            last, before_last = force, begin
        self.assertEqual(last, (0.0, 0.0, 0.0))  # outside again
        self.assertGreater(len(forces), 5)
        deepest = forces[min(forces)]
        self.assert_near(deepest[:2] + (0.0,), (0.0, 0.0, 0.0), 1e-6, 'straight up')
        self.assertGreater(deepest[2], STIFFNESS * (0.03 - min(forces) - 0.006))
        for force in forces.values():
            self.assertTrue(0.0 < force[2] <= deepest[2] + 1e-6)

    def test_nothing_comes_while_a_transform_is_missing(self):
        """Outputs before and after the gap are waited for, so that nothing can arrive later."""
        outputs, diagnostics = self.connect(), Diagnostics('contact_adapter')
        self.move(SHEET, PRESSED)
        outputs.wait_for(self.stamp)
        wait_until(lambda: outputs.faces.messages[-1].data, 'the faces before the gap')
        counts = len(outputs.wrenches.messages), len(outputs.faces.messages)
        missing = self.next_stamp()
        self.node.send_vertices(self.organ, SHEET, missing)
        failed = self.node.contacts.wait_for(self.organ, 'probe', mesh_stamp=missing)
        self.assertEqual(failed.status, ContactArray.NO_TRANSFORM)
        for _ in range(2):  # the first step leaves the sheet, the second stays clear of it
            self.move(SHEET, CLEAR)
        outputs.wait_for(self.stamp)
        outputs.wait_for_faces([])
        self.assertEqual(outputs.of(missing), [])
        self.assertEqual((len(outputs.wrenches.messages), len(outputs.faces.messages)), tuple(n + 2 for n in counts))
        diagnostics.wait_for_count('unpublished, no transform')

    def test_answers_of_another_sender(self):
        """Malformed contacts publish nothing; without barycentric coordinates, there are no vertex forces; the paper's
        modes have faces alone. A tool that is wholly inside, beyond the margin of its clearance, has no force, because
        the way out is unknown."""
        outputs, diagnostics, sender = self.connect(), Diagnostics('contact_adapter'), self.sender()

        def send(reason, **fields):
            answer = ContactArray(organ=self.organ, tool='probe', links=[''], **fields)
            answer.header.frame_id, answer.header.stamp = 'liver_frame', self.next_stamp()
            before = diagnostics.count('unpublished, ' + reason)
            sender.publish(answer)
            if reason:
                diagnostics.wait_for_count('unpublished, ' + reason, before + 1)
            return answer.header.stamp

        def contact(depth, normal_z):
            found = Contact(depth=depth)
            found.normal.z = normal_z
            return [found]

        inside = ToolPlacement(tip=ToolPlacement.INSIDE, trocar=ToolPlacement.INSIDE)
        refused = [send('malformed contacts', contacts=contact(*bad)) for bad in ((float('nan'), 1.0), (0.001, 0.0))]
        refused += [send('malformed contacts', contacts=contact(0.001, 1.0), mode=9),
                    send('way out unknown', placement=inside, clearance=Clearance(state=Clearance.BEYOND_MARGIN))]
        stamp = send('no barycentric coordinates', contacts=contact(0.001, -1.0))
        wait_until(lambda: outputs.of(stamp), 'the force')
        self.assert_wrench(outputs.of(stamp)[0].wrench, (0.0, 0.0, 0.5), (0.0, 0.0, 0.0))
        self.assertEqual(outputs.of(stamp, outputs.vertex_forces), [])
        paper = send('', mode=ContactArray.PAPER_SWEPT, contacts=[Contact(face=3), Contact(face=17)])
        outputs.wait_for_faces([3, 17])
        self.move(SHEET, PRESSED)
        self.assertGreater(outputs.wait_for(self.stamp).force.z, 0.0)
        self.assertEqual([found for stamp in refused + [paper] for found in outputs.of(stamp)], [])

    def test_names_that_ros_does_not_allow(self):
        """Illegal characters become `_`. A second organ that would get the same topics is refused."""
        self.organ, diagnostics = 'left lobe', Diagnostics('contact_adapter')
        outputs = self.connect(pair='left_lobe/probe')
        self.organ = 'left_lobe'
        self.step(SHEET, {'probe': CLEAR})
        diagnostics.wait_for_count('unpublished, name taken')
        self.assertEqual(outputs.of(self.stamp), [])

    def test_parameters(self):
        """A force larger than max_force is clipped to it at the same place, which log and /diagnostics report. Both
        parameters may change. A misspelt name is reported, and an illegal value stops the node."""
        name, diagnostics, shape = '/tested_adapter', Diagnostics('tested_adapter'), scenes.one_face()
        process = self.start(name, {'stiffness': STIFFNESS, 'max_force': 1.0, 'stifness': 7}, 'contact_adapter')
        outputs, client = self.connect(shape, node=name), Client(name, timeout=LIMIT)
        self.move(shape, PRESSED)
        place, force = (TROCAR[0], TROCAR[1], 0.0), (0.0, 0.0, 1.0)
        self.assert_wrench(outputs.wait_for(self.stamp), force, cross(place, force))
        diagnostics.wait_for_count('clipped, max_force')
        diagnostics.wait_for_summary('contacts', 'stifness')
        for changes, newtons in (({'stiffness': 200.0}, 0.6), ({'max_force': 0.5}, 0.5), ({'stiffness': -1.0}, 0.5),
                                 ({'max_force': float('inf'), 'stiffness': 300.0}, 0.9)):
            client.update_configuration(changes)

            def has_this_force():
                self.move(shape, PRESSED)
                return abs(outputs.wait_for(self.stamp).force.z - newtons) < TOLERANCE

            wait_until(has_this_force, '%g N' % newtons)
        printed = self.stop(process)
        self.assertIn('the force is clipped to 1.000000 N', printed)
        self.assertIn("stifness is no parameter; nearest is 'stiffness'", printed)
        self.assert_refused(self.start('/illegal_adapter', {'stiffness': -12.5}, 'contact_adapter'),
                            ["~stiffness is '-12.5'; must be a number, more than 0"])


if __name__ == '__main__':
    rospy.init_node('contact_adapter_test')
    rostest.rosrun('organ_collision', 'forces', ContactAdapterTest, sys.argv)
