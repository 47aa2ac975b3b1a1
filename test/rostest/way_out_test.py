#!/usr/bin/python3
"""The forces on tools that are wholly inside an organ: along the nearest way out, growing with the
depth, without jumps, and divided among the vertices."""

import sys
import time

from organ_collision.msg import Clearance, ToolPlacement
import rospy
import rostest

from support import scenes
from support.contact_adapter_case import Outputs, STIFFNESS
from support.contact_case import xyz
from support.link_case import LinkCase
from support.node_client import wait_until
from support.vectors import cross, length, sub

BLOCK = scenes.box((0.09, 0.08, 0.06))  # [m] its upper side is at z = 0.03
STEP = 0.001  # [m] that a tool moves between two answers
LOWEST = 0.012  # [m] height of the tip where it turns back; the upper side is the nearest


def heights(start):
    """From `start` down to LOWEST and up again."""
    count = round((start - LOWEST) / STEP)
    down = [start - i * STEP for i in range(count + 1)]
    return down + down[-2::-1]


class WayOutTest(LinkCase):
    link_frames = {'ball': ('ball',)}

    def at(self, tool, height):
        """The tool upright above (0.004, -0.003). The probe is 6 mm long."""
        low = (0.004, -0.003, height)
        if tool == 'ball':
            return {tool: (low,)}
        return {tool: ((0.004, -0.003, height + 0.006), low)}

    def connect(self, tool):
        """Steps above the block until the adapter's outputs come and the node knows the sides."""
        outputs = Outputs('%s/%s' % (self.organ, tool))

        def all_come():
            answer = self.step(BLOCK, self.at(tool, 0.05))[tool]
            return (
                outputs.wrenches
                and outputs.vertex_forces
                and answer.placement.tip == ToolPlacement.OUTSIDE
            )

        wait_until(all_come, 'outputs of ' + self.organ)
        outputs.wait_for(self.stamp)
        return outputs

    def check_vertex_forces(self, outputs, wrench):
        found = outputs.wait_for_vertex_forces(self.stamp)
        forces = [xyz(force) for force in found.forces]
        places = [BLOCK.vertices[vertex] for vertex in found.vertices]
        torques = [cross(*both) for both in zip(places, forces)]
        for vectors, minus in ((forces, wrench.force), (torques, wrench.torque)):
            total = [sum(axis) for axis in zip((0.0, 0.0, 0.0), *vectors)]
            self.assert_near(total, [-x for x in xyz(minus)], 1e-9, 'sum')

    def sink_and_draw_out(self, tool, start):
        """Returns {height: force} of the way down, and checks every answer."""
        outputs = self.connect(tool)
        last, forces, inside = (0.0, 0.0, 0.0), {}, 0
        before_last = time.monotonic()
        for height in heights(start):
            start_of_step = time.monotonic()
            answer = self.step(BLOCK, self.at(tool, height), vertices=True)[tool]
            wrench = outputs.wait_for(self.stamp).wrench
            force = xyz(wrench.force)
            self.check_vertex_forces(outputs, wrench)
            # The last answer came after the last step had begun.
            bound = STIFFNESS * (4 * STEP + 0.05 * (time.monotonic() - before_last))
            before_last = start_of_step
            leaves = not answer.contacts and answer.placement.tip == ToolPlacement.OUTSIDE
            if not leaves:
                self.assertLessEqual(length(sub(force, last)), bound, height)
            if not answer.contacts and answer.placement.tip == ToolPlacement.INSIDE:
                inside += 1
                self.assertEqual(answer.clearance.state, Clearance.KNOWN)
            forces.setdefault(height, force)
            last = force
        self.assertGreater(inside, 10)
        self.assertEqual(last, (0.0, 0.0, 0.0))  # outside again
        return forces

    def check_growth(self, forces, thickness):
        """Wholly inside, the force is stiffness * (distance to the way out + thickness), upward."""
        deepest = forces[min(forces)]
        self.assertAlmostEqual(deepest[0], 0.0, delta=1e-6)
        self.assertAlmostEqual(deepest[1], 0.0, delta=1e-6)
        for height, force in forces.items():
            if height < 0.02:
                self.assertGreater(force[2], 0.0, height)
                self.assertLessEqual(force[2], deepest[2] + 1e-6, height)
        self.assertGreater(deepest[2], STIFFNESS * (0.03 - LOWEST - 0.006))
        self.assertLess(deepest[2], STIFFNESS * (0.03 - LOWEST + thickness))

    def test_a_probe(self):
        self.check_growth(self.sink_and_draw_out('probe', 0.034), 0.004)

    def test_a_ball(self):
        self.check_growth(self.sink_and_draw_out('ball', 0.048), 0.03)


if __name__ == '__main__':
    rospy.init_node('way_out_test')
    rostest.rosrun('organ_collision', 'way_out', WayOutTest, sys.argv)
