"""Blender's Cycles as a peer of citylights: renders an exported scene at pixel centres, direct light only, on one thread.

To make the environment, once, in the folder of the repository (each version of bpy wants one version of Python: bpy 5.0
wants 3.11):

    python3.11 -m venv src/peers/scripts/.venv
    src/peers/scripts/.venv/bin/pip install bpy

`citylights compare SCENE --peer cycles --peer cycles:light-tree=off` then finds it. What is asked of this script and what
it prints stands in README.md beside it.

What the importer does not say by itself is said here: lights in the unit of the file (COMPAT), emission from the front
alone (a mix with the back-face: sampling the front alone is not one-sided), no specular part, flat normals, and the
profile of glTF's spots, whose edge Blender has another one for.
"""

import json
import math
import os
import struct
import time

from contract import begin, command_line, run

say = begin()

try:
    import bpy
except ImportError as error:
    say(kind="missing", why=str(error))
    raise SystemExit(0)


def file_json(path):
    """The JSON part of a .glb file."""
    with open(path, "rb") as file:
        length = struct.unpack("<12xI4x", file.read(20))[0]
        return json.loads(file.read(length))


def shine_from_front(material):
    """Emission from the front, black from the back."""
    nodes, links = material.node_tree.nodes, material.node_tree.links
    principled = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
    principled.inputs["Specular IOR Level"].default_value = 0
    strength = principled.inputs["Emission Strength"].default_value
    colour = tuple(principled.inputs["Emission Color"].default_value)
    if strength == 0 or max(colour[:3]) == 0:
        material.cycles.emission_sampling = "NONE"
        return
    nodes.clear()
    emission, black = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeBsdfDiffuse")
    emission.inputs["Color"].default_value = colour
    emission.inputs["Strength"].default_value = strength
    black.inputs["Color"].default_value = (0, 0, 0, 1)
    mix, output = nodes.new("ShaderNodeMixShader"), nodes.new("ShaderNodeOutputMaterial")
    links.new(nodes.new("ShaderNodeNewGeometry").outputs["Backfacing"], mix.inputs[0])
    links.new(emission.outputs[0], mix.inputs[1])
    links.new(black.outputs[0], mix.inputs[2])
    links.new(mix.outputs[0], output.inputs["Surface"])
    material.cycles.emission_sampling = "FRONT"


def shine_as_gltf(light):
    """The edge of a spot: the square of a ramp in the cosine between the outer and the inner cone."""
    outer = light.spot_size / 2
    outer, inner = math.cos(outer), math.cos(outer * (1 - light.spot_blend))
    light.spot_blend = 0
    light.use_nodes = True
    nodes, links = light.node_tree.nodes, light.node_tree.links
    nodes.clear()
    direction = nodes.new("ShaderNodeTexCoord").outputs["Normal"]
    part, ramp, square = (nodes.new(kind) for kind in ("ShaderNodeSeparateXYZ", "ShaderNodeMath", "ShaderNodeMath"))
    links.new(direction, part.inputs[0])
    # In the light's own axes, where it shines along -Z.
    ramp.operation, ramp.use_clamp = "MULTIPLY_ADD", True
    links.new(part.outputs["Z"], ramp.inputs[0])
    width = max(inner - outer, 1e-6)
    ramp.inputs[1].default_value, ramp.inputs[2].default_value = -1 / width, -outer / width
    square.operation = "MULTIPLY"
    links.new(ramp.outputs[0], square.inputs[0])
    links.new(ramp.outputs[0], square.inputs[1])
    emission, output = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeOutputLight")
    links.new(square.outputs[0], emission.inputs["Strength"])
    links.new(emission.outputs[0], output.inputs["Surface"])


