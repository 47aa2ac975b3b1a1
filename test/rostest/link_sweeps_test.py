#!/usr/bin/python3
"""Links that move between two shapes of the organ: along the arc of all poses in TF, with a
tf_prefix, together with a shaft, and after a reset."""

import math
import sys

from organ_collision.msg import ContactArray
import roslib.packages
import rospy
import rostest

from support import oracle, scenes
from support.contact_case import xyz
from support.contract import KeepsContract
from support.link_case import LinkCase, ball_contacts
from support.rigid_mesh import RigidMesh
from support.tool_case import WORLD_LIVER
from support.vectors import length, sub

STATIC, SWEPT = ContactArray.STATIC, ContactArray.SWEPT
SHEET = scenes.sheet(0.1, 6)
ARM = (0.05, 0.0, 0.0)  # [m] from the joint to the ball's centre and the jaw's origin
SMALL, LARGE, SHAFT = 0.003, 0.006, 0.005  # [m] radii: pendulum's ball, hook's ball and shaft
SHARES = [i / 300 for i in range(301)]  # shares of a step at which the test samples an arc
CLOSE = 3e-4  # [m] more than half of the distance that the ball moves between two samples
JAW_MESH = RigidMesh.from_stl(
    roslib.packages.get_pkg_dir('organ_collision') + '/test/data/tools/jaw_binary.stl', unit=0.001
)
# The hook's trocar, tip and ball [m].
ABOVE = ((0.02, -0.03, 0.3), (0.011, 0.006, 0.05), (-0.013, 0.017, 0.04))
BELOW = ((0.05, -0.01, 0.28), (0.004, -0.003, -0.04), (-0.003, -0.011, -0.03))
INSIDE = BELOW[:2] + ((-0.003, -0.011, 0.004),)


class Swing:
    """The motion of a pendulum: its joint in the organ's frame, and its angle [deg] at shares of a
    step. The angle is 0 along x and rises towards z."""

    def __init__(self, joint, *way):
        self.joint, self.way = joint, way

    @staticmethod
    def turn(angle):
        half = math.radians(-angle / 2)
        return (0.0, math.sin(half), 0.0, math.cos(half))

    def angle(self, share):
        """The angle at a share of the step, interpolated linearly as in TF."""
        pieces = zip(self.way, self.way[1:])
        (start, first), (stop, last) = next(p for p in pieces if share <= p[1][0])
        return first + (last - first) * (share - start) / (stop - start)

    def pose(self, share):
        """The pose of the links in the organ's frame."""
        return scenes.Pose(self.turn(self.angle(share)), self.joint)

    def ball(self, share):
        return self.pose(share).apply(ARM)

    def jaw(self, share):
        pose = self.pose(share)
        return JAW_MESH.at(scenes.Pose(pose.rotation, pose.apply(ARM)))

    def chord(self):
        """The contacts that the ball would have on the straight line from start to end."""
        return ball_contacts(SHEET, (self.ball(0),), (self.ball(1),), SMALL)

    def ball_touches(self):
        """{face: the first of SHARES at which the ball touches it}."""
        centres = [self.ball(share) for share in SHARES]
        touches = {}
        for number in range(len(SHEET.faces)):
            gaps = [oracle.nearest((c, c), SHEET.face(number)).distance - SMALL for c in centres]
            assert not -1e-5 < min(gaps) < CLOSE, 'SHARES cannot tell of face %d' % number
            if min(gaps) < 0:
                touches[number] = next(s for s, gap in zip(SHARES, gaps) if gap < 0)
        return touches

    def jaw_pierces(self):
        """The faces that an edge of the jaw pierces."""
        return set().union(*[self.jaw(share).faces_pierced(SHEET) for share in SHARES])


# Up through the sheet, over it and down again. The straight line stays below it.
OVER = Swing((0.003, 0.007, -0.035), (0, 150), (0.2, 140), (0.45, 95), (0.7, 60), (1, 25))
# Up through the sheet once, at another place than the straight line.
UP = Swing((-0.02, 0.007, 0.002), (0, -65), (0.3, -40), (0.6, 5), (0.8, 30), (1, 60))


