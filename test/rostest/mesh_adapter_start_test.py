#!/usr/bin/python3
"""How organ_mesh_adapter starts. Illegal parameters stop it with a message, misspelt ones are
reported, and it can take over from another adapter."""

import sys

from organ_collision.msg import OrganMesh
import rospy
import rostest

from support import scenes
from support.foreign_meshes import shape_mesh
from support.mesh_adapter_case import MeshAdapterCase, MessageLog
from support.node_client import wait_until
from support.node_starter import NodeStarter

ORGAN = {'name': 'liver', 'topic': '/restart/liver', 'frame': 'liver_frame'}
# Words that the message must contain: the parameter, the value, what is legal.
ILLEGAL = [
    ({}, ['organs', 'missing', 'list']),
    ({'organ': [ORGAN]}, ['organs', 'missing', "'organs'"]),
    ({'organs': 'liver'}, ['organs', 'liver', 'list']),
    ({'organs': ['liver']}, ['organs[0]', 'liver', 'group']),
    ({'organs': [dict(ORGAN, topic='a b')]}, ['organs[0]/topic', 'a b']),
    ({'organs': [dict(ORGAN, topic='~liver')]}, ['organs[0]/topic', '~liver', 'private']),
    ({'organs': [dict(ORGAN, frame='')]}, ['organs[0]/frame', 'not empty']),
    ({'organs': [{'name': 'liver'}]}, ['organs[0]/topic', 'missing']),
    ({'organs': [ORGAN, dict(ORGAN, topic='/other')]}, ['organs[1]/name', 'liver', 'unique']),
    ({'organs': [ORGAN, dict(ORGAN, name='other')]}, ['organs[1]/topic', 'liver', 'unique']),
    ({'organs': [dict(ORGAN, vertices_topic=7)]}, ['organs[0]/vertices_topic', '7', 'text']),
    ({'organs': [ORGAN], 'collision_node': ''}, ['collision_node', 'not empty']),
]
SHEET = scenes.sheet(0.1, 4).moved(lambda v: (v[0], v[1], v[2] + 0.1 * v[0]))
FINE = scenes.sheet(0.1, 7)


class MeshAdapterStartTest(MeshAdapterCase, NodeStarter):
    def start_adapter(self, name, parameters):
        return self.start(name, parameters, 'organ_mesh_adapter')

    def test_illegal_parameters(self):
        started = [
            (self.start_adapter('/illegal_%d' % i, parameters), words)
            for i, (parameters, words) in enumerate(ILLEGAL)
        ]
        for process, words in started:
            self.assert_refused(process, words)

    def test_misspelt_names_are_reported(self):
        parameters = {'organs': [dict(ORGAN, frame_id='liver')], 'collision': '/organ_collision'}
        process = self.start_adapter('/misspelt', parameters)
        self.publish('/restart/liver', shape_mesh(SHEET), '/misspelt')
        printed = self.stop(process)
        for words in ("~collision is no parameter; nearest is 'collision_node'", '/frame_id is no'):
            self.assertIn(words, printed)

    def test_a_restarted_adapter_is_not_taken_for_the_old_one(self):
        """The collision node still has the old adapter's triangles and topology number."""
        for name, mesh in (('/first', SHEET), ('/second', FINE), ('/third', SHEET)):
            process = self.start_adapter(name, {'organs': [ORGAN]})
            self.publish('/restart/liver', shape_mesh(mesh), name)
            self.wait_for_contacts('liver', mesh)
            self.stop(process)

    def test_another_collision_node(self):
        parameters = {'organs': [ORGAN], 'collision_node': 'theatre/collisions'}
        process = self.start_adapter('/elsewhere', parameters)
        meshes = MessageLog('/theatre/collisions/organ_mesh', OrganMesh)
        self.publish('/restart/liver', shape_mesh(SHEET), '/elsewhere')
        wait_until(lambda: meshes.of('liver'), 'a mesh for the other node')
        self.stop(process)


if __name__ == '__main__':
    rospy.init_node('mesh_adapter_start_test')
    rostest.rosrun('organ_collision', 'mesh_adapter_start', MeshAdapterStartTest, sys.argv)
