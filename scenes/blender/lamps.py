"""What carries the light of a lamp of Blender's in glTF?

Points, spots and suns are lamps in both. The edge of a spot and the spread of an area lamp, which glTF has otherwise or not
at all, are those of Cycles' source: `kernel/light/spot.h`, `kernel/light/area.h` and `scene/light.cpp`.
"""

import math
from typing import NamedTuple

from mathutils import Matrix, Vector

from .power import power_of

# A ramp of glTF, the square of a linear one, that begins so far below the ramp of a soft spot of Blender's, a smooth step,
# is nearest to it. Both in parts of that ramp, which is linear in the cosine.
RAMP_BELOW = 0.185
# A lamp with a spread of more is nearer to an emitter without one; in degrees.
SPREAD_OF_SPOTS = 164
# An area lamp with a spread becomes so many spots along each side.
SPOTS_ALONG = 4
# Blender has no narrower spots; degrees.
NARROWEST = 1.0


class Lamp(NamedTuple):
    """A lamp that glTF has: power in Blender's watts, or W/m^2 for a sun; half-angles of a spot."""

    name: str
    kind: str
    matrix: Matrix
    power: tuple
    outer: float = 0.0
    inner: float = 0.0


class Quad(NamedTuple):
    """An emissive quad, seen counter-clockwise from where it shines."""

    name: str
    corners: list
    radiance: tuple


def read(thing, matrix, of_gltf, notes):
    """What carries the light of the lamp object `thing` at `matrix`: a list, empty if it gives none.

    `of_gltf`: the file that Blender opened is glTF, whose spots go through Blender's fields and come out as they were.
    """
    name, data = thing.name, thing.data
    if data.type == "AREA" and data.cycles.is_portal:
        return []
    if not thing.visible_diffuse:
        notes.add(name, "lamps that are not visible to diffuse rays", "they shine on nothing here, as in Cycles")
        return []
    power = power_of(name, data, notes)
    if min(power) < 0:
        notes.add(name, "left out: lamps of negative power or colour", "glTF has none; take their light from other lamps")
        return []
    if max(power) == 0:
        return []
    tell_what_changes(thing, notes)
    if data.type == "AREA":
        return area(name, data, matrix, power, notes)
    upright = Matrix.LocRotScale(matrix.to_translation(), facing(-matrix.col[2].xyz), None)
    if data.type == "SPOT":
        return [spot(name, data, matrix, upright, power, of_gltf, notes)]
    return [Lamp(name, data.type, upright, power)]


def facing(direction):
    """A rotation that turns -z to `direction`."""
    return direction.to_track_quat("-Z", "Y") if direction.length > 0 else Matrix.Identity(3).to_quaternion()


def tell_what_changes(thing, notes):
    """Adds a note for each property that neither glTF nor citylights has."""
    name, data = thing.name, thing.data
    if data.type == "SUN" and data.angle > 0:
        notes.add(name, "suns with an angle", "of the same irradiance, but their shadows are hard")
    if data.type in ("POINT", "SPOT") and data.shadow_soft_size > 0:
        notes.add(
            name,
            "point and spot lamps with a radius",
            "of the same power, but points: their shadows are hard, and within a few radii the light differs; an emissive "
            "sphere in place of a lamp is carried with its size",
        )
    if not data.use_shadow:
        notes.add(name, "lamps that cast no shadow", "they do here")
    tell_of_linking(thing, notes)


def tell_of_linking(thing, notes):
    """Adds a note if a lamp or an emitter lights or is blocked by some objects only."""
    linking = thing.light_linking
    if linking.receiver_collection or linking.blocker_collection:
        notes.add(thing.name, "lights that are linked to some objects", "they light all, and all block them")


