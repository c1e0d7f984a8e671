"""Small scenes, each with one thing that a Blender file may hold, for `from_blender_test.py`.

A case is what builds the thing above a grey floor, and what is to come of it: whether light shines at all, whether Cycles
and citylights agree, and what is told.
"""

import math
from typing import Callable, NamedTuple

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


def point(**fields):
    return lambda: lamp("POINT", **fields)


def spot(**fields):
    return lambda: lamp("SPOT", **fields)


def sun(**fields):
    return lambda: lamp("SUN", turn=(0.5, 0.2, 0), **fields)


def area(**fields):
    return lambda: lamp("AREA", **{"place": (0, 0, 3), "turn": TILT, **fields})


def object_with(**fields):
    """A point lamp whose object has these fields."""

    def build():
        thing = lamp("POINT")
        for key, value in fields.items():
            setattr(thing, key, value)

    return build


def in_collection(**fields):
    """A point lamp in a collection with these fields, of itself or of the view layer."""

    def build():
        thing, collection = lamp("POINT"), bpy.data.collections.new("lamps")
        bpy.context.scene.collection.children.link(collection)
        bpy.context.scene.collection.objects.unlink(thing)
        collection.objects.link(thing)
        layer = bpy.context.view_layer.layer_collection.children["lamps"]
        for key, value in fields.items():
            setattr(collection if key == "hide_render" else layer, key, value)

    return build


def instanced(hidden):
    """A point lamp in a collection that an empty shows elsewhere."""

    def build():
        thing, collection = lamp("POINT", (0, 0, 0)), bpy.data.collections.new("lamps")
        bpy.context.scene.collection.objects.unlink(thing)
        collection.objects.link(thing)
        empty = added("instance", None, (-1, 0.5, 2), (0.2, 0.1, 0), (2, 2, 2))
        empty.instance_type, empty.instance_collection, empty.hide_render = "COLLECTION", collection, hidden

    return build


def with_nodes(kind, change):
    """A lamp with nodes; `change` gets the tree and its Emission."""

    def build():
        data = lamp(kind, (0, 0, 3)).data
        data.use_nodes = True
        change(data.node_tree, next(node for node in data.node_tree.nodes if node.type == "EMISSION"))

    return build


def strength(tree, emission):
    emission.inputs["Strength"].default_value = 3


def colour(tree, emission):
    emission.inputs["Color"].default_value = (1, 0.5, 0.25, 1)


def feeds(tree, kind, target, output=0, **values):
    """Links a new node of this kind to an input."""
    node = tree.nodes.new(kind)
    for key, value in values.items():
        node.inputs[key].default_value = value
    tree.links.new(node.outputs[output], target)
    return node


def black_body(tree, emission):
    feeds(tree, "ShaderNodeBlackbody", emission.inputs["Color"], Temperature=2200)


def arithmetic(tree, emission):
    node = feeds(tree, "ShaderNodeMath", emission.inputs["Strength"])
    node.operation = "MULTIPLY"
    node.inputs[1].default_value = 0.5
    feeds(tree, "ShaderNodeValue", node.inputs[0]).outputs[0].default_value = 3


def group(tree, emission):
    """Strength through a group, and a reroute."""
    inner = bpy.data.node_groups.new("inner", "ShaderNodeTree")
    inner.interface.new_socket("in", in_out="INPUT", socket_type="NodeSocketFloat")
    inner.interface.new_socket("out", in_out="OUTPUT", socket_type="NodeSocketFloat")
    start, end = inner.nodes.new("NodeGroupInput"), inner.nodes.new("NodeGroupOutput")
    inner.links.new(start.outputs[0], end.inputs[0])
    node, reroute = tree.nodes.new("ShaderNodeGroup"), tree.nodes.new("NodeReroute")
    node.node_tree = inner
    node.inputs[0].default_value = 2
    tree.links.new(node.outputs[0], reroute.inputs[0])
    tree.links.new(reroute.outputs[0], emission.inputs["Strength"])


