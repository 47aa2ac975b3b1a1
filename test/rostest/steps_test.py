#!/usr/bin/python3
"""The `contacts` that the node publishes step by step, for organs and tools that move."""

import sys

from organ_collision.msg import ContactArray
import rospy
import rostest

from support import oracle, scenes
from support.contact_case import faces_of
from support.contract import KeepsContract
from support.node_client import wait_until
from support.tool_case import ToolCase

STATIC, SWEPT = ContactArray.STATIC, ContactArray.SWEPT
SHEET = scenes.sheet(0.1, 4).moved(lambda v: (v[0], v[1], v[2] + 0.1 * v[0]))
ABOVE = ((0.02, -0.03, 0.3), (0.011, 0.006, 0.05))
BELOW = ((0.02, -0.03, 0.3), (0.004, -0.003, -0.04))
ASIDE = ((0.3, 0.3, 0.3), (0.25, 0.3, 0.2))
GRASPER, HOOK = 0.005, 0.003


class StepsTest(KeepsContract, ToolCase):
    def test_a_stab_through_a_sheet(self):
        """The first step is static, the second is swept through the sheet, and the later ones are
        past it and clear of it."""
        first = self.step(SHEET, {'grasper': ABOVE, 'hook': ASIDE})['grasper']
        self.assert_contacts(first, [])
        self.assertEqual(
            (first.mode, first.step_start, first.header.stamp), (STATIC, self.stamp, self.stamp)
        )
        begin = self.stamp
        second = self.step(SHEET, {'grasper': BELOW, 'hook': ASIDE}, vertices=True)['grasper']
        expected = oracle.swept_contacts(SHEET, ABOVE, BELOW, GRASPER)
        self.assertGreater(len(expected), 0)
        self.assert_contacts(second, expected, 1e-6)
        self.assertEqual(
            (second.mode, second.step_start, second.header.stamp, second.mesh_stamp),
            (SWEPT, begin, self.stamp, self.stamp),
        )
        self.assertEqual(
            (second.header.frame_id, second.organ, second.topology, second.tool),
            ('liver_frame', self.organ, 1, 'grasper'),
        )
        self.assertEqual(second.links, [''])
        self.assert_regions_lie_on_faces(second, SHEET)
        self.step(SHEET, {'grasper': ABOVE, 'hook': ASIDE}, vertices=True)
        clear = self.step(SHEET, {'grasper': ABOVE, 'hook': ASIDE}, vertices=True)['grasper']
        self.assert_contacts(clear, [])

    def test_the_first_step_is_static_though_the_tool_moved_before(self):
        self.place('grasper', (ABOVE, self.next_stamp()))
        first = self.step(SHEET, {'grasper': BELOW, 'hook': ASIDE})['grasper']
        self.assertEqual(first.mode, STATIC)
        self.assert_contacts(first, oracle.static_contacts(SHEET, BELOW, GRASPER))

    def test_a_large_mesh_and_what_follows_at_once_come_in_order(self):
        """The mesh is prepared in another thread. Later messages about the same organ wait for it;
        other organs do not."""
        large = scenes.sheet(0.1, 80)
        other = self.organ + '_other'
        self.step_of_organs({other: SHEET}, {'grasper': ABOVE, 'hook': ASIDE})
        first, second = self.next_stamp(), self.next_stamp()
        for stamp in (first, second):
            self.place('grasper', (BELOW, stamp))
            self.place('hook', (ASIDE, stamp))
        self.node.send_mesh(self.organ, large, first, 1)
        self.node.send_mesh(self.organ, SHEET, second, 2)
        self.node.send_vertices(other, SHEET, first)
        for organ, shape, stamp in (
            (self.organ, large, first),
            (self.organ, SHEET, second),
            (other, SHEET, first),
        ):
            result = self.node.contacts.wait_for(organ, 'grasper', mesh_stamp=stamp)
            self.assert_ok(result)
            touched = {c.face for c in oracle.static_contacts(shape, BELOW, GRASPER)}
            self.assertGreater(len(touched), 0)
            self.assertLessEqual(touched, set(faces_of(result)))

    def test_two_organs_and_two_tools(self):
        """Each pair has its own steps, and only the organ that changed is evaluated."""
        shapes = {self.organ + '_sheet': SHEET, self.organ + '_plate': scenes.one_face(-0.02)}
        before = {'grasper': ABOVE, 'hook': ((0.1, 0.01, 0.2), (0.01, 0.01, 0.03))}
        after = {'grasper': BELOW, 'hook': ((0.1, 0.01, 0.2), (0.0, 0.03, -0.06))}
        radius = {'grasper': GRASPER, 'hook': HOOK}
        for organ, results in self.step_of_organs(shapes, before).items():
            for tool, result in results.items():
                self.assertEqual(result.mode, STATIC)
                expected = oracle.static_contacts(shapes[organ], before[tool], radius[tool])
                self.assert_contacts(result, expected)
        touched = 0
        for organ, results in self.step_of_organs(shapes, after, vertices=True).items():
            for tool, result in results.items():
                motion = (before[tool], after[tool])
                expected = oracle.swept_contacts(shapes[organ], *motion, radius[tool])
                self.assert_contacts(result, expected, 1e-6)
                touched += len(expected) > 0
        self.assertEqual(touched, 4)
        self.organ += '_sheet'
        self.step(SHEET, after, vertices=True)
        for tool in after:
            counts = [len(self.node.contacts.of(organ, tool)) for organ in shapes]
            self.assertEqual(counts, [3, 2])

    def test_tissue_swings_through_a_resting_tool(self):
        """Compares the answers about several shapes with the oracle. One shape arrives as an
        OrganMesh with the same triangles."""
        axis = ((-0.3, 0.02, 0.021), (0.013, 0.011, 0.014))
        heights = [0.05, -0.03, 0.012, 0.06]
        shapes = [SHEET.moved(lambda v: (v[0], v[1], v[2] + h + h * v[1])) for h in heights]
        tools = {'grasper': axis, 'hook': ASIDE}
        result = self.step(shapes[0], tools)['grasper']
        self.assert_contacts(result, oracle.static_contacts(shapes[0], axis, GRASPER))
        touched = []
        for i in range(1, 4):
            result = self.step(shapes[i], tools, vertices=i != 2)['grasper']
            expected = oracle.contacts(shapes[i], shapes[i - 1], (axis, axis), GRASPER)
            self.assert_contacts(result, expected, 1e-6)
            touched.append(len(expected))
        self.assertGreater(min(touched), 0)

    def test_organ_and_tool_move_in_one_step(self):
        low = SHEET.moved(lambda v: (v[0] + 0.01, v[1], v[2] - 0.03 + 0.3 * v[1]))
        self.step(SHEET, {'grasper': ABOVE, 'hook': ASIDE})
        result = self.step(low, {'grasper': BELOW, 'hook': ASIDE}, vertices=True)['grasper']
        expected = oracle.contacts(low, SHEET, (ABOVE, BELOW), GRASPER)
        self.assertGreater(len(expected), 0)
        self.assert_contacts(result, expected, 1e-6)

    def test_cut_tissue_rests_while_the_tool_is_swept(self):
        """A new topology has no previous shape, but the tool keeps its previous pose."""
        cut = scenes.Mesh(scenes.sheet(0.1, 3, -0.005).vertices, scenes.sheet(0.1, 3).faces[2:])
        self.step(SHEET, {'grasper': ABOVE, 'hook': ASIDE})
        result = self.step(cut, {'grasper': BELOW, 'hook': ASIDE}, topology=2)['grasper']
        self.assertEqual((result.mode, result.topology), (SWEPT, 2))
        expected = oracle.swept_contacts(cut, ABOVE, BELOW, GRASPER)
        self.assertGreater(len(expected), 0)
        self.assert_contacts(result, expected, 1e-6)
        lifted = cut.moved(lambda v: (v[0], v[1], v[2] + 0.2))
        result = self.step(lifted, {'grasper': BELOW, 'hook': ASIDE}, topology=2, vertices=True)[
            'grasper'
        ]
        expected = oracle.contacts(lifted, cut, (BELOW, BELOW), GRASPER)
        self.assert_contacts(result, expected, 1e-6)

    def test_only_the_newest_of_many_shapes_counts(self):
        """Sends hundreds of shapes at once, and one of another organ. The last shape of each organ
        is evaluated."""
        self.step(SHEET, {'grasper': ABOVE, 'hook': ASIDE})
        for _ in range(300):
            self.node.send_vertices(self.organ, SHEET, self.next_stamp(rospy.Duration(0, 10**5)))
        last = self.stamp
        self.node.send_mesh(self.organ + '_other', SHEET, last)
        for tool, axis in (('grasper', BELOW), ('hook', ASIDE)):
            self.place(tool, (axis, last))
        result = self.node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=last)
        self.assertEqual(result.status, ContactArray.OK)
        other = self.node.contacts.wait_for(self.organ + '_other', 'grasper', mesh_stamp=last)
        self.assert_contacts(other, oracle.static_contacts(SHEET, BELOW, GRASPER))

    def test_reset_makes_the_next_step_static(self):
        self.step(SHEET, {'grasper': ABOVE, 'hook': ASIDE})
        self.node.reset()
        result = self.step(SHEET, {'grasper': BELOW, 'hook': ASIDE}, vertices=True)['grasper']
        self.assertEqual((result.mode, result.step_start), (STATIC, result.header.stamp))
        self.assert_contacts(result, oracle.static_contacts(SHEET, BELOW, GRASPER))
        result = self.step(SHEET, {'grasper': ABOVE, 'hook': ASIDE}, vertices=True)['grasper']
        self.assertEqual(result.mode, SWEPT)

    def test_an_organ_is_removed_and_comes_back_without_history(self):
        self.step(SHEET, {'grasper': ABOVE, 'hook': ASIDE})
        self.node.remove(self.organ)
        shape = scenes.tetrahedron()
        result = self.step(shape, {'grasper': BELOW, 'hook': ASIDE})['grasper']
        self.assertEqual(result.mode, STATIC)
        self.assert_contacts(result, oracle.static_contacts(shape, BELOW, GRASPER))

    def test_a_mesh_without_stamp_takes_the_latest_transforms(self):
        self.step(SHEET, {'grasper': ABOVE, 'hook': ASIDE})
        inside = ((0.02, -0.03, 0.3), (0.011, 0.006, 0.002))
        self.place('grasper', (inside, self.next_stamp()))
        wait_until(
            lambda: self.node.query(self.organ, tool='grasper').contacts, 'the tip in the sheet'
        )
        self.node.send_mesh(self.organ + '_2', SHEET)
        result = self.node.contacts.wait_for(self.organ + '_2', 'grasper')
        self.assertEqual(result.mode, STATIC)
        self.assert_contacts(result, oracle.static_contacts(SHEET, inside, GRASPER))


if __name__ == '__main__':
    rospy.init_node('steps_test')
    rostest.rosrun('organ_collision', 'steps', StepsTest, sys.argv)
