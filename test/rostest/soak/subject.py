"""What a soak runs: the node or the nodelet, with its simulator and its judge."""

import contextlib
import json
import pathlib
import signal
import subprocess
import time

import yaml

from memory import Memory
from support.node_client import wait_until
from verdict import open_accounts

KINDS = ('node', 'nodelet')
LOAD = pathlib.Path(__file__).resolve().parent.parent / 'load'
CONTACTS = '/organ_collision/contacts'
REGISTERED = 60.0  # [s] at most, until the ROS master knows the node
SETTLED = 60.0  # [s] at most, for the last messages to arrive
SHUT_DOWN = 30.0  # [s] at most, from Ctrl-C to the end of the node


class Subject:
    """Runs until its `with` block ends."""

    def __init__(self, master, devel, kind, seed, log):
        """`log`: a file for what the node prints."""
        self.kind = kind
        self._master = master
        self._devel = devel
        self._stack = contextlib.ExitStack()
        parameters = {'/use_sim_time': True,
                      '/robot_description': (LOAD / 'jaw.urdf').read_text(encoding='utf-8'),
                      '/organ_collision': {'tools': yaml.safe_load((LOAD / 'tools.yaml').read_text(encoding='utf-8')),
                                           'diagnostic_period': 0.1}}
        for name, value in parameters.items():
            master.ask('setParam', name, value)
        with contextlib.ExitStack() as stack:
            self.node = stack.enter_context(self._start(
                *(['organ_collision_node'] if kind == 'node' else
                  ['nodelet', 'standalone', 'organ_collision/CollisionNodelet']), '__name:=organ_collision',
                stdout=log, stderr=log))
            self.wait_until_registered()
            self.judge = stack.enter_context(self._start('soak_judge', str(seed)))
            self._read(self.judge)
            self.simulator = stack.enter_context(self._start('soak_simulator', str(seed)))
            self._read(self.simulator)
            self._memory = Memory(self.node.pid)
            self._stack = stack.pop_all()

    def wait_until_registered(self):
        """Until the ROS master knows what the node publishes."""
        wait_until(lambda: ('publisher', CONTACTS, '/organ_collision') in self._master.record(),
                   f'the {self.kind} at the ROS master', REGISTERED)

    def has_ended(self):
        return any(process.poll() is not None for process in (self.node, self.judge, self.simulator))

    def end(self, disturbances):
        """Ends the disturbances. Returns all that was measured, for verdict.py."""
        run = {'kind': self.kind, 'disturbances': dict(disturbances.counts), 'ended': self._ended(),
               'memory': self._memory.end()}
        if not run['ended']:
            run['sent'] = json.loads(self._ask(self.simulator, 'end'))
            give_up = time.monotonic() + SETTLED
            while True:
                time.sleep(0.5)
                run['judged'] = json.loads(self._ask(self.judge, 'report'))
                if not open_accounts(run) or time.monotonic() > give_up:
                    break
            run['ended'] = self._ended()
            self.node.send_signal(signal.SIGINT)
            run['exit code'] = self.node.wait(SHUT_DOWN)
        return run

    def _ended(self):
        """The programs that have ended before they should, with their exit codes."""
        programs = {self.kind: self.node, 'judge': self.judge, 'simulator': self.simulator}
        return {name: program.poll() for name, program in programs.items() if program.poll() is not None}

    @contextlib.contextmanager
    def _start(self, program, *arguments, stdout=subprocess.PIPE, stderr=None):
        path = self._devel / 'lib/organ_collision' / program
        command = [path] if path.exists() else ['rosrun', 'nodelet', program]
        process = subprocess.Popen([self._devel / 'env.sh', *command, *arguments], stdin=subprocess.PIPE,
                                   stdout=stdout, stderr=stderr, universal_newlines=True,
                                   env=self._master.environment)
        try:
            yield process
        finally:
            process.stdin.close()
            process.terminate()
            try:
                process.wait(timeout=20)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()

    def _ask(self, process, line):
        process.stdin.write(line + '\n')
        process.stdin.flush()
        return self._read(process)

    @staticmethod
    def _read(process):
        """The next line that is empty or JSON. What roscpp logs begins with an escape sequence or a bracket."""
        for line in process.stdout:
            if line == '\n' or line.startswith('{'):
                return line
        raise RuntimeError(f'{process.args[1]} has ended: {process.wait()}')

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._stack.close()
