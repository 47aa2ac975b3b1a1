#!/usr/bin/python3
"""Bad input to replay: one clear line, exit code 2, and no OUT.bag."""

import os
import shutil
import signal
import subprocess
import unittest

from organ_collision.msg import ContactArray, OrganVertices
import rosbag
from std_msgs.msg import String
from support.tool_over_sheet import SHEET, at_height

from recording import CONTACTS, ReplayCase, TOOLS, serialized

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
