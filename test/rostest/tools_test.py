#!/usr/bin/python3
"""Links that move between two shapes of the organ: along the arc of all poses in TF, with a tf_prefix, together with a
shaft. Tools that cannot be loaded: every answer about them says so, and the other tools still work."""

import math
import sys

from organ_collision.msg import ContactArray
import roslib.packages
import rospy
import rostest

from support import oracle, scenes
from support.contact_case import KeepsContract, xyz
from support.rigid_mesh import RigidMesh
from support.tool_case import ToolCase, WORLD_LIVER, ball_contacts
from support.vectors import length, sub

STATIC, SWEPT = ContactArray.STATIC, ContactArray.SWEPT
SHEET = scenes.sheet(0.1, 6)
ARM = (0.05, 0.0, 0.0)  # [m] from the joint to the ball's centre and the jaw's origin
SMALL, LARGE, SHAFT = 0.003, 0.006, 0.005  # [m] radii: pendulum's ball, hook's ball and shaft
SHARES = [i / 300 for i in range(301)]  # shares of a step at which the test samples an arc
CLOSE = 3e-4  # [m] more than half of the distance that the ball moves between two samples
JAW_MESH = RigidMesh.from_stl(
    roslib.packages.get_pkg_dir('organ_collision') + '/test/data/tools/jaw_binary.stl', unit=0.001)
# The hook's trocar, tip and ball [m].
ABOVE = ((0.02, -0.03, 0.3), (0.011, 0.006, 0.05), (-0.013, 0.017, 0.04))
BELOW = ((0.05, -0.01, 0.28), (0.004, -0.003, -0.04), (-0.003, -0.011, -0.03))
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


class Swing:
    """The motion of a pendulum: its joint in the organ's frame, and its angle [deg] at shares of a step. The angle is 0
    along x and rises towards z."""

    def __init__(self, joint, *way):
        self.joint, self.way = joint, way

    @staticmethod
    def turn(angle):
        half = math.radians(-angle / 2)
        return (0.0, math.sin(half), 0.0, math.cos(half))

    def pose(self, share):
        """The pose of the links in the organ's frame. The angle is interpolated linearly, as in TF."""
        (start, first), (stop, last) = next(p for p in zip(self.way, self.way[1:]) if share <= p[1][0])
        return scenes.Pose(self.turn(first + (last - first) * (share - start) / (stop - start)), self.joint)

    def ball(self, share):
        return self.pose(share).apply(ARM)

    def jaw(self, share):
        pose = self.pose(share)
        return JAW_MESH.at(scenes.Pose(pose.rotation, pose.apply(ARM)))

    def chord(self):
        """The faces that the ball would touch on the straight line from start to end."""
        return {c.face for c in ball_contacts(SHEET, (self.ball(0),), (self.ball(1),), SMALL)}

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
        return set().union(*[self.jaw(share).faces_pierced(SHEET) for share in SHARES[::3]])


# Up through the sheet, over it and down again. The straight line stays below it.
OVER = Swing((0.003, 0.007, -0.035), (0, 150), (0.2, 140), (0.45, 95), (0.7, 60), (1, 25))
# Up through the sheet once, at another place than the straight line.
UP = Swing((-0.02, 0.007, 0.002), (0, -65), (0.3, -40), (0.6, 5), (0.8, 30), (1, 60))


