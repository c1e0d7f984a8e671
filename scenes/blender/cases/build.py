"""What cases are built of."""

import math
from collections.abc import Callable
from typing import NamedTuple

import bpy

PLACE = (1, 0.5, 3)
TILT = (0.3, 0.1, 0)


class Case(NamedTuple):
    build: Callable
    # A part of the line that is to be printed, or None where none is.
    told: str | None = None
    lit: bool = True
    agrees: bool = True
    tolerance: float = 0.02


def mesh(name, corners, material=None):
    data = bpy.data.meshes.new(name)
    data.from_pydata(corners, [], [tuple(range(len(corners)))])
    if material:
        data.materials.append(material)
    return added(name, data)


def added(name, data, place=(0, 0, 0), turn=(0, 0, 0), scale=(1, 1, 1)):
    thing = bpy.data.objects.new(name, data)
    thing.location, thing.rotation_euler, thing.scale = place, turn, scale
    bpy.context.scene.collection.objects.link(thing)
    return thing


def square(name, side, material=None):
    half = side / 2
    return mesh(name, [(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)], material)


def principled(name, **values):
    material = bpy.data.materials.new(name)
    if not material.node_tree:
        material.use_nodes = True
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    for key, value in values.items():
        shader.inputs[key.replace("_", " ")].default_value = value
    return material, material.node_tree, shader


def empty_scene():
    """A grey floor seen from 2.4 m above, and a black world."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    square("floor", 20, principled("grey", Base_Color=(0.5, 0.5, 0.5, 1))[0])
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit, camera.angle = "VERTICAL", math.radians(60)
    scene = bpy.context.scene
    scene.camera = added("camera", camera, (0, 0, 2.4))
    scene.render.resolution_x, scene.render.resolution_y = 320, 240


def lamp(kind, place=PLACE, turn=(0, 0, 0), scale=(1, 1, 1), **fields):
    data = bpy.data.lights.new("lamp", kind)
    if kind in ("POINT", "SPOT"):
        data.shadow_soft_size = 0
    if kind == "SPOT":
        data.spot_blend = 0
    if kind == "SUN":
        data.angle = 0
    data.energy = {"POINT": 500, "SPOT": 500, "SUN": 3, "AREA": 100}[kind]
    for key, value in fields.items():
        setattr(data, key, value)
    return added("lamp", data, place, turn, scale)


def feeds(tree, kind, target, output=0, **values):
    """Links a new node of this kind to an input."""
    node = tree.nodes.new(kind)
    for key, value in values.items():
        node.inputs[key].default_value = value
    tree.links.new(node.outputs[output], target)
    return node


def black_world():
    world = bpy.data.worlds.new("world")
    if not world.node_tree:
        world.use_nodes = True
    next(node for node in world.node_tree.nodes if node.type == "BACKGROUND").inputs["Color"].default_value = (0, 0, 0, 1)
    return world
