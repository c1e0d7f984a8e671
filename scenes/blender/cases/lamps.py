"""Fields of lamps."""

import math

import bpy

from .build import TILT, Case, black_world, lamp

SPREAD = "area lamps with a spread:"
EDGE = "spots with a soft edge"
RADIUS = "point and spot lamps with a radius"
SHAPE = "round area lamps"


def point(**fields):
    return lambda: lamp("POINT", **fields)


def spot(**fields):
    return lambda: lamp("SPOT", **fields)


def sun(**fields):
    return lambda: lamp("SUN", turn=(0.5, 0.2, 0), **fields)


def area(**fields):
    return lambda: lamp("AREA", **{"place": (0, 0, 3), "turn": TILT, **fields})


def portal():
    """Cycles of Blender 5.0 crashes on a portal without a world."""
    bpy.context.scene.world = black_world()
    area(size=1)().data.cycles.is_portal = True


CASES = {
    "point": Case(point()),
    "point exposure": Case(point(exposure=1)),
    "point temperature": Case(point(use_temperature=True, temperature=3000)),
    "point temperature, colour": Case(point(use_temperature=True, temperature=9000, color=(1, 0.5, 0.2))),
    "point radius": Case(point(shadow_soft_size=0.1), RADIUS),
    "point normalize off": Case(point(shadow_soft_size=0.1, normalize=False), RADIUS),
    "point normalize off, no radius": Case(point(normalize=False)),
    "point scaled": Case(point(shadow_soft_size=0.1, normalize=False, scale=(2, 2, 2)), RADIUS),
    "point negative": Case(point(energy=-500), "lamps of negative power", agrees=False),
    "point without power": Case(point(energy=0), "nothing in the scene gives light", lit=False),
    "sun": Case(sun()),
    "sun angle": Case(sun(angle=0.2), "suns with an angle"),
    "sun normalize off, no angle": Case(sun(normalize=False)),
    "sun normalize off": Case(sun(angle=0.5, normalize=False), "suns with an angle"),
    "sun temperature": Case(sun(use_temperature=True, temperature=4000)),
    "spot": Case(spot(spot_size=1.2)),
    "spot blend 0.15": Case(spot(spot_size=1.2, spot_blend=0.15), EDGE, tolerance=0.05),
    "spot blend 1": Case(spot(spot_size=1.5, spot_blend=1), EDGE, tolerance=0.1),
    "spot 180, blend 1": Case(spot(spot_size=math.pi, spot_blend=1), EDGE, tolerance=0.1),
    "spot 1 degree": Case(spot(place=(0, 0, 300), spot_size=math.radians(1), energy=1e6)),
    "spot scaled": Case(spot(spot_size=0.7, scale=(2, 2, 1))),
    "spot elliptical": Case(spot(spot_size=0.9, scale=(2, 1, 1)), "spots scaled unequally", agrees=False),
    "spot mirrored": Case(spot(turn=(math.pi, 0, 0), spot_size=1.2, scale=(1, 1, -1))),
    "spot normalize off": Case(spot(spot_size=1.2, normalize=False)),
    "spot temperature": Case(spot(spot_size=1.2, use_temperature=True, temperature=2000)),
    "area": Case(area(size=1)),
    "area rectangle": Case(area(shape="RECTANGLE", size=2, size_y=0.5)),
    "area disk": Case(area(shape="DISK", size=1), SHAPE),
    "area ellipse": Case(area(shape="ELLIPSE", size=2, size_y=0.5), SHAPE),
    "area scaled": Case(area(size=1, scale=(2, 0.5, 1))),
    "area mirrored in x": Case(area(size=1, scale=(-1, 1, 1))),
    "area mirrored in z": Case(area(size=1, scale=(1, 1, -1)), lit=False),
    "area mirrored in all": Case(area(size=1, turn=(math.pi + 0.3, 0.1, 0), scale=(-1, -1, -1))),
    "area portal": Case(portal, lit=False),
    "area colour": Case(area(size=1, color=(1, 0.5, 0.1))),
    "area temperature": Case(area(size=1, use_temperature=True, temperature=3000)),
    "area exposure": Case(area(size=1, exposure=-1)),
    "area normalize off": Case(area(size=2, normalize=False)),
    "area normalize off, disk, scaled": Case(area(size=2, shape="DISK", normalize=False, scale=(2, 1, 1)), SHAPE),
    "area size 0": Case(area(size=0), "area lamps of no size", lit=False),
    "area spread 60": Case(area(size=1, spread=math.radians(60)), SPREAD, tolerance=0.15),
    "area spread 120": Case(area(size=1, spread=math.radians(120)), SPREAD, tolerance=0.1),
    "area spread 1, disk, normalize off": Case(
        area(size=0.5, shape="DISK", place=(0, 0, 2.3), spread=math.radians(1), normalize=False), SPREAD, agrees=False
    ),
    "area spread 90, scaled": Case(area(size=0.5, scale=(3, 1, 1), spread=math.radians(90)), SPREAD, tolerance=0.15),
    "area spread 170": Case(area(size=1, spread=math.radians(170)), "between 164 and 180", agrees=False),
}
