"""What does a material reflect, and what does it emit?

A base colour, a plain emission, and emission by pictures: each with what it counts for in the shader. All that reflects
is Lambertian here. What cannot be read is told.
"""

from typing import NamedTuple

import numpy as np

from .nodes import Input, grey, parts, rgb, surface

# Look-ups per triangle: a regular grid of barycentric points.
GRID = [((i + 1 / 3) / 8, (j + 1 / 3) / 8) for i in range(8) for j in range(8 - i)]
# What Blender shows where there is no material, and what stands for colours that no number or picture gives.
NO_MATERIAL = (0.8, 0.8, 0.8)
UNKNOWN = (0.5, 0.5, 0.5)
CLEAR = ("BSDF_TRANSPARENT", "BSDF_GLASS", "BSDF_REFRACTION", "BSDF_TRANSLUCENT")


class Picture(NamedTuple):
    """Rows from the bottom, columns, linear RGB; the name of its UV layer, "" for that of renders."""

    texels: np.ndarray
    layer: str

    def at(self, mesh, u, v):
        """Its colour at a barycentric point of each triangle of a triangulated mesh; it repeats."""
        layers = mesh.uv_layers
        layer = layers.get(self.layer) or next((each for each in layers if each.active_render), None)
        if layer is None:
            return np.tile(self.texels[0, 0], (len(mesh.polygons), 1))
        corners = np.empty(len(mesh.loops) * 2, np.float32)
        layer.data.foreach_get("uv", corners)
        a, b, c = np.moveaxis(corners.reshape(-1, 3, 2), 1, 0)
        place = a + u * (b - a) + v * (c - a)
        height, width = self.texels.shape[:2]
        columns = np.floor(place[:, 0] * width).astype(int) % width
        return self.texels[np.floor(place[:, 1] * height).astype(int) % height, columns]


class Look(NamedTuple):
    """Emission is `glow`, and for each of `pictures` the factor times the product of pictures."""

    base: tuple
    glow: tuple = (0, 0, 0)
    pictures: tuple = ()
    front: bool = False

    def emits(self):
        return bool(self.pictures) or max(self.glow) > 0

    def over_faces(self, mesh):
        """The mean emission of each triangle of a triangulated mesh."""
        total = np.tile(np.array(self.glow, float), (len(mesh.polygons), 1))
        for factor, pictures in self.pictures:
            for u, v in GRID:
                product = np.prod([picture.at(mesh, u, v) for picture in pictures], axis=0)
                total += np.array(factor) * product / len(GRID)
        return total


