#!/usr/bin/python3
"""replay: the answers that the node would have given, and one line for what cannot be replayed."""

import multiprocessing.pool
import os
import random
import re
import shutil
import subprocess
import unittest

from organ_collision.msg import ContactArray, OrganVertices
from std_msgs.msg import String
from support.scenes import sheet
from support.tool_over_sheet import SHEET, at_height

from recording import Recording, ReplayCase, TOOLS, messages, serialized

PAGE = os.path.join(os.environ['SOURCE'], 'doc', 'bags.md')
GRIPPER = os.path.join(os.environ['TEST_DATA'], 'tools', 'gripper.urdf')
# rosrun is tested elsewhere (test/install/rosrun_test.py).
ROSRUN = 'rosrun() { test "$1 $2" = "organ_collision replay" && shift 2 && "$REPLAY" "$@"; }\n'
OK, NO_TRANSFORM = ContactArray.OK, ContactArray.NO_TRANSFORM
STATIC, SWEPT = ContactArray.STATIC, ContactArray.SWEPT
LINKS = 'tools:\n  - {name: grip, links: [wrist, jaw]%s}\n'
LARGE = sheet(0.1, 80)  # 12 800 faces: the pipeline builds it in a thread of its own.


class AnswersTest(ReplayCase):

    def test_a_transform_counts_until_its_time_is_over(self):
        """tf_timeout_sec is 20 ms of the bag's time, which is that of /clock if it is there. The recorder is then ten times
        slower than the simulator, or faster."""
        for speed in None, 0.1, 10.0:
            at = lambda time: time if speed is None else 1000.0 + (time - 2.0) / speed
            with self.record() as bag:
                bag.resting(at(1.0))
                for tick in range(24):
                    time = 2.0 + 0.01 * tick
                    if speed is not None:
                        bag.clock(time, at(time))
                    for shape, tool, height in ((0, 2, 0.05), (10, 13, 0.04), (20, None, 0.03)):
                        if tick == shape:
                            (bag.vertices if shape else bag.mesh)(time, SHEET, at(time))
                        if tick == tool:
                            bag.tool(2.0 + 0.01 * shape, at_height(height), at(time))
            answers = self.answers_of()
            self.assertEqual([answer.status for _, answer in answers], [OK, NO_TRANSFORM, NO_TRANSFORM])
            self.assertIn("is 100 ms behind the stamp 2.100000000; waited 20 ms (tf_timeout_sec)", answers[1][1].message)
            for tick, (time, _) in zip((2, 12 if speed is None else 13), answers):
                self.assertAlmostEqual(time, at(2.0 + 0.01 * tick), places=6)

    def test_the_same_bytes_alone_and_beside_others(self):
        """Shapes at 1 kHz, whose transforms come up to 30 ms late and in disorder; some never come. Large meshes with new
        triangles come between them."""
        chance, events, steps = random.Random(1), [], 120
        for step in range(steps):
            time = 2.0 + 0.001 * step
            if step % 10 != 5:
                events.append((time + (chance.uniform(0.0, 0.03) if step % 50 else 0.0), 'tool', step))
            events.append((time, 'mesh' if step % 40 == 0 else 'vertices', step))
        with self.record() as bag:
            bag.resting(1.0)
            for at, kind, step in sorted(events):
                time = 2.0 + 0.001 * step
                if kind == 'tool':
                    bag.tool(time, at_height(0.02 + 0.04 * (1 if step % 7 < 3 else -1) + 0.0001 * step), at)
                    continue
                (bag.mesh if kind == 'mesh' else bag.vertices)(time, SHEET, at)
                if kind == 'mesh' or step % 4 == 1:
                    (bag.mesh if kind == 'mesh' else bag.vertices)(time, LARGE, at, organ='large', topology=step - step % 40)
        self.replay(out='alone.bag')
        names = [self.path('together_%d.bag' % i) for i in range(2 * os.cpu_count())]
        replays = [subprocess.Popen([os.environ['REPLAY'], '--parameters', self.path('parameters.yaml'), self.recorded, name],
                                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) for name in names]
        self.assertEqual([replay.wait(100) for replay in replays], len(names) * [0])
        alone = serialized(self.path('alone.bag'))
        self.assertEqual(len(alone), steps + steps // 40 + steps // 4)
        for name in names:
            self.assertTrue(serialized(name) == alone, name)
        answers = [answer for _, answer in messages(self.path('alone.bag'))]
        self.assertGreater(sum(answer.status == OK for answer in answers), steps // 2)
        self.assertTrue(any(answer.contacts for answer in answers))

    def test_links_whose_urdf_is_where_the_node_finds_it(self):
        """In a file, and in the whole tree as rosparam dump writes it."""
        with self.record() as bag:
            bag.resting(1.0)
            for frame in ('wrist', 'jaw'):
                bag.frame(2.0, frame, (-0.5, -0.25, 0.125))
            bag.mesh(2.0, SHEET)
        with open(GRIPPER) as urdf:
            text = urdf.read().replace('\n', ' ').replace("'", "''")
        for parameters in (LINKS % (', urdf: ' + GRIPPER), "robot_description: '%s'\norgan_collision:\n  %s" % (
                text, (LINKS % '').replace('\n', '\n  '))):
            ((_, answer),) = self.answers_of(parameters)
            self.assert_ok(answer)
            self.assertEqual(answer.links, ['wrist', 'jaw'])

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


class RefusalsTest(ReplayCase):
    def record_scene(self, **named):
        with self.record(**named) as bag:
            bag.resting(1.0)
            for i in range(6):
                bag.tool(2.0 + 0.1 * i, at_height(0.01 - 0.002 * i))
                (bag.vertices if i else bag.mesh)(2.0 + 0.1 * i, SHEET)
        with open(self.recorded, 'rb') as file:
            return file.read()

    def refuse(self, *words, parameters=TOOLS, **named):
        self.assert_refused(self.run_with(parameters, 'in.bag', 'out.bag'), *words, **named)

    @unittest.skipIf('ASAN_OPTIONS' in os.environ, 'librosbag_storage reads memory that is not its own')
    def test_damaged_bags(self):
        """One byte has changed, the end is missing, or it is no bag: one line, exit code 1, unless the byte does not matter.
        The library's own crash counts, too."""
        bags = [b'', b'tools: [none]\n']
        chance = random.Random(7)
        for compression in 'none', 'bz2':
            data = self.record_scene(compression=compression)
            bags += [data[:int(share * len(data))] for share in (0.2, 0.5, 0.9, 0.999)]
            ends = [match.start() for match in re.finditer(b'op=|size=|count=|pos=|conn=', data)]  # of small numbers
            for number in range(16):
                place = chance.choice(ends) + chance.randrange(-8, 16) if number % 4 else chance.randrange(len(data))
                bags.append(data[:place] + bytes([data[place] ^ chance.randrange(1, 256)]) + data[place + 1:])
        self.write('parameters.yaml', 'picker: cpu\n' + TOOLS)

        def replay(number):
            self.write('in%d.bag' % number, bags[number])
            return self.run_program('--parameters', 'parameters.yaml', 'in%d.bag' % number, 'out%d.bag' % number,
                                    program=os.environ['REPLAY'])

        with multiprocessing.pool.ThreadPool(2) as pool:
            done = pool.map(replay, range(len(bags)))
        for number, result in enumerate(done):
            with self.subTest(bag=number):
                self.assertIn(result.returncode, (0, 1, 2) if number > 5 else (1,), result.stderr)
                self.assertEqual(os.path.exists(self.path('out%d.bag' % number)), result.returncode == 0, result.stderr)
                self.assertFalse(os.path.exists(self.path('out%d.bag.incomplete' % number)))
                if result.returncode:
                    self.assertRegex(result.stderr, r'\A(replay: )?in%d.bag: .*\n\Z' % number)
        codes = [result.returncode for result in done]
        self.assertGreater(min(codes.count(0), codes.count(1)), 3, codes)

    def test_a_bag_of_an_interrupted_recording(self):
        bag = self.record()
        bag.mesh(2.0, SHEET)
        bag.bag._stop_writing_chunk()
        bag.bag._file.flush()
        shutil.copy(self.recorded, self.path('active.bag'))
        bag.bag.close()
        self.assert_refused(self.run_with(TOOLS, 'active.bag', 'out.bag'), 'active.bag', '`rosbag reindex`', status=1)

    def test_topics(self):
        with self.record() as bag:
            bag.tool(2.0, at_height(0.01))
        self.refuse('/organ_collision/organ_mesh', 'no organ')
        with self.record() as bag:
            bag.mesh(2.0, SHEET)
            bag.write('/tf', String('no transform'), 2.0)
        self.refuse('/tf', 'std_msgs/String', 'tf2_msgs/TFMessage')
        with self.record() as bag:
            bag.mesh(2.0, SHEET)
            bag.of_version('/organ_collision/organ_vertices', OrganVertices, md5sum=32 * 'a', at=2.0)
        self.refuse('/organ_collision/organ_vertices', 32 * 'a', 'doc/bags.md')
        self.record_scene(node='/left/contacts_of_liver')
        self.refuse('/organ_collision/organ_mesh', '/left/contacts_of_liver/organ_mesh', '--node')
        self.replay(options=['--node', '/left/contacts_of_liver'])
        self.assertEqual({topic for topic, *_ in serialized(self.answers)}, {'/left/contacts_of_liver/contacts'})

    def test_bad_parameters(self):
        self.record_scene()
        robot = LINKS % ''
        for parameters, *words in [
                (TOOLS.replace('hook_tip', 'hok_tip'), "'hok_tip'", "'hook'"),
                ('rate: 10\n', '~tools', 'missing'),
                (TOOLS.replace('0.005', '-1'), 'radius', '-1'),
                ('tools:\n  - {name: [}\n', 'parameters.yaml:2:'),
                ('tools: &a [*a]\n', 'parameters.yaml', 'line 1'),
                (LINKS % ', urdf: /nowhere.urdf', 'grip', 'nowhere.urdf'),
                (robot, 'grip', 'robot_description', 'parameters.yaml'),
                (robot + 'robot_description: 7\n', 'grip', 'robot')]:
            with self.subTest(parameters=parameters):
                self.refuse(*words, parameters=parameters)


if __name__ == '__main__':
    unittest.main(verbosity=2)
