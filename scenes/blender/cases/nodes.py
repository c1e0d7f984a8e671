"""Nodes of lamps."""

import bpy

from .build import Case, feeds, lamp

PATTERN = "lamps whose nodes change with direction or place"
FALLS = "Light Falloff that is not the inverse square"


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


CASES = {
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
}