def fall_off(output):
    return lambda tree, emission: feeds(tree, "ShaderNodeLightFalloff", emission.inputs["Strength"], output, Strength=2)


def stripes(tree, emission):
    wave = feeds(tree, "ShaderNodeTexWave", emission.inputs["Color"])
    feeds(tree, "ShaderNodeTexCoord", wave.inputs["Vector"], "Normal")


def ies(tree, emission):
    text = bpy.data.texts.new("lamp.ies")
    text.write("IESNA:LM-63-1995\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0\n1 1 100\n0 45 90\n0\n100 50 0\n")
    node = feeds(tree, "ShaderNodeTexIES", emission.inputs["Strength"])
    node.ies = text


def unlinked(tree, emission):
    tree.links.clear()


def added_emissions(tree, emission):
    both, other = tree.nodes.new("ShaderNodeAddShader"), tree.nodes.new("ShaderNodeEmission")
    tree.links.new(emission.outputs[0], both.inputs[0])
    tree.links.new(other.outputs[0], both.inputs[1])
    tree.links.new(both.outputs[0], next(node for node in tree.nodes if node.type == "OUTPUT_LIGHT").inputs[0])


def driven():
    data = lamp("POINT").data
    data.driver_add("energy").driver.expression = "700"


def child():
    """A spot below a turned and scaled empty."""
    thing, empty = lamp("SPOT", (0, 0, 1), spot_size=1.2), added("empty", None, (0.3, 0.2, 1), (0.3, 0.2, 0.5), (2, 2, 2))
    thing.parent = empty


def linked_to_some():
    receivers = bpy.data.collections.new("receivers")
    square("other", 1.5).location = (0.3, 0, 0.01)
    receivers.objects.link(bpy.data.objects["other"])
    lamp("POINT").light_linking.receiver_collection = receivers


def below(**fields):
    """A square between a point lamp and the floor, with these fields of its object."""

    def build():
        lamp("POINT", (0, 0, 3))
        thing = square("cover", 0.2)
        thing.location = (0, 0, 2.6)
        for key, value in fields.items():
            setattr(thing, key, value)

    return build


def shadowless():
    below()()
    bpy.data.lights["lamp"].use_shadow = False


def emitter(change=None, scale=(1, 1, 1), **values):
    """A square that emits upwards and downwards; `change` gets its material, tree, Principled shader and object."""

    def build():
        glow = {"Emission_Color": (1, 0.5, 0.25, 1), "Emission_Strength": 50, "Base_Color": (0, 0, 0, 1), **values}
        material, tree, shader = principled("glow", **glow)
        thing = square("emitter", 1, material)
        thing.location, thing.rotation_euler, thing.scale = (0, 0, 3), TILT, scale
        layer = thing.data.uv_layers.new(name="map")
        for corner, at in zip(layer.data, ((0, 0), (1, 0), (1, 1), (0, 1))):
            corner.uv = at
        if change:
            change(material, tree, shader, thing)

    return build


def emission(tree, value=50):
    node = tree.nodes.new("ShaderNodeEmission")
    node.inputs["Color"].default_value, node.inputs["Strength"].default_value = (0.2, 0.6, 1, 1), value
    return node


