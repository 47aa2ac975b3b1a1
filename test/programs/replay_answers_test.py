#!/usr/bin/python3
"""The answers of replay: those that the node would have given."""

import os
import re
import subprocess
import unittest

from organ_collision.msg import ContactArray
from support.scenes import box, Pose, sheet
from support.tool_over_sheet import SHEET, at_height, depth_at

from recording import Recording, ReplayCase, TOOLS

PAGE = os.path.join(os.environ['SOURCE'], 'doc', 'bags.md')
# rosrun is tested elsewhere (test/install/rosrun_test.py).
ROSRUN = 'rosrun() { test "$1 $2" = "organ_collision replay" && shift 2 && "$REPLAY" "$@"; }\n'
OK, NO_TRANSFORM = ContactArray.OK, ContactArray.NO_TRANSFORM
STATIC, SWEPT = ContactArray.STATIC, ContactArray.SWEPT
POSES = TOOLS.replace('tip_frame: hook_tip', 'tip_pose_topic: arm/measured_cp')


def seconds(answer):
    return answer.header.stamp.to_sec()


class ReplayAnswersTest(ReplayCase):
    def assert_times(self, answers, times):
        self.assertEqual([round(time, 6) for time, _ in answers], times)

    def test_each_step_is_answered(self):
        heights = [0.05, 0.02, -0.03, -0.01, 0.04]
        with self.record() as bag:
            bag.resting(1.0)
            bag.tool(2.0, at_height(heights[0]))
            bag.mesh(2.0, SHEET)
            for i, height in enumerate(heights[1:], 1):
                bag.tool(2.0 + 0.01 * i, at_height(height))
                bag.vertices(2.0 + 0.01 * i, SHEET)
        answers = [answer for _, answer in self.answers_of()]
        self.assertEqual([a.mode for a in answers], [STATIC] + 4 * [SWEPT])
        for answer, depth in zip(answers, (None, None, depth_at(-0.03))):
            self.assert_depth(answer, depth)
        self.assertEqual([len(a.contacts) > 0 for a in answers[3:]], [True, True])

    def test_a_transform_counts_until_its_time_is_over(self):
        """tf_timeout_sec is 20 ms of the bag's time."""
        with self.record() as bag:
            bag.resting(1.0)
            bag.mesh(2.0, SHEET)
            bag.vertices(2.0, SHEET)
            bag.tool(2.0, at_height(0.05), at=2.020)  # In time, though barely.
            bag.vertices(2.1, SHEET)
            bag.tool(2.1, at_height(0.04), at=2.121)
            bag.vertices(2.2, SHEET)
        answers = self.answers_of()
        self.assertEqual([answer.status for _, answer in answers], [OK, OK, NO_TRANSFORM, NO_TRANSFORM])
        self.assert_times(answers, [2.02, 2.02, 2.12, 2.22])
        late = answers[2][1].message
        self.assertIn("'hook_trocar'", late)
        self.assertIn('is 100 ms behind the stamp 2.100000000; waited 20 ms (tf_timeout_sec)', late)

    def test_messages_of_the_same_time_keep_their_order(self):
        """As in a recording in simulated time, whose clock stands still between ticks. The
        connection of the vertices is the first one in the bag."""
        with self.record() as bag:
            bag.vertices(0.0, SHEET, at=2.0)
            bag.resting(2.0)
            bag.tool(2.0, at_height(-0.01))
            bag.mesh(0.0, SHEET, at=2.0)
            bag.vertices(0.0, SHEET, at=2.0)
        answers = [answer for _, answer in self.answers_of()]
        self.assertEqual([a.status for a in answers], [ContactArray.UNKNOWN_ORGAN, OK, OK])
        self.assertEqual([len(a.contacts) > 0 for a in answers], [False, True, True])

    def test_a_mesh_of_another_connection_is_another_organ(self):
        """Two simulators, each with a latched mesh of the same topology number."""
        other = sheet(0.1, 3)
        with self.record() as bag:
            bag.resting(1.0)
            bag.tool(2.0, at_height(-0.01))
            bag.mesh(2.0, SHEET, publisher='/first')
            bag.mesh(2.0, other, publisher='/second')
            bag.tool(2.1, at_height(-0.02))
            bag.mesh(2.1, box(), publisher='/second')
        answers = [answer for _, answer in self.answers_of()]
        self.assertEqual([a.status for a in answers], [OK, OK, ContactArray.INVALID_REQUEST])
        self.assert_depth(answers[0], depth_at(-0.01))
        self.assertEqual(answers[1].mode, STATIC)
        self.assert_depth(answers[1], depth_at(-0.01))

    def assert_poses_are_steps(self, tools, pose_of):
        """A tip goes down through the sheet in three poses. pose_of(i, tip): that of pose i, with its turn."""
        with self.record() as bag:
            bag.resting(1.0)
            for time, at in ((1.0, 1.0), (2.5, 1.9)):
                bag.frame(time, 'hook_trocar', at_height(0.0)[0], at=at)
            bag.mesh(2.0, SHEET)
            for i, height in enumerate((0.05, 0.02, -0.03)):
                place, turn = pose_of(i, at_height(height)[1])
                bag.pose('/arm/measured_cp', 2.0 + 0.001 * i, place, turn=turn)
        answers = [answer for _, answer in self.answers_of(tools)]
        self.assertEqual([a.mode for a in answers], [STATIC, SWEPT, SWEPT])
        self.assert_depth(answers[2], depth_at(-0.03))

    def test_each_pose_is_a_step(self):
        self.assert_poses_are_steps(POSES, lambda _, tip: (tip, (0.0, 0.0, 0.0, 1.0)))

    def test_the_poses_of_a_marker_give_the_contacts_of_the_tip(self):
        """The marker turns from pose to pose. With small turns, the tip's way between two poses is straight."""
        offset = (0.02, -0.0132, 0.1746)

        def marker(i, tip):
            turn = Pose((0.1, 0.2, 0.3, 0.9 + 1e-6 * i), (0.0, 0.0, 0.0))
            return [a - b for a, b in zip(tip, turn.apply(offset))], turn.rotation

        self.assert_poses_are_steps(POSES.replace('radius', 'tip_offset: %s, radius' % list(offset)), marker)

    def test_ticks_count_in_the_time_of_the_bag(self):
        with self.record() as bag:
            bag.resting(1.0)
            bag.tool(1.0, at_height(0.05))
            bag.mesh(1.0, SHEET)
            bag.tool(1.105, at_height(0.05))
        answers = self.answers_of('rate: 100\n' + TOOLS)
        self.assertEqual(len(answers), 1 + 11)  # The shape, and a tick each 10 ms from 1.0 s on.
        self.assertTrue(all(answer.status == OK for _, answer in answers))

    def test_few_answers_are_explained(self):
        """A tool moves on TF beside an organ at rest, and the yaml file has no rate, which was an argument of the launch
        file. Poses on a topic are answered."""
        with self.record() as bag:
            bag.resting(1.0)
            bag.tool(1.0, at_height(0.05))
            bag.mesh(1.0, SHEET)
            for i in range(1, 11):
                bag.tool(1.0 + 0.01 * i, at_height(0.05 - 0.001 * i))
        for rate, answers, lines in ('', 1, 1), ('rate: 0\n', 1, 1), ('rate: 100\n', 11, 0):
            done = self.replay(rate + TOOLS)
            self.assertIn('%d answers on /organ_collision/contacts: %d ok' % (answers, answers), done.stdout)
            self.assertEqual(len(done.stderr.splitlines()), lines, done.stderr)
            for word in ('parameters.yaml has no rate above 0', 'the 11 messages on /tf', 'rate: 100') * lines:
                self.assertIn(word, done.stderr)


