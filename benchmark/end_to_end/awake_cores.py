"""Latencies from shapes to contacts while idle cores sleep, and while they must not (the parameter `awake_cores`)."""

import contextlib
import os
import struct

from latencies import Latencies
from shapes import ROUND, TOOLS
from subject import ANSWERERS, ECHO, Subject

FACES, RATE = 1224, 1000
DEVICE = '/dev/cpu_dma_latency'  # the request of keep_cores_awake(), which holds while it is open
PICKERS = ('feedback', 'cpu')


def may_ask():
    """Whether this user may keep cores awake."""
    return os.access(DEVICE, os.R_OK | os.W_OK)


@contextlib.contextmanager
def awake_cores():
    """While this lasts, no core of the machine sleeps, as the parameter `awake_cores` has it."""
    device = os.open(DEVICE, os.O_RDWR)
    try:
        os.write(device, struct.pack('i', 0))
        yield
    finally:
        os.close(device)


STATES = {'asleep': contextlib.nullcontext, 'awake': awake_cores}


def subjects_of(master, workspace, stack):
    """By (kind, picker, number of tools). The parameter itself is not set: it would hold for all subjects."""
    keys = [(kind, picker, tools) for tools in TOOLS for kind in ANSWERERS
            for picker in (PICKERS if kind in ECHO else ('',))]
    return {(kind, picker, tools): stack.enter_context(
        Subject(master, workspace, kind, FACES, tools, {'picker': picker} if picker else None))
            for kind, picker, tools in keys}


def measure_awake_cores(master, workspace, seconds):
    """All subjects and both states in turn. Returns nothing if this user may not keep cores awake."""
    if not may_ask():
        print(f'not measured: awake cores, because this user may not write to {DEVICE}', flush=True)
        return []
    with contextlib.ExitStack() as stack:
        subjects = subjects_of(master, workspace, stack)
        rounds = {(key, state): [] for key in subjects for state in STATES}
        for _ in range(max(1, round(seconds / ROUND))):
            for state, cores in STATES.items():
                for key, subject in subjects.items():
                    with cores():
                        rounds[key, state].append(subject.run_shapes(RATE, ROUND))
    return [dict(Latencies.of_rounds(runs).summary(), what='awake cores', kind=kind, picker=picker, tools=tools, cores=state)
            for ((kind, picker, tools), state), runs in rounds.items()]
