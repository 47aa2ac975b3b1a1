"""Latencies while other programs keep all cores busy, with and without realtime priority."""

import contextlib
import os
import subprocess

from shapes import run_in_turn
from subject import Subject

FACES, TOOLS, RATE = 1224, 1, 1000
PRIORITY = 20  # of node and nodelet
SIMULATOR = 30  # above the node, so that only the node's latencies show
SETTINGS = {'': {}, 'realtime_priority': {'realtime_priority': PRIORITY, 'lock_memory': True}}


def may_have_priority():
    """Whether this user may give programs realtime priority."""
    return subprocess.run(['chrt', '-f', str(SIMULATOR), 'true'], stderr=subprocess.DEVNULL, check=False).returncode == 0


@contextlib.contextmanager
def busy_cores():
    """One endless loop for each core."""
    loops = [subprocess.Popen(['sh', '-c', 'while :; do :; done']) for _ in range(os.cpu_count())]
    try:
        yield
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()


def subject(master, workspace, kind, parameters):
    """The whole simulator has priority; of a nodelet's process, which the simulator shares, only its own thread."""
    prefix = ('chrt', '-f', str(SIMULATOR)) if kind == 'node' else ()
    made = Subject(master, workspace, kind, FACES, TOOLS, parameters, prefix)
    made.raise_simulator(SIMULATOR)
    return made


def measure_busy_machine(master, workspace, seconds):
    """Returns nothing if this user may not give realtime priority."""
    if not may_have_priority():
        print('not measured: a busy machine, because this user may not give realtime priority', flush=True)
        return []
    reports = []
    with contextlib.ExitStack() as stack:
        subjects = {(kind, setting): stack.enter_context(subject(master, workspace, kind, parameters))
                    for kind in ('node', 'nodelet') for setting, parameters in SETTINGS.items()}
        for load, cores in (('idle', contextlib.nullcontext), ('busy', busy_cores)):
            with cores():
                runs = run_in_turn(subjects, RATE, seconds)
            reports += [dict(run.summary(), what='load', kind=kind, setting=setting, load=load)
                        for (kind, setting), run in runs.items()]
    return reports
