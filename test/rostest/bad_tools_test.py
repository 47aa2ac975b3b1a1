#!/usr/bin/python3
"""Tools that cannot be loaded. Every answer about them says so, and the other tools still work."""

import sys

from organ_collision.msg import ContactArray
import rospy
import rostest

from support import oracle, scenes
from support.link_case import LinkCase, ball_contacts
from support.node_client import wait_until

SHEET = scenes.sheet(0.1, 4).moved(lambda v: (v[0], v[1], v[2] + 0.1 * v[0]))
SHAFT, BALL = 0.005, 0.006  # [m] radii
# The words that each bad tool's message must contain: what is wrong, and where.
FAULTS = {
    'unknown_link': ["'robots/ball'", "'bal' is unknown", "nearest is 'ball'"],
    'no_geometry': ["'robots/ball'", "'base'", 'no collision or visual geometry'],
    'mesh_missing': ["'robots/meshes'", "'missing'", '/no_such.stl'],
    'mesh_broken': ["'robots/meshes'", "'broken'", 'tools/broken.stl'],
    'mesh_flat': ["'robots/meshes'", "'flat'", 'tools/jaw.obj', 'scale is 1 0 1'],
    'mesh_remote': ["'robots/meshes'", "'remote'", 'http://192.0.2.1/jaw.stl', 'file://'],
    'two_roots': ["'robots/two_roots'", 'root', '[left]', '[right]'],
    'malformed': ["'robots/malformed'", 'no legal URDF'],
    'no_description': ["'robots/none'", 'is set neither in /organ_collision nor'],
    'no_file': ["'/no/such.urdf'", 'no such file'],
    'bad_beside_shaft': ["'robots/ball'", "'bal' is unknown"],
}


def shaft_at(height):
    return ((0.02, -0.03, 0.3), (0.011, 0.006, height))


def ball_at(height):
    return ((-0.023, 0.017, height),)


class BadToolsTest(LinkCase):
    link_frames = {'ball': ('ball',), 'silent': ('silent/ball',)}

    def assert_fault(self, tool, result):
        self.assertEqual(result.status, ContactArray.INVALID_TOOL, tool)
        self.assertEqual(result.contacts, [])
        for word in [tool + ': '] + FAULTS[tool]:
            self.assertIn(word, result.message)

    def published(self, tool):
        """The messages that the node published about the last step's shape."""
        return self.node.contacts.wait_for(self.organ, tool, mesh_stamp=self.stamp)

    def check_step(self, before, after):
        """Moves the tools from one height to the next. Checks that the good tools touch, and that
        all bad ones say what is wrong."""
        tools = {'hook': shaft_at(after), 'ball': ball_at(after)}
        results = self.step(SHEET, tools, vertices=True)
        shaft = oracle.swept_contacts(SHEET, shaft_at(before), shaft_at(after), SHAFT)
        ball = ball_contacts(SHEET, ball_at(before), ball_at(after), BALL)
        self.assertGreater(min(len(shaft), len(ball)), 0)
        self.assert_contacts(results['hook'], shaft, 1e-6)
        self.assert_contacts(results['ball'], ball, 1e-6)
        for tool in FAULTS:
            self.assert_fault(tool, self.published(tool))

    def test_good_tools_touch_and_bad_ones_say_what_is_wrong(self):
        self.step(SHEET, {'hook': shaft_at(0.05), 'ball': ball_at(0.05)})
        heights = [0.05, -0.02, 0.003, -0.04, 0.05]
        for before, after in zip(heights, heights[1:]):
            self.check_step(before, after)
        self.assertEqual(self.published('ball').links, ['ball'])
        self.assertEqual(self.published('unknown_link').links, ['ball', 'bal'])
        self.assertEqual(self.published('bad_beside_shaft').links, ['', 'bal'])

    def test_the_services_say_the_same(self):
        self.step(SHEET, {'hook': shaft_at(0.003), 'ball': ball_at(0.003)})
        for mode in (ContactArray.STATIC, ContactArray.SWEPT):
            for tool in FAULTS:
                self.assert_fault(tool, self.node.query(self.organ, tool=tool, mode=mode))
        for tool in ('hook', 'ball'):
            result = self.node.query(self.organ, tool=tool)
            self.assert_ok(result)
            self.assertGreater(len(result.contacts), 0)

    def test_a_joint_that_nobody_publishes_and_then_somebody_does(self):
        self.step(SHEET, {'hook': shaft_at(0.003), 'ball': ball_at(0.003)})
        for result in (self.published('silent'), self.node.query(self.organ, tool='silent')):
            self.assertEqual(result.status, ContactArray.NO_TRANSFORM)
            self.assertEqual(result.contacts, [])
            for word in ("link 'ball'", "tool 'silent'", "joint 'wrist'", 'silent/ball'):
                self.assertIn(word, result.message)
        result = self.step(SHEET, {'silent': ball_at(0.003)}, vertices=True)['silent']
        self.assertEqual(result.mode, ContactArray.STATIC)
        self.assert_contacts(result, ball_contacts(SHEET, ball_at(0.003), ball_at(0.003), BALL))

    def test_diagnostics_say_what_is_wrong(self):
        self.step(SHEET, {'hook': shaft_at(0.05), 'ball': ball_at(0.05)})
        wait_until(lambda: 'tools' in self.node.summaries, '/diagnostics')
        for tool, words in FAULTS.items():
            for word in [tool + ': '] + words:
                self.assertIn(word, self.node.summaries['tools'])
        for tool, links in (('ball', '1'), ('malformed', '0')):
            self.assertEqual(self.node.diagnostics[tool + ', links'], links)
        self.assertEqual(self.node.diagnostics['hook, radius of the shaft [m]'], '0.005')

        def counted():
            failures = int(self.node.diagnostics.get('unanswered, invalid tool', 0))
            return failures >= len(FAULTS)

        wait_until(counted, lambda: self.node.diagnostics)


if __name__ == '__main__':
    rospy.init_node('bad_tools_test')
    rostest.rosrun('organ_collision', 'bad_tools', BadToolsTest, sys.argv)
