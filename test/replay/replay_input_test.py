#!/usr/bin/python3
"""Bad input to replay: one clear line, exit code 2, and no OUT.bag."""

import contextlib
import os
import shutil
import signal
import socket
import stat
import subprocess
import unittest

from std_msgs.msg import String
from support.tool_over_sheet import SHEET, at_height

from recording import TOOLS, run, serialized
from replay_case import ReplayCase

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
        file = self.write('parameters.yaml', parameters)
        done = run('--parameters', file, *options, self.recorded, self.path(out))
        self.assert_refused(done, *words)

    def test_files_that_are_no_bag(self):
        self.refuse('in.bag', 'no bag')
        self.write('in.bag', 'tools: [none]\n')
        self.refuse('in.bag', 'no bag')
        self.write('in.bag', '')
        self.refuse('in.bag', 'no bag')
        os.remove(self.recorded)
        os.mkdir(self.recorded)
        self.refuse('in.bag', 'no bag')

    def test_a_truncated_bag(self):
        self.record_scene()
        with open(self.recorded, 'rb') as file:
            data = file.read()
        for share in (0.2, 0.5, 0.9, 0.999):
            with open(self.recorded, 'wb') as file:
                file.write(data[: int(share * len(data))])
            self.refuse('in.bag')

    def test_damaged_bags_end_with_a_line(self):
        """Bytes in the middle of the file are overwritten. The bag may be readable all the same."""
        self.record_scene()
        with open(self.recorded, 'rb') as file:
            data = file.read()
        for place in range(5000, len(data), len(data) // 12):
            with open(self.recorded, 'wb') as file:
                file.write(data[:place] + b'\xff' * 40 + data[place + 40 :])
            file = self.write('parameters.yaml', TOOLS)
            done = run('--parameters', file, self.recorded, self.answers)
            self.assertIn(done.returncode, (0, 2), done.stderr)
            self.assertEqual(os.path.exists(self.answers), done.returncode == 0)
            if done.returncode == 0:
                os.remove(self.answers)

    def test_a_bag_of_an_interrupted_recording(self):
        bag = self.record()
        bag.resting(1.0)
        bag.mesh(2.0, SHEET)
        bag.bag._stop_writing_chunk()
        bag.bag._file.flush()
        shutil.copy(self.recorded, self.path('active.bag'))
        bag.bag.close()
        file = self.write('parameters.yaml', TOOLS)
        done = run('--parameters', file, self.path('active.bag'), self.answers)
        self.assert_refused(done, 'active.bag', 'no index', 'rosbag reindex')

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

    def test_an_unknown_frame_of_a_tool(self):
        self.record_scene()
        self.refuse("'hok_tip'", "'hook'", parameters=TOOLS.replace('hook_tip', 'hok_tip'))

    def test_bad_parameters(self):
        self.record_scene()
        self.refuse('~tools', 'missing', parameters='rate: 10\n')
        self.refuse('radius', '-1', parameters=TOOLS.replace('0.005', '-1'))
        self.refuse('parameters.yaml:2:', parameters='tools:\n  - {name: [}\n')
        self.refuse('parameters.yaml', parameters='just a text\n')
        self.refuse('parameters.yaml', 'line 1', parameters='tools: &a [*a]\n')
        self.refuse('parameters.yaml', 'is empty', parameters='tools:\n')
        done = run('--parameters', self.path('none.yaml'), self.recorded, self.answers)
        self.assert_refused(done, 'none.yaml', 'cannot be opened')

    def test_bad_robots(self):
        self.record_scene()
        self.refuse('grip', 'nowhere.urdf', parameters=LINKS % ', urdf: /nowhere.urdf')
        self.refuse('grip', 'robot_description', 'parameters.yaml', parameters=LINKS % '')
        self.refuse('grip', 'robot', parameters=LINKS % '' + 'robot_description: 7\n')

    def test_bad_command_lines(self):
        self.record_scene()
        file = self.write('parameters.yaml', TOOLS)
        for arguments, word in (
            ([], 'IN.bag'),
            ([self.recorded], 'IN.bag'),
            ([self.recorded, self.answers], '--parameters'),
            (['--parameters', file, self.recorded, self.answers, 'x'], '3 are given'),
            (['--parameter', file, self.recorded, self.answers], '"--parameter"'),
            (['--parameters', file, '--node', 'a b', self.recorded, self.answers], '"a b"'),
            (['--parameters', file, self.recorded, self.recorded], 'also the input'),
            (['--parameters', file, self.recorded, '/nowhere/out.bag'], '/nowhere/out.bag'),
        ):
            self.assert_refused(run(*arguments), word)
        self.assertGreater(len(serialized(self.recorded)), 0)

    def test_an_input_with_the_name_of_an_incomplete_output_is_kept(self):
        self.record_scene()
        file = self.write('parameters.yaml', TOOLS)
        recorded = self.path('x.bag.incomplete')
        os.rename(self.recorded, recorded)
        self.assert_refused(run('--parameters', file, recorded, self.path('x.bag')), 'also the input')
        self.assertGreater(len(serialized(recorded)), 0)

    def test_an_output_that_is_no_regular_file_is_kept(self):
        self.record_scene()
        file = self.write('parameters.yaml', TOOLS)
        target, folder = self.write('target', 'precious'), self.path('folder')
        os.mkdir(folder)
        with socket.socket(socket.AF_UNIX) as bound:
            bound.bind(self.path('socket'))
        os.mkfifo(self.path('fifo'))
        os.symlink(target, self.path('link'))
        os.symlink(self.path('nothing'), self.path('dangling'))
        kinds = {'link': 'a symbolic link', 'dangling': 'a symbolic link', 'fifo': 'a FIFO', 'folder': 'a folder',
                 'socket': 'a socket'}
        with contextlib.suppress(PermissionError):  # Only root may make devices.
            os.mknod(self.path('device'), stat.S_IFCHR | 0o600, os.makedev(1, 3))
            kinds['device'] = 'a device'
        before = sorted(os.listdir(self.folder))
        for name, kind in kinds.items():
            mode = os.lstat(self.path(name)).st_mode
            for written in (name, name + '.incomplete'):
                if written != name:
                    os.rename(self.path(name), self.path(written))
                with self.subTest(written):
                    done = run('--parameters', file, self.recorded, self.path(name))
                    self.assert_refused(done, self.path(written) + ' is ' + kind, 'regular file')
                    self.assertEqual(os.lstat(self.path(written)).st_mode, mode)
            os.rename(self.path(written), self.path(name))
        self.assertEqual(sorted(os.listdir(self.folder)), before)
        with open(target) as text:
            self.assertEqual(text.read(), 'precious')

    def test_a_regular_file_is_replaced(self):
        self.record_scene()
        self.write('out.bag', 'no bag')
        self.write('out.bag.incomplete', 'no bag either')
        self.replay()
        self.assertGreater(len(serialized(self.answers)), 0)
        self.assertFalse(os.path.exists(self.answers + '.incomplete'))

    def test_an_interrupted_replay_leaves_no_file(self):
        with self.record() as bag:
            bag.resting(1.0)
            bag.mesh(2.0, SHEET)
            for i in range(20000):
                bag.vertices(2.0, SHEET)
        file = self.write('parameters.yaml', TOOLS)
        with subprocess.Popen(
            [os.environ['REPLAY'], '--parameters', file, self.recorded, self.answers],
            stderr=subprocess.PIPE,
            text=True,
        ) as replay:
            while not os.path.exists(self.answers + '.incomplete'):
                self.assertIsNone(replay.poll())
            replay.send_signal(signal.SIGINT)
            self.assertIn('interrupted', replay.communicate(timeout=60)[1])
            self.assertEqual(replay.returncode, 1)
        self.assertFalse([name for name in os.listdir(self.folder) if name.startswith('out')])

    def test_help(self):
        done = run('--help')
        self.assertEqual((done.returncode, done.stderr), (0, ''))
        for word in ('IN.bag', 'OUT.bag', '--parameters', '--node', '--with-input', 'Exit status'):
            self.assertIn(word, done.stdout)

    def test_the_summary_counts_the_answers(self):
        self.record_scene()
        done = self.replay()
        self.assertIn('20 answers on /organ_collision/contacts: 20 ok', done.stdout)


class RobotTest(ReplayCase):
    """Tools made of links, with the URDF where the node finds it."""

    def check(self, parameters):
        with self.record() as bag:
            bag.resting(1.0)
            for frame in ('wrist', 'jaw'):
                bag.frame(2.0, frame, (-0.5, -0.25, 0.125))
            bag.mesh(2.0, SHEET)
        ((_, answer),) = self.answers_of(parameters)
        self.assert_ok(answer)
        self.assertEqual(answer.links, ['wrist', 'jaw'])
        self.assertGreater(len(answer.contacts), 0)

    def test_a_file(self):
        self.check(LINKS % (', urdf: ' + GRIPPER))

    def test_a_parameter_beside_the_tools(self):
        with open(GRIPPER) as urdf:
            text = urdf.read().replace('\n', ' ').replace("'", "''")
        self.check(LINKS % '' + "robot_description: '%s'\n" % text)

    def test_the_whole_tree_as_rosparam_dump_writes_it(self):
        with open(GRIPPER) as urdf:
            text = urdf.read().replace('\n', ' ').replace("'", "''")
        indented = (LINKS % '').replace('\n', '\n  ')
        self.check("robot_description: '%s'\norgan_collision:\n  %s" % (text, indented))


if __name__ == '__main__':
    unittest.main(verbosity=2)