class ToolsTest(KeepsContract, ToolCase):
    link_frames = {'hook': ('hook_trocar', 'hook_tip', 'hook/ball'), 'silent': ('silent/ball',)}

    def send(self, tool, swing, begin, end):
        """Sends the transforms of a pendulum's motion between two times."""
        mount = scenes.Pose(WORLD_LIVER.rotation, WORLD_LIVER.apply(swing.joint))
        self.tf.send_resting(('world', tool + '/mount', mount), (tool + '/ball', tool + '/jaw', scenes.IDENTITY))
        self.tf.send(*[(tool + '/mount', tool + '/ball', scenes.Pose(swing.turn(angle), (0.0, 0.0, 0.0)),
                        begin + (end - begin) * share) for share, angle in swing.way])

    def check_ball(self, contacts, swing):
        """Exactly the faces that the ball touches are found, at the right time and place."""
        touches = swing.ball_touches()
        self.assertGreater(len(touches), 0)
        self.assertEqual([c.face for c in contacts], sorted(touches))
        for contact in contacts:
            latest = touches[contact.face]
            self.assertTrue(latest - SHARES[1] - 1e-4 < contact.fraction < latest + 1e-4, contact)
            on_face = oracle.weighted(SHEET.face(contact.face), contact.barycentric)
            self.assert_near(xyz(contact.point), on_face, 1e-7, contact)
            self.assertAlmostEqual(length(sub(on_face, swing.ball(contact.fraction))), SMALL, delta=1e-5, msg=contact)

    def check_jaw(self, contacts, swing):
        """Each face which the jaw's edges pierce is found, and the jaw touches each face that is found."""
        pierced = swing.jaw_pierces()
        self.assertGreater(len(pierced), 0)
        self.assertEqual(pierced - {c.face for c in contacts}, set())
        for contact in contacts:
            self.assertLess(swing.jaw(contact.fraction).distance(xyz(contact.point)), 1e-5, contact)

    def test_two_robots_of_one_description_swing(self):
        """Each robot is where the frames with its prefix are. It touches what the straight way from start to end
        misses, and nothing at either end."""
        swings = {'left': OVER, 'right': UP}
        self.assertEqual(OVER.chord(), set())
        self.assertGreater(len(UP.chord()), 0)
        self.assertEqual(UP.chord() & set(UP.ball_touches()), set())
        begin, end = self.next_stamp(), self.next_stamp(rospy.Duration(0, 10**8))
        for tool, swing in swings.items():
            self.send(tool, swing, begin, end)
        self.node.send_mesh(self.organ, SHEET, begin)
        for tool in swings:
            first = self.node.contacts.wait_for(self.organ, tool, mesh_stamp=begin)
            self.assertEqual((first.mode, first.contacts, first.links), (STATIC, [], ['jaw', 'ball']))
        self.node.send_vertices(self.organ, SHEET, end)
        for tool, swing in swings.items():
            result = self.node.contacts.wait_for(self.organ, tool, mesh_stamp=end)
            self.assert_ok(result)
            self.assertEqual((result.mode, result.step_start), (SWEPT, begin))
            self.assert_contacts(self.node.query(self.organ, tool=tool, stamp=end), [])
            self.check_jaw([c for c in result.contacts if c.link == 0], swing)
            self.check_ball([c for c in result.contacts if c.link == 1], swing)

    def test_a_shaft_and_a_link(self):
        """Both touch; the shaft's trocar moves, too."""
        first = self.step(SHEET, {'hook': ABOVE})['hook']
        self.assert_contacts(first, [])
        result = self.step(SHEET, {'hook': BELOW}, vertices=True)['hook']
        self.assertEqual((result.mode, result.step_start, result.links), (SWEPT, first.header.stamp, ['', 'ball']))
        shaft = oracle.swept_contacts(SHEET, ABOVE[:2], BELOW[:2], SHAFT)
        ball = ball_contacts(SHEET, ABOVE[2:], BELOW[2:], LARGE)
        self.assertGreater(min(len(shaft), len(ball)), 0)
        self.assert_contacts_of_link(result, 0, shaft, 1e-6)
        self.assert_contacts_of_link(result, 1, ball, 1e-6)
        order = [(c.face, c.link) for c in result.contacts]
        self.assertEqual(order, sorted(order))

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
        self.assertEqual(self.node.contacts.of(self.organ, 'unknown_link')[0].links, ['ball', 'bal'])
        self.assertEqual(self.node.contacts.of(self.organ, 'bad_beside_shaft')[0].links, ['', 'bal'])
        self.node.diagnostics.wait_for_count('unanswered, invalid tool', len(FAULTS))
        for key, value in (('hook, links', '1'), ('malformed, links', '0'), ('hook, radius of the shaft [m]', '0.005')):
            self.assertEqual(self.node.diagnostics.values[key], value)

    def test_a_joint_that_nobody_publishes_and_then_somebody_does(self):
        self.step(SHEET, {'hook': ABOVE})
        published = self.node.contacts.wait_for(self.organ, 'silent', mesh_stamp=self.stamp)
        for result in (published, self.node.query(self.organ, tool='silent')):
            self.assertEqual((result.status, result.contacts), (ContactArray.NO_TRANSFORM, []))
            for word in ("link 'ball'", "tool 'silent'", "joint 'wrist'", 'silent/ball'):
                self.assertIn(word, result.message)
        place = ((-0.023, 0.017, 0.003),)
        result = self.step(SHEET, {'silent': place}, vertices=True)['silent']
        self.assertEqual(result.mode, STATIC)
        self.assert_contacts(result, ball_contacts(SHEET, place, place, LARGE))


if __name__ == '__main__':
    rospy.init_node('tools_test')
    rostest.rosrun('organ_collision', 'tools', ToolsTest, sys.argv)