class LinkSweepsTest(KeepsContract, LinkCase):
    link_frames = {'hook': ('hook_trocar', 'hook_tip', 'hook/ball')}

    def send(self, tool, swing, begin, end):
        """Sends the transforms of a pendulum's motion between two times."""
        mount = scenes.Pose(WORLD_LIVER.rotation, WORLD_LIVER.apply(swing.joint))
        self.tf.send_resting(
            ('world', tool + '/mount', mount), (tool + '/ball', tool + '/jaw', scenes.IDENTITY)
        )
        for share, angle in swing.way:
            pose = scenes.Pose(swing.turn(angle), (0.0, 0.0, 0.0))
            stamp = begin + (end - begin) * share
            self.tf.send((tool + '/mount', tool + '/ball', pose, stamp))

    def swept(self, **swings):
        """{tool: answer} about a step in which each pendulum swings. Checks that no tool touches
        anything at either end of the step."""
        begin = self.next_stamp()
        end = self.next_stamp(rospy.Duration(0, 10**8))
        for tool, swing in swings.items():
            self.send(tool, swing, begin, end)
        self.node.send_mesh(self.organ, SHEET, begin)
        for tool in swings:
            first = self.node.contacts.wait_for(self.organ, tool, mesh_stamp=begin)
            self.assertEqual(first.mode, STATIC)
            self.assert_contacts(first, [])
        self.node.send_vertices(self.organ, SHEET, end)
        results = {}
        for tool in swings:
            results[tool] = self.node.contacts.wait_for(self.organ, tool, mesh_stamp=end)
            self.assertEqual((results[tool].mode, results[tool].step_start), (SWEPT, begin))
            self.assert_contacts(self.node.query(self.organ, tool=tool, stamp=end), [])
        return results

    def check_ball(self, contacts, swing):
        """Checks that exactly the faces that the ball touches are found, at the right time and
        place."""
        touches = swing.ball_touches()
        self.assertGreater(len(touches), 0)
        self.assertEqual([c.face for c in contacts], sorted(touches))
        for contact in contacts:
            what = 'face %d' % contact.face
            latest = touches[contact.face]
            self.assertLess(contact.fraction, latest + 1e-4, what)
            self.assertGreater(contact.fraction, latest - SHARES[1] - 1e-4, what)
            on_face = oracle.weighted(SHEET.face(contact.face), contact.barycentric)
            self.assert_near(xyz(contact.point), on_face, 1e-7, what)
            distance = length(sub(on_face, swing.ball(contact.fraction)))
            self.assertAlmostEqual(distance, SMALL, delta=1e-5, msg=what)

    def check_jaw(self, contacts, swing):
        """Checks that each face which the jaw's edges pierce is found, and that the jaw touches
        each face that is found."""
        pierced = swing.jaw_pierces()
        self.assertGreater(len(pierced), 0)
        self.assertEqual(pierced - {c.face for c in contacts}, set())
        for contact in contacts:
            what = 'face %d' % contact.face
            self.assertLess(swing.jaw(contact.fraction).distance(xyz(contact.point)), 1e-5, what)

    def check_swing(self, result, swing):
        self.assert_ok(result)
        self.assertEqual(result.links, ['jaw', 'ball'])
        self.check_jaw([c for c in result.contacts if c.link == 0], swing)
        self.check_ball([c for c in result.contacts if c.link == 1], swing)

    def test_an_arc_over_what_the_straight_way_misses(self):
        self.assertEqual(OVER.chord(), [])
        self.check_swing(self.swept(left=OVER)['left'], OVER)

    def test_an_arc_elsewhere_than_the_straight_way(self):
        straight = {c.face for c in UP.chord()}
        self.assertGreater(len(straight), 0)
        self.assertEqual(straight & set(UP.ball_touches()), set())
        self.check_swing(self.swept(right=UP)['right'], UP)

    def test_two_robots_of_one_description(self):
        """Each robot is where the frames with its prefix are."""
        results = self.swept(left=OVER, right=UP)
        self.check_swing(results['left'], OVER)
        self.check_swing(results['right'], UP)

    def check_hook(self, result, before, after):
        """Checks that both the ball and the shaft touch; the shaft's trocar moves, too."""
        self.assertEqual(result.links, ['', 'ball'])
        shaft = oracle.swept_contacts(SHEET, before[:2], after[:2], SHAFT)
        ball = ball_contacts(SHEET, before[2:], after[2:], LARGE)
        self.assertGreater(min(len(shaft), len(ball)), 0)
        self.assert_contacts_of_link(result, 0, shaft, 1e-6)
        self.assert_contacts_of_link(result, 1, ball, 1e-6)
        self.assertEqual(len(result.contacts), len(shaft) + len(ball))
        order = [(c.face, c.link) for c in result.contacts]
        self.assertEqual(order, sorted(order))

    def test_a_shaft_and_a_link(self):
        first = self.step(SHEET, {'hook': ABOVE})['hook']
        self.assertEqual((first.mode, first.links), (STATIC, ['', 'ball']))
        self.assert_contacts(first, [])
        second = self.step(SHEET, {'hook': BELOW}, vertices=True)['hook']
        self.assertEqual((second.mode, second.step_start), (SWEPT, first.header.stamp))
        self.check_hook(second, ABOVE, BELOW)

    def test_reset_forgets_where_links_were(self):
        self.step(SHEET, {'hook': ABOVE})
        self.node.reset()
        result = self.step(SHEET, {'hook': INSIDE}, vertices=True)['hook']
        self.assertEqual((result.mode, result.step_start), (STATIC, result.header.stamp))
        self.check_hook(result, INSIDE, INSIDE)


if __name__ == '__main__':
    rospy.init_node('link_sweeps_test')
    rostest.rosrun('organ_collision', 'link_sweeps', LinkSweepsTest, sys.argv)
