"""A test case for contact_adapter: a probe that presses on tissue, and what the adapter
publishes."""

import diagnostic_msgs.msg
from geometry_msgs.msg import WrenchStamped
from organ_collision.msg import VertexForces
import rospy
from std_msgs.msg import UInt32MultiArray

from . import scenes
from .contact_case import xyz
from .node_client import wait_until
from .tool_case import ToolCase

STIFFNESS = 500.0  # [N/m] in examples/forces.launch
RADIUS = 0.005  # [m] in examples/tools.yaml
TOLERANCE = 1e-6  # [N] or [N m]: vertices are 32-bit floats, and depths are exact to 1e-9 m
SHEET = scenes.sheet(0.1, 4)
TROCAR = (0.013, 0.007, 0.4)


def at_height(height):
    """The tool, straight above (0.013, 0.007), with its tip at this height."""
    return {'probe': (TROCAR, (TROCAR[0], TROCAR[1], height))}


CLEAR = at_height(0.05)
PRESSED = at_height(0.002)  # 3 mm deep


class Outputs:
    """Everything that the adapter publishes about one organ and tool, in order."""

    def __init__(self, pair, node='/contact_adapter'):
        self.wrenches, self.vertex_forces, self.faces = [], [], []
        self.subscribers = [
            rospy.Subscriber('%s/%s/wrench' % (node, pair), WrenchStamped, self.wrenches.append),
            rospy.Subscriber(
                '%s/%s/vertex_forces' % (node, pair), VertexForces, self.vertex_forces.append
            ),
            rospy.Subscriber('%s/%s/faces' % (node, pair), UInt32MultiArray, self.faces.append),
        ]

    def of(self, stamp):
        return [wrench for wrench in self.wrenches if wrench.header.stamp == stamp]

    def wait_for(self, stamp):
        """Waits for the wrench with this stamp."""
        return wait_until(lambda: self.of(stamp), 'the wrench of %s' % stamp)[0]

    def wait_for_vertex_forces(self, stamp):
        """Waits for the vertex forces with this stamp."""
        return wait_until(
            lambda: [forces for forces in self.vertex_forces if forces.header.stamp == stamp],
            'the vertex forces of %s' % stamp,
        )[0]


class Diagnostics:
    """The adapter's latest diagnostics: the text of its summary, and its values."""

    def __init__(self, node='contact_adapter'):
        self.node, self.message, self.values = node, '', {}
        self.subscriber = rospy.Subscriber(
            '/diagnostics', diagnostic_msgs.msg.DiagnosticArray, self._keep
        )

    def _keep(self, array):
        for status in array.status:
            if status.name.lstrip('/') == self.node + ': contacts':
                self.message = status.message
                self.values = {pair.key: pair.value for pair in status.values}

    def wait_for_count(self, key, count):
        wait_until(
            lambda: int(self.values.get(key, 0)) >= count, lambda: '%s: %s' % (key, self.values)
        )


class ContactAdapterCase(ToolCase):
    def connect(self, shape=SHEET, pair=None):
        """Connects to the outputs of this test's organ. Their topics appear with the organ's first
        step, so this sends steps until the outputs arrive."""
        outputs = Outputs(pair or self.organ + '/probe')

        def all_come():
            self.step(shape, CLEAR)
            return outputs.wrenches and outputs.vertex_forces and outputs.faces

        wait_until(all_come, 'outputs of ' + self.organ)
        outputs.wait_for(self.stamp)  # From now on, no earlier wrench can arrive.
        return outputs

    def assert_wrench(self, found, force, torque):
        self.assert_near(xyz(found.wrench.force), force, TOLERANCE, 'force')
        self.assert_near(xyz(found.wrench.torque), torque, TOLERANCE, 'torque')