def load(path, light_tree):
    """Imports the scene and makes its settings those of a direct rendering without any help."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(
        filepath=path, export_import_convert_lighting_mode="COMPAT", import_shading="FLAT", merge_vertices=False
    )
    for material in bpy.data.materials:
        if material.node_tree:
            shine_from_front(material)
    for light in bpy.data.lights:
        light.cycles.max_bounces = 0
        if light.type == "SPOT":
            shine_as_gltf(light)
        if light.type == "SUN":
            light.angle = 0
        else:
            light.shadow_soft_size = 0
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("black")
    scene.world.color = (0, 0, 0)
    # A new world may come with nodes, and those with a grey that shows as light on every wall that sees the sky.
    for node in scene.world.node_tree.nodes if scene.world.node_tree else ():
        if node.type == "BACKGROUND":
            node.inputs["Color"].default_value, node.inputs["Strength"].default_value = (0, 0, 0, 1), 0
    cameras = [thing for thing in scene.objects if thing.type == "CAMERA"]
    scene.camera = cameras[0]
    # Farther than any scene: what lies beyond is cut off.
    scene.camera.data.clip_start, scene.camera.data.clip_end = 1e-3, 1e7
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y = file_json(path)["cameras"][0]["extras"]["resolution"]
    render.resolution_percentage = 100
    render.pixel_aspect_x = render.pixel_aspect_y = 1
    render.use_persistent_data = True
    render.threads_mode, render.threads = "FIXED", 1
    render.use_compositing = render.use_sequencer = False
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_mode, render.image_settings.color_depth = "RGB", "32"
    render.film_transparent = False
    scene.view_settings.view_transform = "Raw"
    cycles.device = "CPU"
    # The narrowest filter that there is: within 0.01 of the centre of the pixel. A box has a width of 1 whatever is said.
    cycles.pixel_filter_type, cycles.filter_width = "BLACKMAN_HARRIS", 0.01
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_auto_tile = False
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = 0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.light_sampling_threshold = 0
    cycles.use_light_tree = light_tree
    cycles.film_exposure = 1
    return scene


def threads():
    """User ticks and CPU seconds of each thread but the main one; of none where the system does not tell."""
    found = {}
    try:
        for thread in os.listdir("/proc/self/task"):
            if int(thread) == os.getpid():
                continue
            with open(f"/proc/self/task/{thread}/stat") as stat, open(f"/proc/self/task/{thread}/schedstat") as clock:
                ticks = int(stat.read().rsplit(")", 1)[1].split()[11])
                found[thread] = ticks, int(clock.read().split()[0]) * 1e-9
    except (OSError, IndexError, ValueError):
        return {}
    return found


def busiest(before, after):
    """CPU seconds, from one to the other, of the thread that has computed most so far.

    The others wait for it: one of them spins meanwhile, more or less as the machine is busy.
    """
    if not after:
        return None
    thread = max(after, key=lambda thread: after[thread][0])
    return after[thread][1] - before.get(thread, (0, 0))[1]


def main():
    parser = command_line(__doc__.split("\n")[0])
    parser.add_argument("--light-tree", choices=["on", "off"], default="on")
    arguments = parser.parse_args()
    clock = "CPU s are those of its one render thread" if threads() else "CPU s are wall seconds of its one render thread"
    say(
        kind="about",
        renderer=f"Cycles in Blender {bpy.app.version_string}",
        remarks=[
            f"light tree {arguments.light_tree}; a sample is a camera ray, a light sample with its shadow ray, and a ray "
            "by the surface's own distribution, the two weighted against each other; tabulated Sobol numbers",
            f"{clock}, each image rendered in one block; what its main thread does to begin an image and to write it is not "
            "in them. Set-up is import and synchronisation, what a first image takes in the whole process beyond the same "
            "image made again, without the start of Python",
        ],
    )
    if not arguments.seeds:
        return
    begun = time.process_time()
    scene = load(arguments.scene, arguments.light_tree == "on")

    def render(count, seed, path):
        scene.cycles.samples, scene.cycles.seed, scene.render.filepath = count, seed, path
        before, wall = threads(), time.perf_counter()
        bpy.ops.render.render(write_still=True)
        wall = time.perf_counter() - wall
        cpu = busiest(before, threads())
        return wall if cpu is None else cpu, wall

    run(say, arguments, begun, render)


main()
