#!/usr/bin/python3
"""Measures the latencies of the running node and nodelet, and of roscpp alone.

Usage: end_to_end.py PROGRAM FOLDER SECONDS [FACES ...]

PROGRAM is the built end_to_end, with its other programs beside it; the setup.bash of its workspace must be sourced. The script starts its own ROS master
and writes end_to_end.json and end_to_end.md into FOLDER. Each measurement takes SECONDS."""

import contextlib
import json
import os
import pathlib
import socket
import subprocess
import sys
import tempfile
import time
import xmlrpc.client

TOOLS = (1, 4)
RADIUS = {1224: 5e-3, 100_000: 5.53e-4, 1_000_000: 1.75e-4}  # [m]; the same as SceneScale in tool_motions.cpp
HAND_TOOL = {'name': 'tool0', 'trocar_frame': 'tool0_trocar', 'tip_pose_topic': '/hand/pose', 'radius': 1.5e-3}
HAND_SIZES = (1224, 100_000)
WHAT = {'shapes': 'shape to contacts', 'service': 'service call', 'poses': 'pose to wrench'}


def free_port():
    with socket.socket() as any_socket:
        any_socket.bind(('', 0))
        return any_socket.getsockname()[1]


class Master:
    """A roscore that runs until its `with` block ends."""

    def __enter__(self):
        os.environ['ROS_MASTER_URI'] = f'http://localhost:{free_port()}'
        self.process = subprocess.Popen(['roscore', '-p', os.environ['ROS_MASTER_URI'].rsplit(':', 1)[1]],
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.proxy = xmlrpc.client.ServerProxy(os.environ['ROS_MASTER_URI'])
        self.wait_for(lambda: self.proxy.lookupNode('/end_to_end', '/rosout')[0] == 1)
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()

    def set_tools(self, count, radius):
        tools = [{'name': f'tool{i}', 'trocar_frame': f'tool{i}_trocar', 'tip_frame': f'tool{i}_tip',
                  'radius': radius} for i in range(count)]
        self.proxy.setParam('/end_to_end', '/organ_collision', {'tools': tools})

    def wait_for_node(self):
        self.wait_for(lambda: self.proxy.lookupService('/end_to_end', '/organ_collision/query')[0] == 1)

    @staticmethod
    def wait_for(condition, seconds=30):
        give_up = time.monotonic() + seconds
        while True:
            try:
                if condition():
                    return
            except OSError:
                pass  # not listening yet
            if time.monotonic() > give_up:
                sys.exit('end_to_end.py: no answer from roscore or /organ_collision')
            time.sleep(0.05)


def resident_bytes(process):
    status = pathlib.Path(f'/proc/{process.pid}/status').read_text()
    return 1024 * int(status.split('VmRSS:')[1].split()[0])


def run(arguments, settled, **about):
    """Runs a program and returns its reports, with what they are about. Calls settled() at its report of settling."""
    reports = []
    with subprocess.Popen(arguments, stdout=subprocess.PIPE, universal_newlines=True) as process:
        for line in process.stdout:
            if not line.startswith('{'):
                continue
            report = json.loads(line)
            if report['what'] == 'settling':
                settled()
            else:
                reports.append(dict(report, **about))
    if process.returncode != 0:
        sys.exit(f'end_to_end.py: {" ".join(map(str, arguments))} failed')
    return reports


def measure(kind, program, answerer, faces, tools, seconds, settled=lambda: None):
    """From shapes to contacts. Calls settled() after the node has received some shapes at a low rate."""
    return run([program, answerer, str(faces), str(tools), str(seconds)], settled, kind=kind, faces=faces, tools=tools)


def measure_hand(kind, program, answerer, faces, seconds):
    """From the poses of a hand to wrenches."""
    arguments = [program.with_name('pose_to_wrench'), answerer, str(faces), str(seconds)]
    return run(arguments, lambda: None, kind=kind, faces=faces, tools=1)


@contextlib.contextmanager
def running(*arguments):
    process = subprocess.Popen(arguments, stdout=subprocess.DEVNULL)
    try:
        yield process
    finally:
        process.terminate()
        process.wait()


def measure_echo(program, faces, tools, seconds):
    with running(program.with_name('echo_node'), str(tools)):
        reports = measure('messages between processes', program, 'external', faces, tools, seconds)
    return reports + measure('messages in one process', program, 'echo', faces, tools, seconds)


def measure_node(master, program, faces, tools, seconds):
    with running(program.with_name('organ_collision_node'), '__name:=organ_collision') as node:
        master.wait_for_node()
        idle, memory = resident_bytes(node), []
        reports = measure('node', program, 'external', faces, tools, seconds,
                          lambda: memory.append(resident_bytes(node)))
        return [dict(report, bytes_per_face=(memory[0] - idle) / faces) for report in reports]


def measure_hands(program, faces, seconds):
    with running(program.with_name('haptic_proxy')):
        reports = measure_hand('haptic_proxy, node', program, 'external', faces, seconds)
    reports += measure_hand('haptic_proxy, nodelet', program, 'nodelet', faces, seconds)
    with running(program.with_name('echo_node'), '1'):
        reports += measure_hand('messages between processes', program, 'external', faces, seconds)
    return reports + measure_hand('messages in one process', program, 'echo', faces, seconds)


def table(reports):
    lines = ['| | faces | tools | rate, Hz | sent | skipped | median, µs | 99th percentile | worst | bytes a face |',
             '|---|---|---|---|---|---|---|---|---|---|']
    for r in reports:
        what = f"{r['kind']}, {WHAT[r['what']]}"
        memory = f"{r['bytes_per_face']:.0f}" if 'bytes_per_face' in r and r['what'] == 'shapes' else ''
        rate = f"{r['rate']:.0f}" if r['rate'] else ''
        lines.append(f"| {what} | {r['faces']} | {r['tools']} | {rate} | {r['sent']} | {r['skipped'] + r['failed']} "
                     f"| {r['median']:.0f} | {r['p99']:.0f} | {r['worst']:.0f} | {memory} |")
    return '\n'.join(lines) + '\n'


def main():
    program, folder, seconds = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), float(sys.argv[3])
    sizes = [int(size) for size in sys.argv[4:]] or list(RADIUS)
    reports = []
    with tempfile.TemporaryDirectory() as home:
        os.environ['ROS_HOME'] = home
        with Master() as master:
            master.proxy.setParam('/end_to_end', '/haptic_proxy', {'tools': [HAND_TOOL]})
            for faces in sizes:
                if faces in HAND_SIZES:
                    print(f'{faces} faces, a hand', flush=True)
                    reports += measure_hands(program, faces, seconds)
                for tools in TOOLS:
                    master.set_tools(tools, RADIUS[faces])
                    print(f'{faces} faces, {tools} tools', flush=True)
                    reports += measure_node(master, program, faces, tools, seconds)
                    reports += measure('nodelet', program, 'nodelet', faces, tools, seconds)
                    if tools == 1:
                        reports += measure_echo(program, faces, tools, seconds)
    (folder / 'end_to_end.json').write_text(json.dumps(reports, indent=1) + '\n')
    (folder / 'end_to_end.md').write_text('# End to end\n\n' + table(reports))


if __name__ == '__main__':
    main()
