#!/usr/bin/python3
"""The commands for replay on the page doc/bags.md work as they stand."""

import os
import re
import subprocess
import unittest

from support.tool_over_sheet import SHEET, at_height

from recording import Recording, TOOLS
from replay_case import ReplayCase

PAGE = os.path.join(os.environ['SOURCE'], 'doc', 'bags.md')
# rosrun is tested elsewhere (test/install/rosrun_test.py).
ROSRUN = 'rosrun() { test "$1 $2" = "organ_collision replay" && shift 2 && "$REPLAY" "$@"; }\n'


class BagsPageTest(ReplayCase):
    def test_the_commands_of_replay(self):
        with open(PAGE, encoding='utf-8') as page:
            blocks = re.findall(r'```bash\n(.*?)```', page.read(), re.S)
        (commands,) = [block for block in blocks if 'rosrun organ_collision replay' in block]
        self.write('tools.yaml', TOOLS)
        with Recording(self.path('surgery.bag')) as bag:
            bag.resting(1.0)
            bag.tool(2.0, at_height(-0.01))
            bag.mesh(2.0, SHEET)
        done = subprocess.run(
            ['bash', '-e', '-c', ROSRUN + commands],
            cwd=self.folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=100,
        )
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertIn('1 answers on /organ_collision/contacts: 1 ok', done.stdout)
        self.assertIn('tool: "hook"', done.stdout)


if __name__ == '__main__':
    unittest.main(verbosity=2)
