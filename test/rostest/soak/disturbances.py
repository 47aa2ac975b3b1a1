"""What happens to the processes of a soak. The simulator itself disturbs the node by its messages (simulator.hpp)."""

import collections
import contextlib
import os
import signal
import subprocess
import time

import silent_subscriber
from subject import CONTACTS

PAUSE = (1.0, 3.0)  # [s] between two disturbances
SILENT = {CONTACTS: 'organ_collision/ContactArray', '/organ_collision/markers': 'visualization_msgs/MarkerArray'}


class Disturbances:
    """Disturbs in an order that depends only on the random numbers."""

    def __init__(self, master, subject, random_numbers):
        self.subject, self.random = subject, random_numbers
        self.counts = collections.Counter()
        self._silent = {}
        self._address = master.ask('lookupNode', '/organ_collision')

    def run(self, seconds):
        """Each of them once, in any order, and again, until the time has passed."""
        kinds = [self.stop_node, self.stop_simulator, self.starve, self.fall_silent]
        end = time.monotonic() + seconds
        with contextlib.ExitStack() as stack:
            stack.callback(self._hang_up)
            for topic in SILENT:  # From the beginning, so that what waits for them is part of the warm-up.
                self._fall_silent(topic)
            while True:
                self.random.shuffle(kinds)
                for kind in kinds:
                    if self._pause(end) or self.subject.has_ended():
                        return
                    self.counts[kind.__name__] += 1
                    kind()

    def stop_node(self):
        self._stop(self.subject.node, self.random.uniform(0.05, 0.8))

    def stop_simulator(self):
        self._stop(self.subject.simulator, self.random.uniform(0.05, 2.0))

    def starve(self):
        """Two endless loops for each core."""
        loops = [subprocess.Popen(['sh', '-c', 'while :; do :; done']) for _ in range(2 * os.cpu_count())]
        time.sleep(self.random.uniform(0.5, 2.5))
        for loop in loops:
            loop.kill()
            loop.wait()

    def fall_silent(self):
        """A subscriber that never reads hangs up, and another one takes its place."""
        self._fall_silent(self.random.choice(list(SILENT)))

    def _fall_silent(self, topic):
        if topic in self._silent:
            self._silent.pop(topic).close()
        self._silent[topic] = silent_subscriber.connect(self._address, topic, SILENT[topic])

    def _pause(self, end):
        """Returns whether the time has passed."""
        pause = min(self.random.uniform(*PAUSE), end - time.monotonic())
        if pause > 0.0:
            time.sleep(pause)
        return time.monotonic() >= end

    @staticmethod
    def _stop(process, seconds):
        process.send_signal(signal.SIGSTOP)
        time.sleep(seconds)
        process.send_signal(signal.SIGCONT)

    def _hang_up(self):
        for connection in self._silent.values():
            connection.close()
