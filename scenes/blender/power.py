"""How bright is a lamp of Blender's?

In Blender's watts: a point lamp of P shines with P / (4 pi) in each direction, an area lamp of P has the radiance
P / (pi area). How Cycles takes the fields of a lamp was measured with Cycles of Blender 5.0.
"""

import math

from .nodes import Input, black_body, grey, parts, rgb, surface


def power_of(name, data, notes):
    """Power, or irradiance of a sun, in each channel."""
    factor = data.energy * 2**data.exposure
    if not data.normalize:
        factor *= size_of(data)
    tint = black_body(data.temperature) if data.use_temperature else (1, 1, 1)
    shader = shader_of(name, data, notes) if data.use_nodes else (1, 1, 1)
    return tuple(factor * colour * tinted * shaded for colour, tinted, shaded in zip(data.color, tint, shader))


def size_of(data):
    """What the power of a lamp is multiplied by in Cycles where `normalize` is off."""
    if data.type == "SUN":
        return math.pi * math.sin(data.angle / 2) ** 2 if data.angle > 0 else 1.0
    if data.type == "AREA":
        # The radiance is then that of 1 m^2; `area` multiplies by the true one.
        return 1.0
    return 4 * math.pi * data.shadow_soft_size**2 if data.shadow_soft_size > 0 else 4.0


def shader_of(name, data, notes):
    """Colour times strength of a lamp's nodes."""
    begin = surface(data.node_tree)
    found, unsure = parts(begin) if begin else ([], False)
    if unsure or any(part.node.type != "EMISSION" for part in found):
        notes.add(name, "lamps whose nodes are not Emission alone", "only its part is carried; add or mix Emission by numbers")
    total = [0, 0, 0]
    for part in found:
        if part.node.type != "EMISSION":
            continue
        hue, strength = part.input("Color").constant(), part.input("Strength")
        value = strength.constant()
        if value is None:
            value = fall_off(strength, name, notes)
        if hue is None or value is None:
            notes.add(
                name,
                "lamps whose nodes change with direction or place (textures, IES)",
                "what changes is taken as 1, so pattern and brightness differ; give Emission plain numbers",
            )
        hue, value = rgb(1 if hue is None else hue), grey(1 if value is None else value)
        total = [sum_ + part.weight * value * channel for sum_, channel in zip(total, hue)]
    return total


def fall_off(strength, name, notes):
    """The strength that a Light Falloff node gives at a distance of 1 m, or None where there is another node."""
    node, output, groups = strength.source()[0]
    if node.type != "LIGHT_FALLOFF":
        return None
    value, smooth = (Input(node.inputs[key], groups).constant() for key in ("Strength", "Smooth"))
    if output != "Quadratic" or smooth != 0:
        notes.add(
            name,
            "lamps with a Light Falloff that is not the inverse square",
            "they fall with the inverse square here and are right at 1 m; use the output Quadratic with Smooth 0",
        )
    return value
