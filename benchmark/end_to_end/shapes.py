"""Latencies from shapes to contacts, and the rates that node and nodelet hold, beside echoes at the same rates."""

import contextlib

from latencies import Latencies
from subject import ANSWERERS, ECHO, Subject

TOOLS = (1, 4)
RATES = (1000, 500, 250, 100, 50, 25)  # [Hz]
HIGHEST_RATE = {1224: 1000, 100_000: 1000, 1_000_000: 250}  # [Hz] that the simulator can send
ROUND = 1.0  # [s]
MOST_SKIPPED = 1e-3  # share of the shapes that may be skipped beyond those that the echo skips


def run_in_turn(subjects, rate, seconds):
    """Runs each subject for so long, in rounds. Returns the latencies by the subjects' keys."""
    rounds = {key: [] for key in subjects}
    for _ in range(max(1, round(seconds / ROUND))):
        for key, subject in subjects.items():
            rounds[key].append(subject.run_shapes(rate, ROUND))
    return {key: Latencies.of_rounds(runs) for key, runs in rounds.items()}


def echo_of(key):
    """The key of the echo that a node or nodelet is compared with."""
    _, kind, tools = key
    return '', ECHO[kind], tools


def holds(run, echo):
    """Whether a run lost hardly more shapes than the echo at the same rate."""
    return run.skipped <= echo.skipped + MOST_SKIPPED * run.sent


def subjects_of(master, workspaces, faces, stack):
    """All subjects of a size, by (label of the workspace, kind, number of tools). The echoes are those of the first
    workspace, whose label is empty."""
    keys = [(label, kind, tools) for tools in TOOLS for label in workspaces for kind in ANSWERERS
            if kind in ECHO or label == '']
    return {key: stack.enter_context(Subject(master, workspaces[key[0]], key[1], faces, key[2])) for key in keys}


def measure_shapes(subjects, faces, seconds):
    """Measures at the highest rate, and those that do not hold it at lower ones, with their echoes."""
    reports = []
    for rate in RATES:
        if rate > HIGHEST_RATE[faces]:
            continue
        runs = run_in_turn(subjects, rate, seconds)
        lost = set()
        for key, run in runs.items():
            label, kind, tools = key
            held = holds(run, runs[echo_of(key)]) if kind in ECHO else None
            if held is False:
                lost |= {key, echo_of(key)}
            reports.append(dict(run.summary(), what='shapes', workspace=label, kind=kind, faces=faces, tools=tools,
                                held=held))
        subjects = {key: subject for key, subject in subjects.items() if key in lost}
        if not subjects:
            break
    return reports


def measure_size(master, workspaces, faces, seconds):
    with contextlib.ExitStack() as stack:
        subjects = subjects_of(master, workspaces, faces, stack)
        return measure_shapes(subjects, faces, seconds)
