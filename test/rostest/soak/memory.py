"""The resident memory of a process over time."""

import pathlib
import threading
import time

PERIOD = 0.25  # [s]


def resident_bytes(pid):
    status = pathlib.Path(f'/proc/{pid}/status').read_text(encoding='ascii')
    return 1024 * int(status.split('VmRSS:')[1].split()[0])


class Memory:
    """Samples (time [s] since the start, bytes) in a thread of its own, until the process or this ends."""

    def __init__(self, pid):
        self.samples = []
        self._pid = pid
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self):
        start = time.monotonic()
        while not self._stop.wait(PERIOD):
            try:
                self.samples.append((time.monotonic() - start, resident_bytes(self._pid)))
            except (OSError, IndexError):  # The process is gone.
                return

    def end(self):
        self._stop.set()
        self._thread.join()
        return self.samples
