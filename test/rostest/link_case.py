"""A test with tools of links that are balls around their frames' origins."""

import oracle
from tool_case import ToolCase


def ball_contacts(mesh, before, after, radius):
    """Of a ball that moves straight from one (centre,) to another; swept, or static if they are
    equal: a shaft whose ends are one."""
    found = oracle.swept_contacts(mesh, before * 2, after * 2, radius)
    return [contact._replace(shaft=0.0) for contact in found]


class LinkCase(ToolCase):
    link_frames = {}  # of each tool that has links: the frames whose origins `step` places

    def frames(self, tool):
        return self.link_frames.get(tool) or super().frames(tool)
