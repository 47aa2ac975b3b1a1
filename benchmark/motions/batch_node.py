"""A node that answers batches of motions, with a client that asks."""

import itertools
import subprocess

from batches import Batches

MOTIONS = {'shaft': 20_000, 'grasper': 1000}  # of a batch
GRASPER = {'name': 'grasper', 'trocar_frame': 'trocar', 'tip_frame': 'tip', 'radius': 0.0025,
           'links': ['wrist', 'left_jaw', 'right_jaw']}

_numbers = itertools.count()


class BatchNode:
    """`folder` has the files of Library.write_files()."""

    def __init__(self, master, workspace, faces, tool, threads, folder):
        self.tool = tool
        namespace = f'/batch_node{next(_numbers)}'
        tools = [dict(GRASPER, urdf=f'{folder}/robot.urdf')] if tool == 'grasper' else []
        master.set_parameters(f'{namespace}/organ_collision', {
            'tools': tools, 'threads': threads, 'max_batch': MOTIONS['shaft'], 'max_batch_bytes': 1_000_000_000})
        self.node = subprocess.Popen(
            workspace.command('organ_collision_node', f'__ns:={namespace}', '__name:=organ_collision'),
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.client = Batches(workspace, namespace, faces, tool)
        self.client.publish_organ()

    def rate(self, mode, seconds):
        """The motions a second."""
        self.client.begin(mode, MOTIONS[self.tool], seconds)
        report = self.client.end()
        return report['motions'] / report['seconds']

    def __enter__(self):
        return self

    def __exit__(self, *arguments):
        self.client.__exit__(*arguments)
        self.node.terminate()
        self.node.wait()