class Looks:
    """The looks of materials by their names, each read once."""

    def __init__(self, of_gltf, notes):
        self.of_gltf, self.notes, self.known, self.texels = of_gltf, notes, {}, {}

    def of(self, material):
        name = material.name_full if material else None
        if name not in self.known:
            self.known[name] = self.read(material) if material else Look(NO_MATERIAL)
        return self.known[name]

    def read(self, material):
        if not material.node_tree:
            return Look(tuple(material.diffuse_color)[:3])
        name, begin = material.name, surface(material.node_tree)
        found, unsure = parts(begin) if begin else ([], False)
        base, glow, pictures, sides = np.zeros(3), np.zeros(3), [], []
        for part in found:
            base += part.weight * np.array(self.base(part, name))
            factor, products = self.emission(part, name)
            if factor is None or max(factor) == 0:
                continue
            sides.append(part.front)
            if products:
                pictures.append((factor, products))
            else:
                glow += factor
        if unsure and sides:
            self.note(
                name,
                "emission mixed by something other than a number",
                "taken as half of each (one-sided emission, mixed by Backfacing, is read); give the mix a number",
            )
        if begin and begin.socket.node.inputs["Volume"].is_linked:
            self.note(name, "left out: volumes of materials", "citylights has none")
        culled = material.use_backface_culling and bool(sides)
        if culled and self.of_gltf:
            self.note(
                name,
                "emissive materials that are not double-sided",
                "they shine from their front, as glTF has it; in Cycles, which has no culling, from both sides",
            )
        elif culled:
            self.note(
                name,
                "emissive materials with Backface Culling",
                "they shine from both sides, as in Cycles, which has no culling; mix by Backfacing for light from one side",
            )
        front = all(sides) or (culled and self.of_gltf)
        return Look(tuple(base), tuple(glow), tuple(pictures), bool(sides) and front)

    def note(self, name, what, consequence):
        self.notes.add(name, what, consequence)

    def base(self, part, name):
        """The colour that a shader reflects; black if it reflects none."""
        kind = part.node.type
        if kind in CLEAR or lets_through(part):
            self.note(name, "materials that let light through (alpha, glass)", "opaque here: they block light from behind them")
        if kind in CLEAR or kind == "EMISSION":
            return (0, 0, 0)
        key = next((key for key in ("Base Color", "Color") if key in part.node.inputs), None)
        if key is None:
            self.note(name, "surfaces of other shaders", "they reflect as grey of 0.5; give them a Principled BSDF")
            return UNKNOWN
        colour = part.input(key)
        value = colour.constant()
        if value is None:
            what = "base colours from nodes other than a picture", "grey of 0.5 here; bake them to a picture"
            picture = self.picture(colour, name, what)
            value = UNKNOWN if picture is None else picture.texels.mean(axis=(0, 1))
        return rgb(tuple(value) if isinstance(value, np.ndarray) else value)

    def emission(self, part, name):
        """The constant factor of what a shader emits, and the pictures that multiply it; None if it is left out."""
        if part.node.type == "EMISSION":
            colour, strength, weight = part.input("Color"), part.input("Strength"), part.weight
        elif part.node.type == "BSDF_PRINCIPLED":
            colour, strength = part.input("Emission Color"), part.input("Emission Strength")
            alpha = part.input("Alpha").constant()
            weight = part.weight * (1 if alpha is None else alpha)
        else:
            return None, ()
        value, hue, pictures = strength.constant(), colour.constant(), []
        value = None if value is None else grey(value)
        if value == 0 or weight == 0 or hue == (0, 0, 0):
            return None, ()
        if value is None:
            what = "left out: emission whose strength comes from nodes other than a picture"
            picture, value = self.picture(strength, name, (what, "bake it to a picture, or give it a number")), 1.0
            if picture is None:
                return None, ()
            shades = grey(tuple(np.moveaxis(picture.texels, 2, 0)))
            pictures.append(Picture(np.repeat(shades[..., None], 3, axis=2), picture.layer))
        if hue is None:
            what = "emission whose colour comes from nodes other than a picture"
            picture = self.picture(colour, name, (what, "taken as grey of 0.5; bake it to a picture"))
            hue = UNKNOWN if picture is None else (1, 1, 1)
            pictures += [] if picture is None else [picture]
        factor = tuple(weight * value * channel for channel in rgb(hue))
        if min(factor) < 0:
            self.note(name, "left out: emission of negative strength or colour", "glTF has none")
            return None, ()
        return factor, tuple(pictures)

    def picture(self, where, name, otherwise):
        """The picture that feeds an input directly; None, and a note that says so, where something else does."""
        source, _ = where.source()
        if source is None or source[0].type != "TEX_IMAGE" or source[1] != "Color":
            self.note(name, *otherwise)
            return None
        node, _, groups = source
        if node.image is None or node.image.size[0] == 0:
            self.note(
                name,
                "pictures that are not there",
                "grey of 0.5 stands for a colour, and emission masked by one is left out; File > External Data finds them",
            )
            return None
        by, _ = Input(node.inputs["Vector"], groups).source()
        layer = by[0].uv_map if by and by[0].type == "UVMAP" else ""
        plain = by is None or by[0].type == "UVMAP" or (by[0].type == "TEX_COORD" and by[1] == "UV")
        if not plain or node.projection != "FLAT" or node.extension != "REPEAT":
            self.note(name, "pictures that nodes place (Mapping, other coordinates)", "laid here as the UV map says, repeated")
        if node.image.name_full not in self.texels:
            self.texels[node.image.name_full] = linear(node.image)
        return Picture(self.texels[node.image.name_full], layer)


def lets_through(part):
    """Whether a Principled shader is not opaque."""
    sockets = [("Alpha", 1.0), ("Transmission Weight", 0.0)]
    return part.node.type == "BSDF_PRINCIPLED" and any(part.input(key).constant() != opaque for key, opaque in sockets)


def linear(image):
    """The texels of an image."""
    pixels = np.empty(image.size[0] * image.size[1] * image.channels, np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(image.size[1], image.size[0], image.channels)
    rgb = pixels[..., :3] if image.channels >= 3 else np.repeat(pixels[..., :1], 3, axis=2)
    if image.colorspace_settings.name == "sRGB" and not image.is_float:
        rgb = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    return rgb
