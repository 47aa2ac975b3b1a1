#!/usr/bin/python3
"""contact_adapter with its parameters: legal, illegal and misspelt."""

import sys

import rospy
import rostest

from support import scenes
from support.contact_adapter_case import (
    CLEAR,
    PRESSED,
    STIFFNESS,
    TROCAR,
    ContactAdapterCase,
    Diagnostics,
    Outputs,
    at_height,
)
from support.node_client import wait_until
from support.node_starter import NodeStarter
from support.vectors import cross


class ContactAdapterStartTest(ContactAdapterCase, NodeStarter):
    def start_adapter(self, parameters):
        return self.start('/' + self.organ, parameters, 'contact_adapter')

    def test_larger_forces_are_clipped(self):
        """A force of 1.5 N is clipped to 1 N at the same place, and a smaller one is not. The log
        and /diagnostics report it."""
        name, diagnostics = self.organ, Diagnostics(self.organ)
        process = self.start_adapter({'stiffness': STIFFNESS, 'max_force': 1.0})
        outputs = Outputs(self.organ + '/probe', '/' + name)

        def both_come():
            self.step(scenes.one_face(), CLEAR)
            return outputs.wrenches

        wait_until(both_come, 'the wrenches of ' + name)
        self.step(scenes.one_face(), at_height(0.004), vertices=True)
        place = (TROCAR[0], TROCAR[1], 0.0)
        force = (0.0, 0.0, STIFFNESS * 0.001)
        self.assert_wrench(outputs.wait_for(self.stamp), force, cross(place, force))
        self.step(scenes.one_face(), PRESSED, vertices=True)
        self.assert_wrench(
            outputs.wait_for(self.stamp), (0.0, 0.0, 1.0), cross(place, (0.0, 0.0, 1.0))
        )
        diagnostics.wait_for_count('clipped, max_force', 1)
        self.assertIn('the force is clipped to 1.000000 N', self.stop(process))

    def test_illegal_stiffness_stops_the_node(self):
        for stiffness, shown in (
            (0, "'0'"),
            (-12.5, "'-12.5'"),
            ('soft', "'soft'"),
            (float('nan'), "'nan'"),
            (float('inf'), "'inf'"),
        ):
            self.assert_refused(
                self.start_adapter({'stiffness': stiffness}),
                ['~stiffness is %s; must be a number, more than 0' % shown],
            )

    def test_misspelt_names_are_reported(self):
        diagnostics = Diagnostics(self.organ)
        process = self.start_adapter({'stifness': 500})
        wait_until(lambda: 'stifness' in diagnostics.message, lambda: diagnostics.message)
        self.assertIn("stifness is no parameter; nearest is 'stiffness'", self.stop(process))


if __name__ == '__main__':
    rospy.init_node('contact_adapter_start_test')
    rostest.rosrun('organ_collision', 'forces_start', ContactAdapterStartTest, sys.argv)
