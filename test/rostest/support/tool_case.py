"""A test case with tools that move by TF. Its points are in the organ's frame, which is rotated and shifted in the
world. The tools' frames are sent in the world frame."""

from organ_collision.msg import ContactArray
import rospy

from . import oracle, scenes
from .contact_case import ContactCase
from .node_client import NodeClient, TfSender, wait_until

WORLD_LIVER = scenes.Pose((0.2, 0.35, -0.1, 0.9), (0.7, -0.4, 1.1))
STEP = rospy.Duration(0, 10**7)
OUT_OF_REACH = 'out_of_reach'  # an organ that no tool touches


def ball_contacts(mesh, before, after, radius):
    """The contacts of a ball whose centre moves on a straight line from `before` to `after`, each a tuple (centre,).
    For the oracle, the ball is a shaft whose trocar is its tip."""
    found = oracle.swept_contacts(mesh, before * 2, after * 2, radius)
    return [contact._replace(shaft=0.0) for contact in found]


class ToolCase(ContactCase):
    link_frames = {}  # {tool with links: its frames, whose origins `place` places}

    @classmethod
    def setUpClass(cls):
        cls.node = NodeClient()
        cls.tf = TfSender()
        cls.tf.wait_for(cls.node)
        cls.tf.send_resting(('world', 'liver_frame', WORLD_LIVER))
        cls.stamp = rospy.Time.now()
        far_away = scenes.one_face().moved(lambda v: (v[0] + 100.0, v[1], v[2]))
        cls.node.send_mesh(OUT_OF_REACH, far_away)
        cls.node.wait_for_shape(OUT_OF_REACH, rospy.Time())

    def setUp(self):
        self.organ = self.id().split('.')[-1]

    @classmethod
    def next_stamp(cls, step=STEP):
        """The next stamp, one step of 10 ms later. Stamps rise from test to test, too."""
        cls.stamp += step
        return cls.stamp

    def place(self, tool, *way):
        """Sends the tool's frames at each (axis, stamp) of `way`. The axis is (trocar, tip) in the organ's frame, or
        one point for each of the tool's frames."""
        frames = self.link_frames.get(tool) or (tool + '_trocar', tool + '_tip')
        turn = (0.1, 0.2, 0.3, 0.9)
        self.tf.send(*[('world', frame, scenes.Pose(turn, WORLD_LIVER.apply(point)), stamp)
                       for axis, stamp in way for frame, point in zip(frames, axis)])

    def place_and_wait(self, tool, axis, stamp):
        """Sends the tool's frames at one time, and waits until the node has received them."""

        def is_there():
            result = self.node.query(OUT_OF_REACH, tool=tool, stamp=stamp)
            seen[:] = [result.status, result.message]
            return result.status == ContactArray.OK

        seen = []
        self.place(tool, (axis, stamp))
        wait_until(is_there, lambda: 'the pose of %s at %s: %s' % (tool, stamp, seen))

    def step(self, shape, tools, topology=1, vertices=False, step=STEP):
        """One step: the tools are at `tools` ({name: axis}) when the organ has this shape. Returns {name: the
        ContactArray about this tool}. The poses are sent first, so that the node never has to wait for a transform."""
        return self.step_of_organs({self.organ: shape}, tools, topology, vertices, step)[self.organ]

    def step_of_organs(self, shapes, tools, topology=1, vertices=False, step=STEP):
        """One step of several organs, {organ: shape}. Returns {organ: {tool: ContactArray}}."""
        stamp = self.next_stamp(step)
        for tool, axis in tools.items():
            self.place_and_wait(tool, axis, stamp)
        send = self.node.send_vertices if vertices else self.node.send_mesh
        for organ, shape in shapes.items():
            send(organ, shape, stamp, topology)
        return {organ: {tool: self.node.contacts.wait_for(organ, tool, mesh_stamp=stamp) for tool in tools}
                for organ in shapes}
