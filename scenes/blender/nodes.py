"""What feeds an input of a shader node?

An input is followed through reroutes and into and out of node groups to the output that feeds it, or to the number or
colour that it has. Shaders that are added, or mixed by a constant, come apart into their parts with weights.
"""

import functools
from typing import NamedTuple

import bpy


class Input(NamedTuple):
    """An input socket, and the group nodes that it lies within, outermost first."""

    socket: bpy.types.NodeSocket
    groups: tuple = ()

    def source(self):
        """The output that feeds this input, as (node, name of the output, groups), or None; and the input at the end."""
        socket, groups = self
        while True:
            link = next((link for link in socket.links if link.is_valid and not link.is_muted), None)
            if link is None:
                return None, Input(socket, groups)
            node, output = link.from_node, link.from_socket
            inner = node.type == "GROUP" and node.node_tree and output_of(node.node_tree)
            if node.type == "REROUTE":
                socket = node.inputs[0]
            elif inner:
                socket = next(s for s in inner.inputs if s.identifier == output.identifier)
                groups = (*groups, node)
            elif node.type == "GROUP_INPUT" and groups:
                socket = next(s for s in groups[-1].inputs if s.identifier == output.identifier)
                groups = groups[:-1]
            else:
                return (node, output.name, groups), Input(socket, groups)

    def constant(self):
        """The number, or the colour as three, that this input has whatever the point; None if that varies."""
        source, end = self.source()
        if source is None:
            return plain(end.socket.default_value) if hasattr(end.socket, "default_value") else None
        node, output, groups = source
        if node.mute:
            return None
        if node.type in ("VALUE", "RGB"):
            return plain(node.outputs[0].default_value)
        if node.type == "LIGHT_PATH" and output == "Is Camera Ray":
            # What lights a surface is asked for, not what the camera sees.
            return 0.0
        if node.type not in ("BLACKBODY", "MATH"):
            return None
        operands = [Input(socket, groups).constant() for socket in node.inputs]
        operands = [None if each is None else grey(each) for each in operands]
        if node.type == "BLACKBODY" and operands[0] is not None:
            return black_body(operands[0])
        if node.type == "MATH" and None not in operands[:2] and node.operation in ARITHMETIC:
            value = ARITHMETIC[node.operation](*operands[:2])
            return min(max(value, 0.0), 1.0) if node.use_clamp else value
        return None


ARITHMETIC = {
    "ADD": lambda a, b: a + b,
    "SUBTRACT": lambda a, b: a - b,
    "MULTIPLY": lambda a, b: a * b,
    "DIVIDE": lambda a, b: a / b if b else 0.0,
}


def plain(value):
    return value if isinstance(value, (int, float)) else tuple(value)[:3]


def rgb(value):
    """A colour as it is, a number as the grey that Blender makes of it."""
    return value if isinstance(value, tuple) else (value,) * 3


def grey(value):
    """A number as it is, a colour as the number that Cycles makes of it: its luminance."""
    return 0.2126 * value[0] + 0.7152 * value[1] + 0.0722 * value[2] if isinstance(value, tuple) else value


def output_of(tree):
    """The active output of a node group."""
    outputs = [node for node in tree.nodes if node.type == "GROUP_OUTPUT"]
    return next((node for node in outputs if node.is_active_output), None)


def surface(tree):
    """The input of the output node at which Cycles begins, or None."""
    output = tree.get_output_node("CYCLES") if tree else None
    return Input(output.inputs["Surface"]) if output else None


@functools.cache
def black_body(kelvin):
    """The colour of a temperature in kelvins, of luminance 1, as lamps have it."""
    lamp = bpy.data.lights.new("temperature", "POINT")
    lamp.use_temperature, lamp.temperature = True, kelvin
    colour = tuple(lamp.temperature_color)
    bpy.data.lights.remove(lamp)
    return colour


class Part(NamedTuple):
    """A shader with what it counts for, and whether it shows on the front alone."""

    node: bpy.types.Node
    groups: tuple
    weight: float
    front: bool

    def input(self, name):
        return Input(self.node.inputs[name], self.groups)


def parts(where, weight=1.0, front=False):
    """The shaders that make up a surface; and whether one is mixed in by what is no constant (it counts half then)."""
    source, _ = where.source()
    if source is None or weight == 0.0:
        return [], False
    node, _, groups = source
    if node.mute:
        return [], True
    if node.type == "ADD_SHADER":
        sides = [parts(Input(socket, groups), weight, front) for socket in node.inputs]
    elif node.type == "MIX_SHADER":
        factor, first, second = (Input(socket, groups) for socket in node.inputs)
        by, _ = factor.source()
        if by and by[0].type == "NEW_GEOMETRY" and by[1] == "Backfacing":
            # How one makes a face shine to one side: what the back has is not read.
            return parts(first, weight, True)
        share = factor.constant()
        sides = [
            parts(first, weight * (0.5 if share is None else 1.0 - share), front),
            parts(second, weight * (0.5 if share is None else share), front),
            ([], share is None),
        ]
    else:
        return [Part(node, groups, weight, front)], False
    return [part for found, _ in sides for part in found], any(unsure for _, unsure in sides)