class SimulatedTimeTest(ReplayCase):
    """A bag with /clock is replayed in the time of /clock."""

    def test_transforms_are_awaited_in_simulated_time(self):
        """The recorder is ten times slower than the simulator, or faster."""
        for speed in (0.1, 10.0):
            with self.record() as bag:
                for i in range(30):
                    time, at = 5.0 + 0.01 * i, 1000.0 + 0.01 * i / speed
                    bag.clock(time, at)
                    if i == 0:
                        bag.resting(at)
                        bag.tool(time, at_height(0.05), at)
                        bag.mesh(time, SHEET, at)
                    if i == 10:
                        bag.vertices(time, SHEET, at)
                    if i == 12:  # 20 ms later: in time.
                        bag.tool(time, at_height(0.04), at)
                    if i == 20:
                        bag.vertices(time, SHEET, at)
                    if i == 23:
                        bag.tool(time, at_height(0.03), at)
            answers = self.answers_of()
            self.assertEqual([answer.status for _, answer in answers], [OK, OK, NO_TRANSFORM])
            for i, (time, _) in zip((0, 12, 23), answers):
                self.assertAlmostEqual(time, 1000.0 + 0.01 * i / speed, places=6)

    def test_messages_before_the_first_clock(self):
        with self.record() as bag:
            bag.resting(1000.0)
            bag.mesh(5.0, SHEET, 1000.0)
            bag.clock(5.0, 1001.0)
            bag.clock(5.01, 1001.01)
            bag.tool(5.0, at_height(-0.01), 1001.01)
        ((time, answer),) = self.answers_of()
        self.assert_depth(answer, depth_at(-0.01))
        self.assertAlmostEqual(time, 1001.01)

    def check_jump(self, answers):
        # rosbag returns them in the order of time.
        answers = sorted(answers, key=lambda answer: answer.header.stamp.to_sec() < 10.0)
        self.assertEqual([a.mode for a in answers], [STATIC, SWEPT, STATIC, SWEPT])
        self.assert_depth(answers[2], depth_at(-0.01))
        self.assertGreater(len(answers[3].contacts), 0)

    def test_a_jump_of_the_clock_forgets_the_history(self):
        with self.record() as bag:
            bag.resting(100.0)
            for i, time in enumerate((50.0, 50.1, 7.0, 7.1)):
                at = 100.0 + 0.1 * i
                bag.clock(time, at)
                bag.tool(time, at_height((0.05, 0.04, -0.01, 0.05)[i]), at)
                (bag.vertices if i % 2 else bag.mesh)(time, SHEET, at)
        self.check_jump([answer for _, answer in self.answers_of()])

    def test_a_jump_of_the_recorders_time_forgets_the_history(self):
        """The recorder was in simulated time, and did not record /clock."""
        with self.record() as bag:
            bag.resting(50.0)
            for i, time in enumerate((50.0, 50.1, 7.0, 7.1)):
                bag.tool(time, at_height((0.05, 0.04, -0.01, 0.05)[i]))
                (bag.vertices if i % 2 else bag.mesh)(time, SHEET)
        self.check_jump([answer for _, answer in self.answers_of()])

    def test_a_recorder_with_several_threads_is_no_jump(self):
        with self.record() as bag:
            bag.resting(1.0)
            bag.tool(2.0, at_height(0.05), at=2.001)
            bag.mesh(2.0, SHEET, at=2.0)
            bag.tool(2.1, at_height(0.04), at=2.101)
            bag.vertices(2.1, SHEET, at=2.1)
        self.assertEqual([answer.mode for _, answer in self.answers_of()], [STATIC, SWEPT])


class BagsPageTest(ReplayCase):
    def test_the_commands_for_replay_on_the_page_work_as_they_stand(self):
        with open(PAGE, encoding='utf-8') as page:
            blocks = re.findall(r'```bash\n(.*?)```', page.read(), re.S)
        (commands,) = [block for block in blocks if 'rosrun organ_collision replay' in block]
        self.write('tools.yaml', TOOLS)
        with Recording(self.path('surgery.bag')) as bag:
            bag.resting(1.0)
            bag.tool(2.0, at_height(-0.01))
            bag.mesh(2.0, SHEET)
        done = subprocess.run(['bash', '-e', '-c', ROSRUN + commands], cwd=self.folder, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=100)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn('1 answers on /organ_collision/contacts: 1 ok', done.stdout)
        self.assertIn('tool: "hook"', done.stdout)


if __name__ == '__main__':
    unittest.main(verbosity=2)
