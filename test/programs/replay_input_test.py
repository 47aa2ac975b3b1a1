#!/usr/bin/python3
"""Bad input to replay: one clear line, exit code 2, and no OUT.bag."""

import collections
import multiprocessing.pool
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import unittest

from organ_collision.msg import ContactArray, OrganVertices
import rosbag
from std_msgs.msg import String
from support.tool_over_sheet import SHEET, at_height

from recording import CONTACTS, messages, ReplayCase, TOOLS, serialized

GRIPPER = os.path.join(os.environ['TEST_DATA'], 'tools', 'gripper.urdf')
LINKS = 'tools:\n  - {name: grip, links: [wrist, jaw]%s}\n'


class ReplayInputTest(ReplayCase):
    def record_scene(self, **named):
        with self.record(**named) as bag:
            bag.resting(1.0)
            for i in range(20):
                bag.tool(2.0 + 0.1 * i, at_height(0.01))
                (bag.vertices if i else bag.mesh)(2.0 + 0.1 * i, SHEET)

    def refuse(self, *words, parameters=TOOLS, options=(), out='out.bag'):
        self.assert_refused(self.run_with(parameters, *options, self.recorded, self.path(out)), *words)

    def test_files_that_are_no_bag(self):
        self.refuse('in.bag', 'no bag')
        for text in 'tools: [none]\n', '':
            self.write('in.bag', text)
            self.refuse('in.bag', 'no bag')

    def test_a_truncated_bag(self):
        self.record_scene()
        with open(self.recorded, 'rb') as file:
            data = file.read()
        for share in (0.2, 0.5, 0.9, 0.999):
            with open(self.recorded, 'wb') as file:
                file.write(data[: int(share * len(data))])
            self.refuse('in.bag')

    def test_a_bag_of_an_interrupted_recording(self):
        bag = self.record()
        bag.resting(1.0)
        bag.mesh(2.0, SHEET)
        bag.bag._stop_writing_chunk()
        bag.bag._file.flush()
        shutil.copy(self.recorded, self.path('active.bag'))
        bag.bag.close()
        self.assert_refused(self.run_with(TOOLS, self.path('active.bag'), self.answers), 'active.bag', 'no index', 'rosbag reindex')

    def test_a_bag_without_an_organ(self):
        with self.record() as bag:
            bag.tool(2.0, at_height(0.01))
        self.refuse('in.bag', '/organ_collision/organ_mesh', 'no organ')

    def test_the_topics_of_another_node(self):
        self.record_scene(node='/left/contacts_of_liver')
        self.refuse('/organ_collision/organ_mesh', '/left/contacts_of_liver/organ_mesh', '--node')
        self.replay(options=['--node', '/left/contacts_of_liver'])
        topics = {topic for topic, *_ in serialized(self.answers)}
        self.assertEqual(topics, {'/left/contacts_of_liver/contacts'})

    def test_a_topic_of_another_type(self):
        self.record_scene()
        with self.record() as bag:
            bag.mesh(2.0, SHEET)
            bag.write('/tf', String('no transform'), 2.0)
        self.refuse('/tf', 'std_msgs/String', 'tf2_msgs/TFMessage')

    def test_a_topic_of_another_version_of_its_type(self):
        self.record_scene()
        with self.record() as bag:
            bag.mesh(2.0, SHEET)
            bag.of_version('/organ_collision/organ_vertices', OrganVertices, md5sum=32 * 'a', at=2.0)
        self.refuse('/organ_collision/organ_vertices', 32 * 'a', 'another version', 'doc/bags.md')

    def test_answers_of_version_0_2_are_replaced(self):
        self.record_scene()
        with self.record() as bag:
            bag.resting(1.0)
            bag.tool(2.0, at_height(0.01))
            bag.mesh(2.0, SHEET)
            bag.of_version(CONTACTS, ContactArray, md5sum='a0344eaa8592eec475e29de09ebda86a', at=2.0)
        self.replay(options=['--with-input'])
        with rosbag.Bag(self.answers) as answers:
            ((_, answer, _),) = answers.read_messages(CONTACTS)
        self.assert_ok(answer)
        self.assertEqual(answer._md5sum, ContactArray._md5sum)

    def test_bad_parameters(self):
        self.record_scene()
        robot = LINKS % ''
        for parameters, *words in [
                (TOOLS.replace('hook_tip', 'hok_tip'), "'hok_tip'", "'hook'"),
                ('rate: 10\n', '~tools', 'missing'),
                (TOOLS.replace('0.005', '-1'), 'radius', '-1'),
                ('tools:\n  - {name: [}\n', 'parameters.yaml:2:'),
                ('tools: &a [*a]\n', 'parameters.yaml', 'line 1'),
                ('tools:\n', 'parameters.yaml', 'is empty'),
                (LINKS % ', urdf: /nowhere.urdf', 'grip', 'nowhere.urdf'),
                (robot, 'grip', 'robot_description', 'parameters.yaml'),
                (robot + 'robot_description: 7\n', 'grip', 'robot')]:
            with self.subTest(parameters=parameters):
                self.refuse(*words, parameters=parameters)

    def test_an_output_in_no_folder(self):
        self.record_scene()
        self.refuse('/nowhere/out.bag', out='/nowhere/out.bag')

    def test_an_output_that_is_no_regular_file_is_kept(self):
        self.record_scene()
        self.write('parameters.yaml', TOOLS)
        os.mkdir(self.path('folder'))
        os.mkfifo(self.path('fifo'))
        self.write('target', 'precious')
        os.symlink(self.path('target'), self.path('link'))
        os.symlink(self.path('nothing'), self.path('dangling'))
        os.mkfifo(self.path('x.bag.incomplete'))
        before = sorted(os.listdir(self.folder))
        for written, name in (('folder', 'folder'), ('fifo', 'fifo'), ('link', 'link'),
                              ('dangling', 'dangling'), ('x.bag.incomplete', 'x.bag')):
            mode = os.lstat(self.path(written)).st_mode
            done = self.run_with(TOOLS, self.recorded, self.path(name))
            self.assert_refused(done, self.path(written) + ' is no regular file')
            self.assertEqual(os.lstat(self.path(written)).st_mode, mode)
        self.assertEqual(sorted(os.listdir(self.folder)), before)

    def test_an_input_that_is_no_regular_file_is_refused(self):
        self.write('parameters.yaml', TOOLS)
        os.mkfifo(self.path('in_fifo'))
        for name in ('in_fifo', '.'):
            self.assert_refused(self.run_with(TOOLS, self.path(name), self.path('out.bag')), 'must be a recorded bag')

    def test_parameters_in_a_folder_are_refused(self):
        self.record_scene()
        done = subprocess.run([os.environ['REPLAY'], '--parameters', self.folder, self.recorded, self.answers],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.assert_refused(done, 'is a folder; must be a yaml file')

    def test_a_signal_ends_the_wait_for_parameters_that_never_come(self):
        self.record_scene()
        os.mkfifo(self.path('fifo'))
        for number in (signal.SIGINT, signal.SIGTERM):
            with subprocess.Popen([os.environ['REPLAY'], '--parameters', self.path('fifo'), self.recorded, self.answers],
                                  stderr=subprocess.PIPE, text=True) as replay:
                replay.send_signal(number)
                replay.communicate(timeout=60)
                self.assertEqual(replay.returncode, -number)

    def test_an_interrupted_replay_leaves_no_file(self):
        with self.record() as bag:
            bag.resting(1.0)
            bag.mesh(2.0, SHEET)
            for i in range(20000):
                bag.vertices(2.0, SHEET)
        self.write('parameters.yaml', TOOLS)
        with subprocess.Popen([os.environ['REPLAY'], '--parameters', 'parameters.yaml', 'in.bag', 'out.bag'], cwd=self.folder,
                              stderr=subprocess.PIPE, text=True) as replay:
            while not os.path.exists(self.answers + '.incomplete'):
                self.assertIsNone(replay.poll())
            replay.send_signal(signal.SIGINT)
            self.assertIn('interrupted', replay.communicate(timeout=60)[1])
            self.assertEqual(replay.returncode, 1)
        self.assertFalse([name for name in os.listdir(self.folder) if name.startswith('out')])


class DamageTest(ReplayCase):
    """Neither a damaged bag nor a full disk ends replay by a signal. OpenGL is not needed for this."""

    PARAMETERS = 'picker: cpu\n' + TOOLS

    def record_scene(self, compression='none'):
        with self.record(compression=compression) as bag:
            bag.resting(1.0)
            for i in range(6):
                bag.tool(2.0 + 0.1 * i, at_height(0.01 - 0.002 * i))
                (bag.vertices if i else bag.mesh)(2.0 + 0.1 * i, SHEET)

    def mutants(self):
        """64 bags in which one byte has changed: anywhere, or in one of the numbers by which the library finds its way."""
        for compression in 'none', 'bz2':
            self.record_scene(compression)
            with open(self.recorded, 'rb') as file:
                data = file.read()
            numbers = [place for match in re.finditer(rb'(?:count|pos|size|conn|ver|op)=', data)
                       for place in range(match.end(), match.end() + 4)]
            numbers += [place for match in re.finditer(rb'op=\x04', data) for place in range(match.end() + 11, match.end() + 40)]
            chance = random.Random(7)
            for number in range(32):
                place = chance.choice(numbers) if number % 2 else chance.randrange(len(data))
                yield data[:place] + bytes([data[place] ^ chance.randrange(1, 256)]) + data[place + 1:]

    def replay_mutant(self, number, mutant):
        bag, answers = 'in%d.bag' % number, 'out%d.bag' % number
        self.write(bag, mutant)
        return answers, self.run_program('--parameters', 'parameters.yaml', bag, answers, program=os.environ['REPLAY'])

    def test_a_changed_byte_gives_answers_or_one_line(self):
        self.write('parameters.yaml', self.PARAMETERS)
        with multiprocessing.pool.ThreadPool(2) as pool:
            done = pool.starmap(self.replay_mutant, enumerate(self.mutants()))
        self.assertEqual(len(done), 64)
        ended = collections.Counter()
        for number, (answers, result) in enumerate(done):
            with self.subTest(mutant=number):
                said = result.stderr
                self.assertIn(result.returncode, (0, 1, 2), said)
                self.assertEqual(os.path.exists(self.path(answers)), result.returncode == 0, said)
                self.assertFalse(os.path.exists(self.path(answers + '.incomplete')))
                own = [line for line in said.splitlines() if re.match(r'in\d+\.bag: |replay: |out\d+\.bag: ', line)]
                self.assertEqual(len(own), 1 if result.returncode else 0, said)
                ended[result.returncode, 'by signal' in said] += 1
        self.assertGreater(ended[0, False], 3, ended)
        self.assertGreater(ended[2, False], 3, ended)
        self.assertGreater(ended[1, True], 0, ended)  # Otherwise, the test does not reach the library's faults.
        self.assertLess(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss, 2**20)  # [KiB]

    def test_a_disk_that_is_full(self):
        """The limit of a file's size is reached when the answers are written, or when the bag is closed. Without its
        handler, the signal of the limit ends the process."""
        self.record_scene()
        self.write('parameters.yaml', self.PARAMETERS)
        for trap, blocks, words in [("trap '' XFSZ", blocks, 'out.bag: cannot be written: File too large')
                                    for blocks in (0, 1, 8, 12)] + [('true', 1, 'ended by signal')]:
            done = self.run_program('-c', '%s; ulimit -f %d; exec "$REPLAY" --parameters parameters.yaml --with-input '
                                    'in.bag out.bag' % (trap, blocks), program='/bin/sh')
            self.assertEqual((done.returncode, done.stdout), (1, ''), done.stderr)
            self.assertRegex(done.stderr, r'\A.*%s.*\n\Z' % words)
            self.assertEqual(sorted(os.listdir(self.folder)), ['in.bag', 'parameters.yaml'])

    def test_a_full_stdout(self):
        """The answers are there all the same."""
        self.record_scene()
        self.write('parameters.yaml', self.PARAMETERS)
        with open('/dev/full', 'w') as full:
            done = subprocess.run([os.environ['REPLAY'], '--parameters', 'parameters.yaml', 'in.bag', 'out.bag'], cwd=self.folder,
                                  stdout=full, stderr=subprocess.PIPE, text=True)
        self.assertEqual((done.returncode, done.stderr), (1, 'replay: stdout cannot be written: No space left on device\n'))
        self.assertEqual(len(messages(self.answers)), 6)


class RobotTest(ReplayCase):
    def test_links_whose_urdf_is_where_the_node_finds_it(self):
        """In a file, and in the whole tree as rosparam dump writes it."""
        with self.record() as bag:
            bag.resting(1.0)
            for frame in ('wrist', 'jaw'):
                bag.frame(2.0, frame, (-0.5, -0.25, 0.125))
            bag.mesh(2.0, SHEET)
        with open(GRIPPER) as urdf:
            text = urdf.read().replace('\n', ' ').replace("'", "''")
        indented = (LINKS % '').replace('\n', '\n  ')
        for parameters in (LINKS % (', urdf: ' + GRIPPER),
                           "robot_description: '%s'\norgan_collision:\n  %s" % (text, indented)):
            ((_, answer),) = self.answers_of(parameters)
            self.assert_ok(answer)
            self.assertEqual(answer.links, ['wrist', 'jaw'])
            self.assertGreater(len(answer.contacts), 0)


if __name__ == '__main__':
    unittest.main(verbosity=2)
