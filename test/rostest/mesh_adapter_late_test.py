#!/usr/bin/python3
"""A collision node that starts after the organs gets each of them in its present shape."""

import sys

from organ_collision.msg import ContactArray, OrganMesh, OrganVertices
import rospy
import rostest
from visualization_msgs.msg import Marker

from support import scenes
from support.foreign_meshes import cloud, deletion, marker, polygon_mesh, shape_mesh
from support.mesh_adapter_case import RADIUS, MeshAdapterCase, MessageLog
from support.node_client import FAR_AWAY, NodeClient, wait_until
from support.node_starter import NodeStarter

SHEET = scenes.sheet(0.1, 4).moved(lambda v: (v[0], v[1], v[2] + 0.1 * v[0]))
LOWER = SHEET.moved(lambda v: (v[0], v[1], v[2] + 0.03 * v[1] - 0.002))
LOWEST = SHEET.moved(lambda v: (1.1 * v[0], v[1], v[2] - 0.003))
FINE = scenes.sheet(0.1, 7)
TOOL = {'name': 'grasper', 'trocar_frame': 'trocar', 'tip_frame': 'tip', 'radius': RADIUS}


class MeshAdapterLateTest(MeshAdapterCase, NodeStarter):
    adapter = '/early_adapter'

    def send_organs(self, stamp):
        """Sends four organs, moves one by points and one by a new marker, and removes one. Waits
        until the adapter has published all of this."""
        meshes = MessageLog('/late/organ_mesh', OrganMesh)
        shapes = MessageLog('/late/organ_vertices', OrganVertices)
        self.publish('/early/first', shape_mesh(FINE))
        self.publish('/early/second', polygon_mesh(SHEET))
        self.publish('/early/third', marker(SHEET))
        self.publish('/early/gone', marker(SHEET))
        for organ in ('first', 'second', 'third', 'gone'):
            wait_until(lambda: meshes.of(organ), 'mesh of ' + organ)
        self.publish('/early/second_points', cloud(LOWER.vertices, stamp=stamp))
        self.publish('/early/third', marker(LOWEST))
        self.publish('/early/gone', deletion(Marker.DELETE))
        for organ in ('second', 'third'):
            wait_until(lambda: shapes.of(organ), 'vertices of ' + organ)
        wait_until(lambda: not meshes.of('gone')[-1].triangles, 'the removal')
        meshes.subscriber.unregister()

    def test_a_late_node_gets_every_organ_as_it_is(self):
        stamp = rospy.Time.now()
        self.send_organs(stamp)
        first = FINE
        for step in range(2):
            process = self.start('/late', {'tools': [TOOL]})
            node = NodeClient('/late')
            self.wait_for_contacts('first', first, node)
            self.assertEqual(self.wait_for_contacts('second', LOWER, node).mesh_stamp, stamp)
            self.wait_for_contacts('third', LOWEST, node)
            gone = node.query('gone', FAR_AWAY)
            self.assertEqual(gone.status, ContactArray.UNKNOWN_ORGAN)

            first = FINE.moved(lambda v: (v[0], v[1], v[2] + 0.1 * v[1] - 0.001 * step))
            self.publish('/early/first', shape_mesh(first))
            self.wait_for_contacts('first', first, node)
            node.close()
            self.stop(process)
        self.check_numbers()

    def check_numbers(self):
        """The numbers of the meshes go on behind those with which a new subscriber is greeted."""
        late = MessageLog('/late/organ_mesh', OrganMesh)
        wait_until(lambda: late.of('third'), 'the greeting')
        greeting = late.of('third')[-1].header.seq
        self.publish('/early/third', marker(FINE))
        wait_until(lambda: len(late.of('third')) > 1, 'the next mesh')
        self.assertEqual(late.of('third')[-1].header.seq, greeting + 1)


if __name__ == '__main__':
    rospy.init_node('mesh_adapter_late_test')
    rostest.rosrun('organ_collision', 'mesh_adapter_late', MeshAdapterLateTest, sys.argv)
