#!/usr/bin/python3
"""The commands of the pages run as they stand.

The commands of a page are typed from top to bottom, unless the paragraph before them says that they were run by hand,
or their comment names a window. A command that runs until Ctrl-C must start a node. At the end of the page, it still
runs or has ended without error. Every other command ends without error. Of the scripts at the top of the repository, only
the options are checked.

The first python3 in PATH is one that has no modules of ROS, as on machines with pyenv or conda.

Usage: commands_test.py SOURCE_FOLDER DEVEL_FOLDER
"""

import os
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import time
import unittest

SOURCE, DEVEL = sys.argv[1:3]
sys.path.append(os.path.join(SOURCE, 'test', 'rostest'))

from support.processes import OwnMaster  # noqa: E402

# Each page, and what the reader has already started.
START = ['roslaunch organ_collision start.launch']
PAGES = {'README.md': [], 'doc/getting_started.md': [], 'doc/tools.md': [], 'doc/offline.md': [], 'doc/forces.md': [],
         'doc/interface.md': START, 'doc/troubleshooting.md': START, 'doc/guard.md': START,
         'doc/trials.md': ['roslaunch organ_collision forces.launch', 'rosrun organ_collision simulator.py']}
LIMIT = 60.0  # [s]
ORGAN = """v -0.05 -0.05 0
v 0.05 -0.05 0
v 0.05 0.05 0
v -0.05 0.05 0
f 1 2 3
f 1 3 4
"""
TOOLS = '{tools: [{name: hook, trocar_frame: hook_trocar, tip_frame: hook_tip, radius: 0.005}]}\n'
LIMITS = 'limits: [{organ: tissue, max_force: 2}]\n'
OTHER_PYTHON = '#!/bin/sh\nexec /usr/bin/python3 -S "$@"\n'
MOTIONS = '1,swept,0,0,0.1,-0.02,0,0.03,0.02,0,0.003,0.005\n'


def commands(page):
    """Pairs of (command, its comment) of all blocks that were not run by hand."""
    with open(os.path.join(SOURCE, page), encoding='utf-8') as text:
        parts = re.split(r'^```(\w*)\n(.*?)^```', text.read(), flags=re.M | re.S)
    for before, language, block in zip(parts[::3], parts[1::3], parts[2::3]):
        paragraph = before.strip().split('\n\n')[-1]
        if language != 'bash' or 'by hand' in paragraph:
            continue
        for line in block.splitlines():
            command, _, comment = line.partition(' #')
            if command.strip() and not command.startswith('. ') and 'window' not in comment:
                yield command.strip(), comment


class Terminals:
    """Runs commands in a folder that has the user's files, with a ROS master of their own."""

    def __init__(self, folder):
        self.folder, self.master, self.running = folder, OwnMaster(), []
        self.environment = dict(self.master.environment, ROS_HOME=folder,
                                PATH=os.path.join(folder, 'bin') + ':' + os.environ['PATH'])
        self.output = open(os.path.join(folder, 'output'), 'w+')

    def start(self, command):
        shell = 'unset BASH_ENV; . %s/setup.bash; %s' % (shlex.quote(DEVEL), command)
        process = subprocess.Popen(['bash', '-c', shell], cwd=self.folder, env=self.environment, start_new_session=True,
                                   stdin=subprocess.DEVNULL, stdout=self.output, stderr=self.output)
        self.running.append((command, process))
        return process

    def run(self, command):
        """Whether the command ends without error. What it needs may still be starting, so it may be tried again."""
        deadline = time.monotonic() + LIMIT
        while time.monotonic() < deadline:
            process = self.start(command)
            try:
                if process.wait(max(0.1, deadline - time.monotonic())) == 0:
                    return True
            except subprocess.TimeoutExpired:
                return False
            self.running.pop()
            time.sleep(0.5)
        return False

    def nodes(self):
        """The running nodes. A node that was started again is another one."""
        return {(node, self.master.ask('lookupNode', node)) for _, _, node in self.master.record()}

    def start_node(self, command):
        """Whether the command starts a node. Ctrl-C ends the same program first, if it runs with other arguments."""
        for other, process in self.running:
            if other.split()[:3] == command.split()[:3] and process.poll() is None:
                os.killpg(process.pid, signal.SIGINT)
                process.wait(LIMIT)
        before = self.nodes()
        process = self.start(command)
        deadline = time.monotonic() + LIMIT
        while process.poll() is None and time.monotonic() < deadline:
            if self.nodes() - before:
                return True
            time.sleep(0.1)
        return False

    def failed(self):
        return [command for command, process in self.running if process.poll() not in (None, 0)]

    def close(self):
        for _, process in reversed(self.running):
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGINT)
        for _, process in self.running:
            try:
                process.wait(LIMIT)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
        self.master.stop()
        self.output.close()

    def said(self):
        self.output.seek(0)
        return self.output.read()[-4000:]


class CommandsTest(unittest.TestCase):
    def check_script(self, command):
        words = command.split()
        usage = subprocess.check_output([os.path.join(SOURCE, words[0]), '--help'], text=True)
        for option in words[1:]:
            if option.startswith('-'):
                self.assertIn(option, usage, command)

    def test_commands_of_the_pages(self):
        for page, started in PAGES.items():
            with self.subTest(page=page), tempfile.TemporaryDirectory(prefix='organ_collision_') as folder:
                os.mkdir(os.path.join(folder, 'bin'))
                for name, content in (('organ.obj', ORGAN), ('motions.csv', MOTIONS), ('tools.yaml', TOOLS),
                                      ('limits.yaml', LIMITS), ('bin/python3', OTHER_PYTHON)):
                    with open(os.path.join(folder, name), 'w') as file:
                        file.write(content)
                os.chmod(os.path.join(folder, 'bin', 'python3'), 0o755)
                found = list(commands(page))
                self.assertTrue(found, page)
                terminals = Terminals(folder)
                try:
                    for command in started:
                        self.assertTrue(terminals.start_node(command), command + '\n' + terminals.said())
                    for command, comment in found:
                        if command.startswith('./'):
                            self.check_script(command)
                        elif command.startswith('roslaunch') or 'Ctrl-C' in comment:
                            self.assertTrue(terminals.start_node(command), command + '\n' + terminals.said())
                        else:
                            self.assertTrue(terminals.run(command), command + '\n' + terminals.said())
                    self.assertEqual(terminals.failed(), [], terminals.said())
                finally:
                    terminals.close()


if __name__ == '__main__':
    unittest.main(argv=sys.argv[:1], verbosity=2)
