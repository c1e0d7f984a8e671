"""How does what was found become objects that glTF has?

All that Blender opened is replaced: by meshes of plain materials, lamps of plain power, and cameras.
"""

import bpy
import numpy as np
from mathutils import Matrix

from .lamps import Quad

# Faces of like brightness and hue share a material: levels half a stop apart, channels a quarter of the greatest.
LEVELS_PER_STOP = 2
HUES = 4


def replace(found, dim):
    """Puts plain objects in place of all others; returns the quads that stand for lamps, by their names in Blender."""
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    make, scene = Maker(), bpy.context.scene
    for name, data, matrix in found.cameras:
        camera = make.linked(name, data)
        camera.matrix_world = Matrix.LocRotScale(matrix.to_translation(), matrix.to_quaternion(), None)
        # glTF has no shift.
        data.shift_x = data.shift_y = 0
    # The first is the one that citylights takes by default.
    scene.camera = next((thing for thing in scene.objects if thing.type == "CAMERA"), None)
    for mesh in found.meshes:
        make.give_materials(mesh, found.looks, dim)
        make.linked(mesh.name, mesh.data)
    quads = set()
    for lamp in found.lamps:
        thing = make.quad(lamp) if isinstance(lamp, Quad) else make.lamp(lamp)
        if isinstance(lamp, Quad):
            quads.add(thing.name)
    return quads


def apart(colour):
    """A colour of at most 1, and the factor that makes it `colour`."""
    most = max(colour)
    return ([float(channel / most) for channel in colour], float(most)) if most > 0 else ([0.0] * 3, 0.0)


class Maker:
    """Makes objects and the materials that they share."""

    def __init__(self):
        self.materials = {}

    def linked(self, name, data):
        thing = bpy.data.objects.new(name, data)
        bpy.context.scene.collection.objects.link(thing)
        return thing

    def material(self, name, base, glow, front):
        """A Principled material of plain numbers, one for all that are alike."""
        key = (name, tuple(base), tuple(glow), front)
        if key not in self.materials:
            material = bpy.data.materials.new(name)
            if not material.node_tree:
                material.use_nodes = True
            material.use_backface_culling = front
            shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
            colour, strength = apart(glow)
            shader.inputs["Base Color"].default_value = (*base, 1)
            shader.inputs["Emission Color"].default_value = (*colour, 1)
            shader.inputs["Emission Strength"].default_value = strength
            self.materials[key] = material
        return self.materials[key]

    def lamp(self, lamp):
        data = bpy.data.lights.new(lamp.name, lamp.kind)
        data.color, data.energy = apart(lamp.power)
        if lamp.kind == "SUN":
            data.angle = 0
        else:
            data.shadow_soft_size = 0
        if lamp.kind == "SPOT":
            data.spot_size = 2 * lamp.outer
            # The exporter makes the inner cone of it.
            data.spot_blend = 1 - lamp.inner / lamp.outer
        thing = self.linked(lamp.name, data)
        thing.matrix_world = lamp.matrix
        return thing

    def quad(self, quad):
        mesh = bpy.data.meshes.new(quad.name)
        mesh.from_pydata(quad.corners, [], [(0, 1, 2, 3)])
        mesh.materials.append(self.material(f"{quad.name} glow", (0, 0, 0), quad.radiance, True))
        return self.linked(quad.name, mesh)

    def give_materials(self, found, looks, dim):
        """Gives each face of a mesh a plain material: of its own brightness where pictures decide it."""
        mesh, opened = found.data, found.materials
        count = len(mesh.polygons)
        slots, areas = np.empty(count, np.int32), np.empty(count, np.float32)
        mesh.polygons.foreach_get("material_index", slots)
        mesh.polygons.foreach_get("area", areas)
        slots = np.clip(slots, 0, len(opened) - 1)
        plain, numbers = [], np.zeros(count, np.int32)
        for slot in np.unique(slots):
            look, faces = looks.of(opened[slot]), np.flatnonzero(slots == slot)
            name = opened[slot].name if opened[slot] else "no material"
            colours = look.over_faces(mesh)[faces] if found.shines else np.zeros((len(faces), 3))
            kinds = self.kinds(colours, dim if look.pictures else 0.0)
            for kind in np.unique(kinds, axis=0):
                members = (kinds == kind).all(axis=1)
                glow = (0, 0, 0)
                if kind.any():
                    mean = np.average(colours[members], axis=0, weights=areas[faces[members]] + 1e-30)
                    glow = mean if look.pictures else look.glow
                numbers[faces[members]] = len(plain)
                plain.append(self.material(name, look.base, glow, look.front))
        mesh.materials.clear()
        for material in plain:
            mesh.materials.append(material)
        mesh.polygons.foreach_set("material_index", numbers)

    def kinds(self, colours, dim):
        """For each colour four numbers, the same for colours that are alike, and zeros for those too dim to be emitters."""
        brightness = colours.max(axis=1, keepdims=True)
        safe = np.maximum(brightness, 1e-30)
        level = np.floor(LEVELS_PER_STOP * np.log2(safe))
        kinds = np.hstack([level, np.rint(HUES * colours / safe)]).astype(int)
        kinds[(brightness <= dim * brightness.max())[:, 0]] = 0
        return kinds
