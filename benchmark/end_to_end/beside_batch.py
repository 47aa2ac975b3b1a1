"""Latencies from shapes to contacts while batches of motions run."""

import contextlib

from batches import Batches
from latencies import Latencies
from subject import Subject

FACES, TOOLS, RATE = 1224, 1, 1000
MOTIONS = 100_000  # of a batch
BATCHES = {'max_batch': MOTIONS, 'max_batch_bytes': 1_000_000_000}
ROUND = 3.0  # [s]


def measure_subject(subject, batches, seconds):
    """Rounds without and with batches, in turn."""
    rounds = {'no batch': [], 'batches': []}
    motions, passed = 0, 0.0
    for _ in range(max(1, round(seconds / ROUND))):
        rounds['no batch'].append(subject.run_shapes(RATE, ROUND))
        batches.begin('swept', MOTIONS, ROUND)
        rounds['batches'].append(subject.run_shapes(RATE, ROUND))
        report = batches.end()
        motions += report['motions']
        passed += report['seconds']
    return [dict(Latencies.of_rounds(runs).summary(), load=load,
                 motions_per_second=motions / passed if load == 'batches' else None) for load, runs in rounds.items()]


def measure_beside_batch(master, workspaces, seconds):
    reports = []
    for label, workspace in workspaces.items():
        for kind in ('node', 'nodelet'):
            with contextlib.ExitStack() as stack:
                subject = stack.enter_context(Subject(master, workspace, kind, FACES, TOOLS, BATCHES))
                batches = stack.enter_context(Batches(workspace, subject.namespace, FACES, 'shaft'))
                reports += [dict(report, what='beside a batch', workspace=label, kind=kind)
                            for report in measure_subject(subject, batches, seconds)]
    return reports
