"""The scene of the tests of motion: a sheet, and a tool that stands straight above it."""

from . import scenes

SHEET = scenes.sheet(0.1, 4)
TROCAR = (0.013, 0.007, 0.4)
RADIUS = 0.005


def at_height(height):
    """The tool, straight above (0.013, 0.007), with its tip at this height."""
    return (TROCAR, (TROCAR[0], TROCAR[1], height))


def depth_at(height, radius=RADIUS):
    """How deep the tool's deepest contact with the sheet is [m]."""
    return radius - height
