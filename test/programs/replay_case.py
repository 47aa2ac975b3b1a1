"""A test case that records a bag and replays it."""

import os
import shutil
import tempfile

from support.contact_case import ContactCase

from recording import Recording, TOOLS, messages, run


class ReplayCase(ContactCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix='organ_collision_replay_')
        self.addCleanup(shutil.rmtree, self.folder)
        self.recorded, self.answers = self.path('in.bag'), self.path('out.bag')

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), 'w') as file:
            file.write(text)
        return self.path(name)

    def record(self, **named):
        return Recording(self.recorded, **named)

    def replay(self, parameters=TOOLS, options=(), out='out.bag'):
        """Replays the recorded bag. Returns what subprocess.run returns."""
        file = self.write('parameters.yaml', parameters)
        done = run('--parameters', file, *options, self.recorded, self.path(out))
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def answers_of(self, *arguments, **named):
        """Replays the recorded bag. Returns (time, answer) for each answer."""
        self.replay(*arguments, **named)
        return messages(self.answers)

    def assert_refused(self, done, *words):
        """One line on stderr with these words, exit code 2, and no file beside those that were
        there."""
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stdout, '')
        lines = [line for line in done.stderr.splitlines() if 'WARN' not in line]
        self.assertEqual(len(lines), 1, done.stderr)
        for word in words:
            self.assertIn(word, lines[0])
        self.assertFalse([name for name in os.listdir(self.folder) if name.startswith('out')])
