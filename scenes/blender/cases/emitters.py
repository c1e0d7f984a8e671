"""Materials that emit."""

import math

import bpy

from .build import TILT, Case, feeds, principled, square


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


def facing(material, tree, shader, thing):
    feeds(tree, "ShaderNodeLayerWeight", shader.inputs["Emission Color"], "Facing")


def of_file(material, tree, shader, thing):
    """A picture whose file is not there."""
    image = bpy.data.images.new("lost", 2, 2)
    image.source, image.filepath = "FILE", "//nowhere.png"
    feeds(tree, "ShaderNodeTexImage", shader.inputs["Emission Color"]).image = image


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


CASES = {
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
    "emission mixed by what the camera sees": Case(emitter(mixed_by("ShaderNodeLightPath", "Is Camera Ray"))),
    "emission mixed by a node": Case(
        emitter(mixed_by("ShaderNodeLayerWeight", "Facing")), "mixed by something other than a number", agrees=False
    ),
    "emission of a picture": Case(emitter(picture("Emission Color"), Emission_Color=(1, 1, 1, 1))),
    "emission masked by a picture": Case(emitter(picture("Emission Strength"))),
    "emission of noise": Case(emitter(noise("Emission Strength")), "left out: emission whose strength", agrees=False),
    "emission coloured by a node": Case(emitter(facing), "emission whose colour comes", agrees=False),
    "emission of a lost picture": Case(emitter(of_file), "pictures that are not there", agrees=False),
}
