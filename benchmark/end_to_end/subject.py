"""What is measured: a node, a nodelet or an echo, with the simulator that measures it."""

import itertools
import pathlib
import subprocess

from latencies import Latencies
from program import Program

RADIUS = {1224: 5e-3, 100_000: 5.53e-4, 1_000_000: 1.75e-4}  # [m]; the same as SceneScale in tool_motions.cpp
# What answers, as end_to_end names it, and the program that answers in a process of its own.
ANSWERERS = {'node': ('external', 'organ_collision_node'), 'nodelet': ('nodelet', None),
             'messages between processes': ('external', 'echo_node'), 'messages in one process': ('echo', None)}
ECHO = {'node': 'messages between processes', 'nodelet': 'messages in one process'}
OF_ALL = ('/tf', '/tf_static', '/diagnostics')  # topics outside of any namespace

_numbers = itertools.count()


def tools_for(faces, count):
    """The parameter `tools` of the node."""
    return [{'name': f'tool{i}', 'trocar_frame': f'tool{i}_trocar', 'tip_frame': f'tool{i}_tip',
             'radius': RADIUS[faces]} for i in range(count)]


class Workspace:
    """A built workspace, whose programs run in its environment."""

    def __init__(self, devel):
        self.devel = pathlib.Path(devel).resolve()

    def command(self, program, *arguments):
        return [str(self.devel / 'env.sh'), str(self.devel / 'lib' / 'organ_collision' / program), *map(str, arguments)]


class Subject:
    """Several subjects may be alive at once, each in a namespace of its own, and be measured in turn: the speed of a
    machine drifts, and only what is measured in turn can be compared."""

    def __init__(self, master, workspace, kind, faces, tools):
        self.kind, self.faces, self.tools = kind, faces, tools
        self.namespace = f'/subject{next(_numbers)}'
        self.node = None
        names = [f'__ns:={self.namespace}'] + [f'{topic}:={self.namespace}{topic}' for topic in OF_ALL]
        master.set_parameters(f'{self.namespace}/organ_collision', {'tools': tools_for(faces, tools)})
        answerer, program = ANSWERERS[kind]
        if kind == 'node':
            self.node = subprocess.Popen(workspace.command(program, '__name:=organ_collision', *names),
                                         stdout=subprocess.DEVNULL)
            master.wait_for_service(f'{self.namespace}/organ_collision/query')
        elif program:
            self.node = subprocess.Popen(workspace.command(program, tools, *names), stdout=subprocess.DEVNULL)
        self.simulator = Program(workspace.command('end_to_end', answerer, faces, tools, *names))
        self.simulator.read_line()
        self.run_shapes(20.0, 1.0)

    def run_shapes(self, rate, seconds):
        """The latencies from shapes that are sent at a rate [Hz] to the contacts of the last tool."""
        return Latencies.of_report(self.simulator.ask(f'shapes {rate} {seconds}'))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.simulator.__exit__()
        if self.node:
            self.node.terminate()
            self.node.wait()
