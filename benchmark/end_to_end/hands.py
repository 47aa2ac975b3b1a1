"""Latencies from the poses of a hand to the wrenches of haptic_proxy."""

import contextlib
import json
import subprocess
import sys

from latencies import Latencies

SIZES = (1224, 100_000)
TOOL = {'name': 'tool0', 'trocar_frame': 'tool0_trocar', 'tip_pose_topic': '/hand/pose', 'radius': 1.5e-3}


@contextlib.contextmanager
def running(command):
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    try:
        yield
    finally:
        process.terminate()
        process.wait()


def measure(workspace, kind, answerer, faces, seconds):
    command = workspace.command('pose_to_wrench', answerer, faces, seconds)
    done = subprocess.run(command, stdout=subprocess.PIPE, universal_newlines=True, check=False)
    if done.returncode != 0:
        sys.exit(f'end_to_end: {" ".join(command)} failed')
    return [dict(Latencies.of_report(json.loads(line)).summary(), what='poses', workspace='', kind=kind, faces=faces,
                 tools=1, held=None)
            for line in done.stdout.splitlines() if line.startswith('{')]


def measure_hands(master, workspace, faces, seconds):
    master.set_parameters('/haptic_proxy', {'tools': [TOOL]})
    with running(workspace.command('haptic_proxy')):
        reports = measure(workspace, 'haptic_proxy, node', 'external', faces, seconds)
    reports += measure(workspace, 'haptic_proxy, nodelet', 'nodelet', faces, seconds)
    with running(workspace.command('echo_node', 1)):
        reports += measure(workspace, 'messages between processes', 'external', faces, seconds)
    return reports + measure(workspace, 'messages in one process', 'echo', faces, seconds)
