"""Small scenes, each with one thing that a Blender file may hold, for `from_blender_test.py`."""

from . import emitters, lamps, nodes, shown

CASES = {**lamps.CASES, **nodes.CASES, **shown.CASES, **emitters.CASES}
