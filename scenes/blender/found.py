"""What stands in the scene that Blender opened?

Everything is read as it is rendered, and nothing is changed: `plain` replaces it later.
"""

from typing import NamedTuple

import bmesh
import bpy

from . import lamps
from .looks import Looks
from .opened import as_rendered, first_camera

SURFACES = ("MESH", "CURVE", "SURFACE", "FONT", "META")


class Mesh(NamedTuple):
    """A triangulated mesh in the world's coordinates, its materials; `shines` is whether it emits what lights anything."""

    name: str
    data: bpy.types.Mesh
    materials: list
    shines: bool


class Found:
    """What a scene holds: cameras, lamps and quads that stand for lamps, meshes in the world, looks of materials."""

    def __init__(self, of_gltf, notes):
        scene = bpy.context.scene
        self.of_gltf, self.notes, self.looks = of_gltf, notes, Looks(of_gltf, notes)
        self.lamps, self.meshes, self.sources = [], [], []
        first = first_camera(scene)
        cameras = sorted((thing for thing in scene.objects if thing.type == "CAMERA"), key=lambda thing: thing != first)
        self.cameras = [(thing.name, thing.data, thing.matrix_world.copy()) for thing in cameras]
        for name, data, _ in self.cameras:
            if data.shift_x or data.shift_y:
                self.notes.add(name, "cameras with a shift", "glTF has none: they look straight ahead")
        self.world()
        as_rendered(self.read)
        self.others()

    def world(self):
        world = bpy.context.scene.world
        if not world:
            return
        nodes = world.node_tree.nodes if world.node_tree else []
        light = [node for node in nodes if node.type == "BACKGROUND" and shines(node)]
        if light or (not nodes and max(world.color) > 0):
            self.notes.add(world.name, "left out: the light of the world (sky, environment map)", "make the moon a sun lamp")

    def others(self):
        """Tells of what else the file has."""
        for scene in bpy.data.scenes:
            if scene != bpy.context.scene:
                self.notes.add(
                    scene.name, "left out: other scenes of the file", "save the file with the scene shown that is meant"
                )
        for layer in bpy.context.scene.view_layers:
            if layer != bpy.context.view_layer and layer.use:
                self.notes.add(layer.name, "left out: other view layers", "what they alone show is not converted")

    def read(self, graph):
        for instance in graph.object_instances:
            thing = instance.object
            if not instance.show_self:
                continue
            if thing.type == "LIGHT":
                self.sources.append((thing.name, instance.matrix_world.to_translation()))
                self.lamps += lamps.read(thing, instance.matrix_world, self.of_gltf, self.notes)
            elif thing.type in SURFACES:
                self.mesh(thing, instance.matrix_world, graph)
            elif thing.type in ("CURVES", "POINTCLOUD", "VOLUME"):
                self.notes.add(thing.name, "left out: hair, point clouds and volumes", "turn them to meshes")

    def mesh(self, thing, matrix, graph):
        mesh = bpy.data.meshes.new_from_object(thing, depsgraph=graph)
        if not mesh or not mesh.polygons:
            return
        mesh.transform(matrix)
        if matrix.determinant() < 0:
            mesh.flip_normals()
        triangles = bmesh.new()
        triangles.from_mesh(mesh)
        bmesh.ops.triangulate(triangles, faces=triangles.faces[:])
        triangles.to_mesh(mesh)
        triangles.free()
        materials = materials_of(thing, mesh)
        emits = any(look.emits() for look in map(self.looks.of, materials))
        if emits:
            self.sources.append((thing.name, matrix.to_translation()))
        if self.is_kept(thing, emits):
            self.meshes.append(Mesh(thing.name, mesh, materials, emits and thing.visible_diffuse))

    def is_kept(self, thing, emits):
        """Whether an object stands in the scene here; tells what its visibility changes."""
        if not thing.visible_shadow and not emits:
            self.notes.add(
                thing.name, "left out: objects that cast no shadow", "they would block light here, which has no such objects"
            )
            return False
        if emits and not thing.visible_shadow:
            self.notes.add(thing.name, "emitters that cast no shadow", "they block light here")
        if emits and not thing.visible_diffuse:
            self.notes.add(
                thing.name, "emitters that are not visible to diffuse rays", "dark here: they shine on nothing in Cycles"
            )
        if not thing.visible_camera or thing.is_holdout:
            self.notes.add(thing.name, "objects that the camera does not see", "it sees them here")
        lamps.tell_of_linking(thing, self.notes)
        return True


def materials_of(thing, mesh):
    """The material of each slot: the object's where it has one of its own, the mesh's elsewhere."""
    materials = [material and material.original for material in mesh.materials]
    for slot in thing.material_slots:
        if slot.link == "OBJECT" and slot.slot_index < len(materials):
            materials[slot.slot_index] = slot.material and slot.material.original
    return materials or [None]


def shines(background):
    colour, strength = background.inputs["Color"], background.inputs["Strength"]
    bright = colour.is_linked or max(colour.default_value[:3]) > 0
    return bright and (strength.is_linked or strength.default_value > 0)