def to_output(tree, socket):
    tree.links.new(socket, next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL").inputs["Surface"])


def emission_shader(material, tree, shader, thing):
    to_output(tree, emission(tree).outputs[0])


def combined(kind, first, second):
    """Two shaders through a node of this kind; they are made of the tree, or it is the Principled one."""

    def change(material, tree, shader, thing):
        node = tree.nodes.new(kind)
        made = [make(tree) if make else shader for make in (first, second)]
        for socket, each in zip(node.inputs[-2:], made):
            tree.links.new(each.outputs[0], socket)
        if kind == "ShaderNodeMixShader":
            node.inputs[0].default_value = 0.25
        to_output(tree, node.outputs[0])
        return node

    return change


def diffuse(tree):
    return tree.nodes.new("ShaderNodeBsdfDiffuse")


def mixed_by(kind, output):
    def change(material, tree, shader, thing):
        node = combined("ShaderNodeMixShader", emission, diffuse)(material, tree, shader, thing)
        feeds(tree, kind, node.inputs[0], output)
        # Seen from below, the square shows its back unless it is turned.
        thing.rotation_euler = (math.pi + 0.3, 0.1, 0)

    return change


def picture(target):
    """A picture of four colours that feeds an input of the Principled shader."""

    def change(material, tree, shader, thing):
        image = bpy.data.images.new("four", 2, 2, float_buffer=True)
        image.colorspace_settings.name = "Non-Color"
        image.pixels[:] = [1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 0, 1]
        image.pack()
        node = feeds(tree, "ShaderNodeTexImage", shader.inputs[target])
        node.image, node.interpolation = image, "Closest"
        # Triangles small enough to lie within one texel.
        cut = thing.modifiers.new("cut", "SUBSURF")
        cut.subdivision_type, cut.levels, cut.render_levels = "SIMPLE", 0, 3

    return change


def noise(target):
    return lambda material, tree, shader, thing: feeds(tree, "ShaderNodeTexNoise", shader.inputs[target])


def of_object(material, tree, shader, thing):
    """The material belongs to the object, another to its mesh."""
    thing.data.materials[0] = principled("dark")[0]
    thing.material_slots[0].link = "OBJECT"
    thing.material_slots[0].material = material


def culled(material, tree, shader, thing):
    material.use_backface_culling = True


def field(**fields):
    def change(material, tree, shader, thing):
        for key, value in fields.items():
            setattr(thing, key, value)

    return change


def world():
    lamp("POINT")
    made = bpy.data.worlds.new("sky")
    if not made.node_tree:
        made.use_nodes = True
    made.node_tree.nodes["Background"].inputs["Color"].default_value = (1, 1, 1, 1)
    bpy.context.scene.world = made


def no_material():
    lamp("POINT")
    bpy.data.meshes["floor"].materials.clear()


def glossy_floor():
    """Surfaces that are not Lambertian: their light agrees all the same."""
    lamp("POINT")
    shader = next(n for n in bpy.data.materials["grey"].node_tree.nodes if n.type == "BSDF_PRINCIPLED")
    shader.inputs["Metallic"].default_value, shader.inputs["Roughness"].default_value = 0.7, 0.3


def nothing():
    pass


SPREAD = "area lamps with a spread:"
EDGE = "spots with a soft edge"
RADIUS = "point and spot lamps with a radius"
PATTERN = "lamps whose nodes change with direction or place"
FALLS = "Light Falloff that is not the inverse square"
SHAPE = "round area lamps"

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
    "area colour": Case(area(size=1, color=(1, 0.5, 0.1))),
    "area temperature": Case(area(size=1, use_temperature=True, temperature=3000)),
    "area exposure": Case(area(size=1, exposure=-1)),
    "area normalize off": Case(area(size=2, normalize=False)),
    "area normalize off, disk, scaled": Case(area(size=2, shape="DISK", normalize=False, scale=(2, 1, 1)), SHAPE),
    "area size 0": Case(area(size=0), "area lamps of no size", lit=False),
    "area spread 60": Case(area(size=1, spread=math.radians(60)), SPREAD, tolerance=0.15),
    "area spread 120": Case(area(size=1, spread=math.radians(120)), SPREAD, tolerance=0.1),
    "area spread 170": Case(area(size=1, spread=math.radians(170)), "between 164 and 180", agrees=False),
    "nodes strength": Case(with_nodes("POINT", strength)),
    "nodes strength, area": Case(with_nodes("AREA", strength)),
    "nodes strength, sun": Case(with_nodes("SUN", strength)),
    "nodes strength, spot": Case(with_nodes("SPOT", strength)),
    "nodes colour": Case(with_nodes("POINT", colour)),
    "nodes blackbody": Case(with_nodes("POINT", black_body)),
    "nodes arithmetic": Case(with_nodes("POINT", arithmetic)),
    "nodes group": Case(with_nodes("POINT", group)),
    "nodes quadratic falloff": Case(with_nodes("POINT", fall_off("Quadratic"))),
    "nodes linear falloff": Case(with_nodes("POINT", fall_off("Linear")), FALLS, agrees=False),
    "nodes texture": Case(with_nodes("POINT", stripes), PATTERN, agrees=False),
    "nodes IES": Case(with_nodes("POINT", ies), PATTERN, agrees=False),
    "nodes unlinked": Case(with_nodes("POINT", unlinked), lit=False),
    "nodes of two emissions": Case(with_nodes("POINT", added_emissions)),
    "lamp driven": Case(driven),
    "lamp below a scaled parent": Case(child),
    "lamp hidden in renders": Case(object_with(hide_render=True), lit=False),
    "lamp hidden in views": Case(object_with(hide_viewport=True)),
    "lamp not visible to diffuse rays": Case(object_with(visible_diffuse=False), "not visible to diffuse rays", lit=False),
    "lamp held out": Case(object_with(is_holdout=True)),
    "collection": Case(in_collection()),
    "collection hidden in renders": Case(in_collection(hide_render=True), lit=False),
    "collection excluded": Case(in_collection(exclude=True), lit=False),
    "collection hidden in views": Case(in_collection(hide_viewport=True)),
    "collection indirect only": Case(in_collection(indirect_only=True)),
    "collection held out": Case(in_collection(holdout=True)),
    "instanced": Case(instanced(False)),
    "instanced, hidden in renders": Case(instanced(True), lit=False),
    "light linking": Case(linked_to_some, "lights that are linked", agrees=False),
    "cover": Case(below()),
    "cover that casts no shadow": Case(below(visible_shadow=False), "left out: objects that cast no shadow"),
    "cover hidden in renders": Case(below(hide_render=True)),
    "lamp that casts no shadow": Case(shadowless, "lamps that cast no shadow", agrees=False),
    "emitter": Case(emitter()),
    "emitter mirrored": Case(emitter(scale=(-1, 1, 1))),
    "emitter colour above 1": Case(emitter(Emission_Color=(3, 0.5, 0.25, 1))),
    "emitter with alpha": Case(emitter(Alpha=0.5), "materials that let light through"),
    "emitter culled": Case(emitter(culled), "emissive materials with Backface Culling"),
    "emitter of the object's material": Case(emitter(of_object)),
    "emitter not visible to diffuse rays": Case(emitter(field(visible_diffuse=False)), "dark here", lit=False),
    "emitter hidden in renders": Case(emitter(field(hide_render=True)), lit=False),
    "emission shader": Case(emitter(emission_shader)),
    "emission added": Case(emitter(combined("ShaderNodeAddShader", emission, None))),
    "emission mixed": Case(emitter(combined("ShaderNodeMixShader", emission, diffuse))),
    "emission of the front": Case(emitter(mixed_by("ShaderNodeNewGeometry", "Backfacing"))),
    "emission mixed by a node": Case(
        emitter(mixed_by("ShaderNodeLightPath", "Is Camera Ray")), "mixed by something other than a number", agrees=False
    ),
    "emission of a picture": Case(emitter(picture("Emission Color"), Emission_Color=(1, 1, 1, 1))),
    "emission masked by a picture": Case(emitter(picture("Emission Strength"))),
    "emission of noise": Case(emitter(noise("Emission Strength")), "left out: emission whose strength", agrees=False),
    "emission coloured by noise": Case(emitter(noise("Emission Color")), "emission whose colour comes", agrees=False),
    "world": Case(world, "left out: the light of the world", agrees=False),
    "floor without material": Case(no_material),
    "floor that gleams": Case(glossy_floor),
    "nothing": Case(nothing, "nothing in the scene gives light", lit=False),
}
