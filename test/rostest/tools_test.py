#!/usr/bin/python3
"""Links that move between two shapes of the organ: along all poses in TF, with a tf_prefix, together with a shaft. Tools
that cannot be loaded: every answer about them says so, and the other tools still work."""

import sys

from organ_collision.msg import ContactArray
import rospy
import rostest

from support.contact_case import KeepsContract
from support.tool_case import ToolCase
from support.tool_over_sheet import SHEET, at_height, depth_at

STATIC, SWEPT = ContactArray.STATIC, ContactArray.SWEPT
BALL = 0.006  # [m] radius
# The hook's trocar, tip and ball [m].
ABOVE = (*at_height(0.05), (-0.013, 0.017, 0.04))
BELOW = (*at_height(-0.04), (-0.013, 0.017, -0.03))
# The words that each bad tool's message must contain: what is wrong, and where.
FAULTS = {
    'mesh_missing': ["'robots/mesh'", "'missing'", '/no_such.stl'],
    'no_description': ["'robots/none'", 'is set neither in /organ_collision nor'],
    'bad_beside_shaft': ["'robots/ball'", "'bal' is unknown", "nearest is 'ball'"],
}


class ToolsTest(KeepsContract, ToolCase):
    link_frames = {'hook': ('hook_trocar', 'hook_tip', 'hook/ball'), 'left': ('left/ball',), 'right': ('right/ball',)}

    def test_two_robots_of_one_description(self):
        """Each robot is where the frames with its prefix are. Before they are published, every answer says so. The left
        ball goes down through the sheet and up again within a step, which begins and ends above it."""
        self.step(SHEET, {'hook': ABOVE})
        published = self.node.contacts.wait_for(self.organ, 'left', mesh_stamp=self.stamp)
        for result in (published, self.node.query(self.organ, tool='left')):
            self.assertEqual((result.status, result.contacts), (ContactArray.NO_TRANSFORM, []))
            for word in ("link 'ball'", "tool 'left'", "joint 'wrist'", 'left/ball'):
                self.assertIn(word, result.message)
        high, low, aside = (at_height(0.04)[1:], at_height(-0.05)[1:], ((-0.03, -0.02, 0.03),))
        first = self.step(SHEET, {'left': high, 'right': aside}, vertices=True)
        for result in first.values():
            self.assertEqual((result.mode, result.links), (STATIC, ['ball']))
            self.assert_depth(result, None)
        self.place('left', (low, self.stamp + rospy.Duration(0, 4 * 10**6)))
        second = self.step(SHEET, {'left': high, 'right': aside}, vertices=True)
        self.assertEqual((second['left'].mode, second['left'].step_start), (SWEPT, first['left'].header.stamp))
        self.assert_ok(second['left'])
        # It is down after 4 ms of 10 ms, and touches when its centre is one radius above the sheet.
        self.assertAlmostEqual(min(c.fraction for c in second['left'].contacts), 0.4 * (0.04 - BALL) / 0.09, delta=1e-6)
        self.assert_depth(second['right'], None)

    def test_bad_tools_say_what_is_wrong_in_each_answer(self):
        """In those to steps and queries, and on /diagnostics."""
        self.step(SHEET, {'hook': ABOVE})
        for tool, words in FAULTS.items():
            published = self.node.contacts.wait_for(self.organ, tool, mesh_stamp=self.stamp)
            for result in (published, *(self.node.query(self.organ, tool=tool, mode=mode) for mode in (STATIC, SWEPT))):
                self.assertEqual((result.status, result.contacts), (ContactArray.INVALID_TOOL, []), tool)
                for word in [tool + ': '] + words:
                    self.assertIn(word, result.message)
            self.node.diagnostics.wait_for_summary('tools', tool + ': ', *words)
        self.assertEqual(self.node.contacts.of(self.organ, 'bad_beside_shaft')[0].links, ['bal'])
        self.node.diagnostics.wait_for_count('unanswered, invalid tool', len(FAULTS))
        for key, value in (('hook, links', '1'), ('no_description, links', '0'),
                           ('hook, radius of the shaft [m]', '0.005')):
            self.assertEqual(self.node.diagnostics.values[key], value)


if __name__ == '__main__':
    rospy.init_node('tools_test')
    rostest.rosrun('organ_collision', 'tools', ToolsTest, sys.argv)
