#!/usr/bin/python3
"""The `contacts` that the node publishes step by step, for organs and tools that move, also between two meshes."""

import random
import sys

from organ_collision.msg import ContactArray
import rospy
import rostest

from support import oracle, scenes
from support.contact_case import KeepsContract, faces_of
from support.node_client import NodeClient, wait_until
from support.simulated_clock import SimulatedCase
from support.tool_case import STEP, ball_contacts

STATIC, SWEPT = ContactArray.STATIC, ContactArray.SWEPT
SHEET = scenes.sheet(0.1, 4).moved(lambda v: (v[0], v[1], v[2] + 0.1 * v[0]))
ABOVE = ((0.02, -0.03, 0.3), (0.011, 0.006, 0.05))
BELOW = ((0.02, -0.03, 0.3), (0.004, -0.003, -0.04))
ASIDE = ((0.3, 0.3, 0.3), (0.25, 0.3, 0.2))
OTHERS = {'hook': ASIDE, 'ball': ((0.3, 0.3, 0.2),)}
GRASPER, HOOK, BALL = 0.005, 0.003, 0.006  # [m] radii


class StepsTest(KeepsContract, SimulatedCase):
    link_frames = {'ball': ('ball',)}

    def move(self, shape, axis, topology=1, vertices=True, step=STEP):
        """A step of the grasper. The other tools are far away. Returns the answer."""
        return self.step(shape, dict(OTHERS, grasper=axis), topology, vertices, step)['grasper']

    def begin(self, shape=SHEET, axis=ABOVE):
        """The first step."""
        return self.move(shape, axis, vertices=False)

    def assert_swept(self, result, now, before, motion, radius=GRASPER):
        """Checks a swept step against the oracle, in which something touches."""
        expected = oracle.contacts(now, before, motion, radius)
        self.assertGreater(len(expected), 0)
        self.assertEqual(result.mode, SWEPT)
        self.assert_contacts(result, expected, 1e-6)

    def test_a_stab_through_a_sheet(self):
        """The first step is static, the second is swept through the sheet, and the fourth is clear of it."""
        first, begin = self.begin(), self.stamp
        self.assert_contacts(first, [])
        self.assertEqual((first.mode, first.step_start, first.header.stamp), (STATIC, begin, begin))
        second = self.move(SHEET, BELOW)
        self.assert_swept(second, SHEET, SHEET, (ABOVE, BELOW))
        self.assertEqual((second.step_start, second.header.stamp, second.mesh_stamp), (begin, self.stamp, self.stamp))
        self.assertEqual((second.header.frame_id, second.organ, second.topology, second.tool, second.links),
                         ('liver_frame', self.organ, 1, 'grasper', ['']))
        self.assert_regions_lie_on_faces(second, SHEET)
        self.move(SHEET, ABOVE)
        self.assert_contacts(self.move(SHEET, ABOVE), [])

    def test_static_steps(self):
        """The first one, though the tool moved before; after a reset, also of a link; and of an organ that comes
        back."""
        self.place('grasper', (ABOVE, self.next_stamp()))
        solid = scenes.tetrahedron()
        for number in range(3):
            if number == 1:
                self.node.reset()
            if number == 2:
                self.node.remove(self.organ)
            shape = solid if number == 2 else SHEET
            tools = dict(OTHERS, grasper=BELOW, ball=((0.01, 0.02, 0.003),))
            results = self.step(shape, tools, vertices=number == 1)
            for tool in ('grasper', 'ball'):
                self.assertEqual((results[tool].mode, results[tool].step_start), (STATIC, results[tool].header.stamp))
            self.assert_contacts(results['grasper'], oracle.static_contacts(shape, BELOW, GRASPER))
            self.assert_contacts(results['ball'], ball_contacts(shape, tools['ball'], tools['ball'], BALL), 1e-6)
        self.assertEqual(self.move(solid, ABOVE).mode, SWEPT)

    def test_two_organs_and_two_tools(self):
        """Each pair has its own steps, and only the organ that changed is evaluated."""
        shapes = {self.organ + '_sheet': SHEET, self.organ + '_plate': scenes.one_face(-0.02)}
        before = dict(OTHERS, grasper=ABOVE, hook=((0.1, 0.01, 0.2), (0.01, 0.01, 0.03)))
        after = dict(OTHERS, grasper=BELOW, hook=((0.1, 0.01, 0.2), (0.0, 0.03, -0.06)))
        self.step_of_organs(shapes, before)
        for organ, results in self.step_of_organs(shapes, after, vertices=True).items():
            for tool, radius in (('grasper', GRASPER), ('hook', HOOK)):
                self.assert_swept(results[tool], shapes[organ], shapes[organ], (before[tool], after[tool]), radius)
        self.organ += '_sheet'
        self.step(SHEET, after, vertices=True)
        self.assertEqual([len(self.node.contacts.of(organ, 'hook')) for organ in shapes], [3, 2])

    def test_tissue_swings_through_a_tool(self):
        """Of a tool that rests, and then moves at the same time. One shape arrives as an OrganMesh with the same
        triangles."""
        axis = ((-0.3, 0.02, 0.021), (0.013, 0.011, 0.014))
        shapes = [SHEET.moved(lambda v: (v[0], v[1], v[2] + h + h * v[1])) for h in (0.05, -0.03, 0.012, 0.06)]
        self.begin(shapes[0], axis)
        for i in range(1, 4):
            self.assert_swept(self.move(shapes[i], axis, vertices=i != 2), shapes[i], shapes[i - 1], (axis, axis))
        self.assert_swept(self.move(shapes[1], BELOW), shapes[1], shapes[3], (axis, BELOW))

    def test_cut_tissue_rests_while_the_tool_is_swept(self):
        """A new topology has no previous shape, but the tool keeps its previous pose."""
        cut = scenes.Mesh(scenes.sheet(0.1, 3, -0.005).vertices, scenes.sheet(0.1, 3).faces[2:])
        self.begin()
        result = self.move(cut, BELOW, topology=2, vertices=False)
        self.assertEqual(result.topology, 2)
        self.assert_swept(result, cut, cut, (ABOVE, BELOW))

    def test_a_large_mesh_and_what_follows_at_once_come_in_order(self):
        """The mesh is prepared in another thread. Later messages about the same organ wait for it; other organs do
        not."""
        large, other = scenes.sheet(0.1, 80), self.organ + '_other'
        self.step_of_organs({other: SHEET}, dict(OTHERS, grasper=ABOVE))
        first, second = self.next_stamp(), self.next_stamp()
        for tool, axis in dict(OTHERS, grasper=BELOW).items():
            self.place(tool, (axis, first), (axis, second))
        self.node.send_mesh(self.organ, large, first, 1)
        self.node.send_mesh(self.organ, SHEET, second, 2)
        self.node.send_vertices(other, SHEET, first)
        for organ, shape, stamp in ((self.organ, large, first), (self.organ, SHEET, second), (other, SHEET, first)):
            result = self.node.contacts.wait_for(organ, 'grasper', mesh_stamp=stamp)
            self.assert_ok(result)
            touched = {c.face for c in oracle.static_contacts(shape, BELOW, GRASPER)}
            self.assertGreater(len(touched), 0)
            self.assertLessEqual(touched, set(faces_of(result)))

    def test_only_the_newest_of_many_shapes_counts(self):
        """The first of the shapes waits for all tools, and the last one waits behind it. Those between them are
        counted."""
        said = self.node.diagnostics
        wait_until(lambda: 'shapes superseded by newer ones' in said.values, '/diagnostics')
        self.begin()
        before = said.count('shapes superseded by newer ones')
        with self.clock.lock:
            for _ in range(30):
                self.node.send_vertices(self.organ, SHEET, self.next_stamp(rospy.Duration(0, 10**5)))
            self.node.wait_for_shape(self.organ, self.stamp)
            for tool, axis in dict(OTHERS, grasper=BELOW).items():
                self.place(tool, (axis, self.stamp))
            result = self.node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=self.stamp)
        self.assertEqual(result.status, ContactArray.OK)
        said.wait_for_count('shapes superseded by newer ones', before + 3)

    def test_a_mesh_without_stamp_takes_the_latest_transforms(self):
        self.begin()
        inside = ((0.02, -0.03, 0.3), (0.011, 0.006, 0.002))
        self.place_and_wait('grasper', inside, self.next_stamp())
        self.node.send_mesh(self.organ + '_2', SHEET)
        result = self.node.contacts.wait_for(self.organ + '_2', 'grasper')
        self.assertEqual(result.mode, STATIC)
        self.assert_contacts(result, oracle.static_contacts(SHEET, inside, GRASPER))

    def test_a_late_mesh_finds_the_tool_at_its_last_pose(self):
        """The mesh is stamped before the last evaluation, so the tool rests while the tissue moves."""
        early = self.next_stamp()
        self.begin()
        self.place('grasper', (BELOW, self.next_stamp()))
        raised = SHEET.moved(lambda v: (v[0], v[1], v[2] + 0.052))
        self.node.send_vertices(self.organ, raised, early)
        result = self.node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=early)
        self.assert_swept(result, raised, SHEET, (ABOVE, ABOVE))

    def test_a_gap_in_tf_is_published_and_then_swept_across(self):
        """The step after it begins with pose and shape of the last answer, also after poses that are not finite."""
        low, high = (SHEET.moved(lambda v: (v[0], v[1], v[2] + h)) for h in (-0.08, 0.03))
        self.begin()
        begin, gap = self.stamp, self.next_stamp()
        self.node.send_vertices(self.organ, low, gap)
        missing = self.node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=gap)
        self.assert_no_transform(missing, 'grasper_t')
        result = self.move(high, BELOW)
        self.assertEqual(result.step_start, begin)
        self.assert_swept(result, high, SHEET, (ABOVE, BELOW))
        bad = float('inf')
        self.place('grasper', (((bad, 0.0, 0.4), (0.013, bad, 0.05)), self.next_stamp()))
        self.node.send_vertices(self.organ, high, self.stamp)
        result = self.node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=self.stamp)
        self.assertNotEqual((result.status, result.message), (ContactArray.OK, ''))
        result = self.move(high, ABOVE)
        self.assertEqual((result.status, result.path_incomplete), (ContactArray.OK, True))
        self.assertIn('is not finite', result.message)
        self.assertEqual(faces_of(result), [c.face for c in oracle.swept_contacts(high, BELOW, ABOVE, GRASPER)])

    def test_frames_of_organs(self):
        """TF does not know the first one. The other one moves: a breathing organ touches a tool that rests."""
        message = self.node.mesh_message(self.organ, SHEET, self.next_stamp())
        message.header.frame_id = 'adrift'
        self.node.meshes.publish(message)
        self.assert_no_transform(self.node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=self.stamp), 'adrift')
        poses = [scenes.Pose((0.1, 0.0, 0.0, 1.0), (0.01, 0.02, z)) for z in (-0.05, 0.06)]
        node, axis = NodeClient('/patient'), ((0.013, 0.007, 0.4), (0.013, 0.007, 0.0))
        self.tf.wait_for(node)
        for pose in poses:
            stamp = self.next_stamp()
            self.tf.send(('liver_frame', 'breathing', pose, stamp))
            self.place('grasper', (axis, stamp))
            message = node.mesh_message(self.organ, SHEET, stamp)
            message.header.frame_id = 'breathing'
            node.meshes.publish(message)
            result = node.contacts.wait_for(self.organ, 'grasper', mesh_stamp=stamp)
        seen = [tuple(map(pose.inverse().apply, axis)) for pose in poses]
        self.assert_swept(result, SHEET, SHEET, seen)

    def test_through_the_sheet_and_back_within_a_millisecond(self):
        """The poses are at random times, between the node's regular samples of the motion."""
        chance, way_down = random.Random(5), oracle.swept_contacts(SHEET, ABOVE, BELOW, GRASPER)
        self.begin()
        for _ in range(12):
            times = sorted(chance.randrange(4 * 10**6, 5 * 10**6) for _ in range(3))
            self.place('grasper', *[(axis, self.stamp + rospy.Duration(0, nanoseconds))
                                    for axis, nanoseconds in zip((ABOVE, BELOW, ABOVE), times)])
            result = self.move(SHEET, ABOVE)
            self.assert_ok(result)
            self.assertEqual(faces_of(result), [c.face for c in way_down])
            for found, right in zip(result.contacts, way_down):
                touch = (times[0] + right.fraction * (times[1] - times[0])) / 1e7
                self.assertAlmostEqual(found.fraction, touch, delta=1e-6)

    def test_a_long_step_is_not_cut_short(self):
        """A second between two meshes has more samples than motion_samples_max. The stab in the middle is still
        found."""
        upright = lambda height: ((0.013, 0.007, 0.4), (0.013, 0.007, height))
        self.begin(axis=upright(0.05))
        heights = [0.05 - 0.1 * max(0.0, 1 - abs(i - 50) / 10) for i in range(100)]
        self.place('grasper', *[(upright(height), self.stamp + rospy.Duration(0, i * 10**7))
                                for i, height in enumerate(heights)])
        result = self.move(SHEET, upright(0.05), step=rospy.Duration(1))
        wait_until(lambda: any(key.endswith(' cut') and int(value) > 0 for key,
                               value in self.node.diagnostics.values.items()),
                   'a count of what was cut in /diagnostics')
        expected = oracle.swept_contacts(SHEET, upright(0.05), upright(-0.05), GRASPER)
        self.assertEqual(faces_of(result), [c.face for c in expected])
        for found, right in zip(result.contacts, expected):
            self.assertAlmostEqual(found.fraction, 0.4 + 0.1 * right.fraction, delta=0.02)

    def test_around_the_sheet_without_a_touch(self):
        """The straight line from start to end would pierce the sheet. A pose that comes after its step is counted."""
        way = [(0.013, 0.007, 0.05), (0.2, 0.007, 0.05), (0.2, 0.007, -0.05), (0.013, 0.007, -0.05)]
        axes = [((0.25, 0.007, p[2]), p) for p in way]
        self.begin(axis=axes[0])
        begin = self.stamp
        self.place('grasper', *[(axes[i], begin + rospy.Duration(0, i * 10**7)) for i in (1, 2)])
        result = self.move(SHEET, axes[3], step=rospy.Duration(0, 3 * 10**7))
        self.assert_contacts(result, [])
        self.assertGreater(len(oracle.swept_contacts(SHEET, axes[0], axes[3], GRASPER)), 0)
        before = self.node.diagnostics.count('transforms after their step')
        self.place('grasper', (BELOW, begin + rospy.Duration(0, 3 * 10**6)))
        self.node.diagnostics.wait_for_count('transforms after their step', before + 2)


if __name__ == '__main__':
    rospy.init_node('steps_test')
    rostest.rosrun('organ_collision', 'steps', StepsTest, sys.argv)
