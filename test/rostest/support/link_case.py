"""A test case with tools whose links are balls around the origins of their frames."""

from . import oracle
from .tool_case import ToolCase


def ball_contacts(mesh, before, after, radius):
    """The contacts of a ball whose centre moves on a straight line from `before` to `after`, each a
    tuple (centre,). For the oracle, the ball is a shaft whose trocar is its tip."""
    found = oracle.swept_contacts(mesh, before * 2, after * 2, radius)
    return [contact._replace(shaft=0.0) for contact in found]


class LinkCase(ToolCase):
    link_frames = {}  # {tool with links: its frames, whose origins `step` places}

    def frames(self, tool):
        return self.link_frames.get(tool) or super().frames(tool)