def spot(name, data, matrix, upright, power, of_gltf, notes):
    """A spot whose edge is as near to Blender's as glTF's comes, of the same flux and peak."""
    if of_gltf:
        if data.spot_blend > 0:
            notes.add(name, "spots with a soft edge, as glTF has it", "carried as they were; Cycles shows them with another edge")
        outer = data.spot_size / 2
        return Lamp(name, "SPOT", upright, power, outer, outer * (1 - data.spot_blend))
    scale = [column.length for column in (matrix.col[0].xyz, matrix.col[1].xyz, matrix.col[2].xyz)]
    if min(scale) == 0:
        scale = [1, 1, 1]
    if not math.isclose(scale[0], scale[1], rel_tol=1e-3):
        notes.add(name, "spots scaled unequally across", "their cones are elliptical in Cycles, and round here")
    # The cone is scaled with the lamp.
    wider = math.sqrt(scale[0] * scale[1]) / scale[2]

    def scaled(cosine):
        return math.cos(math.atan2(math.sqrt(max(1 - cosine * cosine, 0)) * wider, cosine))

    edge = max(math.cos(data.spot_size / 2), 0.0)
    low, high = scaled(edge), scaled(edge + (1 - edge) * data.spot_blend)
    ramp = high - low
    if ramp > 0:
        below = min(RAMP_BELOW, low / ramp)
        high = low + (0.75 + below / 2) * ramp
        low -= below * ramp
        notes.add(
            name,
            "spots with a soft edge",
            "of the same flux and peak, but glTF has another ramp: within it the intensity is off by up to 7 % of the peak, "
            "by up to 16 % where the cone is nearly 180 degrees; a blend of 0 is exact",
        )
    outer, inner = math.acos(low), math.acos(min(high, 1.0))
    narrowest = math.radians(NARROWEST) / 2
    if outer < narrowest:
        # Scaled below what Blender's lamps have: widened, its flux kept.
        power = tuple(channel * (outer / narrowest) ** 2 for channel in power)
        outer, inner = narrowest, inner * narrowest / outer
    return Lamp(name, "SPOT", upright, power, outer, inner)


def area(name, data, matrix, power, notes):
    """A quad of the same power that shines along the lamp's -z; or spots, if it has a spread."""
    width = data.size
    height = data.size_y if data.shape in ("RECTANGLE", "ELLIPSE") else data.size
    if data.shape in ("DISK", "ELLIPSE"):
        width, height = (side * math.sqrt(math.pi) / 2 for side in (width, height))
        notes.add(name, "round area lamps", "rectangles of the same area: the light within a width of them differs a little")
    centre, direction = matrix.to_translation(), -matrix.col[2].xyz
    across, along = matrix.col[0].xyz * width, matrix.col[1].xyz * height
    size = across.cross(along).length
    if size == 0 or direction.length == 0:
        notes.add(name, "area lamps of no size", "they give no light here, as in Cycles; give them a size")
        return []
    if not data.normalize:
        power = tuple(channel * size for channel in power)
    if data.spread < math.radians(SPREAD_OF_SPOTS):
        return spread(name, data, centre, across, along, direction, power, notes)
    if data.spread < math.pi - 1e-4:
        notes.add(
            name,
            f"area lamps with a spread between {SPREAD_OF_SPOTS} and 180 degrees",
            "of the same power, but they shine as with 180: up to a quarter too weak right in front of them",
        )
    radiance = tuple(channel / (math.pi * size) for channel in power)
    corners = [centre + x * across + y * along for x, y in ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))]
    if across.cross(along).dot(direction) < 0:
        corners.reverse()
    return [Quad(name, corners, radiance)]


def spread(name, data, centre, across, along, direction, power, notes):
    """A grid of spots of the same power in place of an area lamp with a spread.

    Cycles has a grid of slats before such a lamp: the radiance at an angle is proportional to 1 - tan(angle) / tan(spread / 2).
    The cone of a spot without inner cone that is nearest to it is a little wider.
    """
    half = max(data.spread, math.radians(NARROWEST)) / 2
    outer = min(half * (1.04 + 0.09 * (half / math.radians(60)) ** 2), math.pi / 2)
    # The squared ramp in the cosine holds a third of its cone, and a lamp of power P the intensity P / (4 pi).
    intensity = 3 / (2 * math.pi * (1 - math.cos(outer)))
    each = tuple(channel * intensity * 4 * math.pi / SPOTS_ALONG**2 for channel in power)
    notes.add(
        name,
        "area lamps with a spread",
        f"of the same power, but glTF has no spread: {SPOTS_ALONG} x {SPOTS_ALONG} spots stand for each, off by up to 8 % of "
        "their peak, by up to 22 % for spreads above 156 degrees; their shadows have steps, and the beams of a narrow spread "
        "stand apart",
    )
    places = [(step + 0.5) / SPOTS_ALONG - 0.5 for step in range(SPOTS_ALONG)]
    return [
        Lamp(name, "SPOT", Matrix.LocRotScale(Vector(centre + x * across + y * along), facing(direction), None), each, outer)
        for x in places
        for y in places
    ]
