"""Does the same light arrive in citylights as in Cycles?

Two small pictures of one view in direct light: of the scene as it was opened in Cycles, and of the file that was written
in citylights. So that they differ by light alone, all Principled surfaces are made Lambertian in Cycles, of the base
colours that the file has, the camera does not see lamps, and pixels are taken at their centres in both. Pixels whose centre
shows the sky or an emitter are left out. Means are compared, of the whole picture and of tiles, which say where. Cycles
renders twice: how far its pictures lie apart says how much of a difference may be its noise, three standard errors.
"""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

import bpy
import numpy as np
from mathutils import Vector

from .found import SURFACES
from .looks import NO_MATERIAL

WIDTH = 64
# Tiles across and down.
TILES = (8, 6)
# So many tiles are told.
TOLD = 5
# So many standard errors may be noise.
NOISE = 3
# What is not Lambertian about a Principled shader, by the value at which it has no part. Alpha stays: it makes holes.
OTHER_THAN_DIFFUSE = {
    "Metallic": 0,
    "Diffuse Roughness": 0,
    "Specular IOR Level": 0,
    "Transmission Weight": 0,
    "Subsurface Weight": 0,
    "Coat Weight": 0,
    "Sheen Weight": 0,
}


def find(program):
    """The path of the program, without which there is no check."""
    found = shutil.which(program)
    if not found:
        fail(f"--check: there is no program `{program}`; --citylights PROGRAM says where it is")
    return found


def fail(why):
    print(why, file=sys.stderr)
    sys.exit(2)


class Tile(NamedTuple):
    """Mean radiance in Cycles and here by channel, what noise may add, and what differences are relative to."""

    number: tuple
    pair: list
    noise: np.ndarray
    scale: float
    place: np.ndarray

    def off(self):
        return (self.pair[1] - self.pair[0]) / self.scale

    def worst(self):
        """The difference of the channel that differs most."""
        return max(self.off(), key=abs)

    def is_off(self, tolerance):
        return (np.abs(self.off()) > tolerance + self.noise / self.scale).any()

    def __str__(self):
        column, row = self.number
        return (
            f"tile {column} from the left, {row} from the top, of {TILES[0]} x {TILES[1]}: Cycles {self.pair[0].mean():.4g}, "
            f"citylights {self.pair[1].mean():.4g} ({self.worst():+.0%})"
        )


class Check:
    """Cycles' picture of the scene as opened, and what is needed to compare another with it."""

    def __init__(self, found, wanted):
        self.found, self.wanted = found, wanted
        scene = bpy.context.scene
        if not found.cameras:
            fail("--check: the scene has no camera; add one that sees what is lit")
        if found.cameras[0][1].type != "PERSP":
            fail(f"--check: camera `{found.cameras[0][0]}` is no perspective camera, and citylights has no others")
        render = scene.render
        across, down = render.resolution_x * render.pixel_aspect_x, render.resolution_y * render.pixel_aspect_y
        self.size = (WIDTH, max(round(WIDTH * down / across), TILES[1]))
        with tempfile.TemporaryDirectory() as folder:
            self.prepare_for_cycles(scene)
            halves = [self.render(scene, seed, Path(folder) / f"{seed}.exr") for seed in (0, 1)]
        self.cycles = (halves[0] + halves[1]) / 2
        # Of the mean of two, the variance is the square of half their difference.
        self.variance = ((halves[0] - halves[1]) / 2) ** 2

    def prepare_for_cycles(self, scene):
        """Makes the scene what the head of this file says. It does not stay as it was."""
        for material in bpy.data.materials:
            make_lambertian(material, self.found.looks)
        give_materials()
        for thing in bpy.data.objects:
            if thing.type == "LIGHT":
                thing.visible_camera = False
        self.prepare(scene)
        if not scene.camera:
            scene.camera = next(thing for thing in scene.objects if thing.name == self.found.cameras[0][0])
        camera = scene.camera.data = scene.camera.data.copy()
        camera.dof.use_dof, camera.shift_x, camera.shift_y = False, 0, 0
        camera.clip_start, camera.clip_end = 1e-3, 1e7
        render, cycles = scene.render, scene.cycles
        render.engine = "CYCLES"
        render.use_compositing = render.use_sequencer = render.use_motion_blur = render.film_transparent = False
        render.use_border = render.use_multiview = False
        if hasattr(render.image_settings, "media_type"):
            render.image_settings.media_type = "IMAGE"
        render.image_settings.file_format = "OPEN_EXR"
        render.image_settings.color_mode, render.image_settings.color_depth = "RGB", "32"
        scene.view_settings.view_transform, scene.view_settings.exposure, scene.view_settings.gamma = "Raw", 0, 1
        scene.view_settings.use_curve_mapping = False
        cycles.device, cycles.samples, cycles.film_exposure = "CPU", max(self.wanted.samples // 2, 1), 1
        # The narrowest filter that there is: a box has a width of 1 whatever is said.
        cycles.pixel_filter_type, cycles.filter_width = "BLACKMAN_HARRIS", 0.01
        cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_fast_gi = False
        cycles.max_bounces = cycles.sample_clamp_direct = cycles.light_sampling_threshold = 0
        for layer in scene.view_layers:
            layer.use = layer == bpy.context.view_layer
            layer.samples, layer.material_override = 0, None

    def render(self, scene, seed, path):
        scene.cycles.seed, scene.cycles.use_animated_seed, scene.render.filepath = seed, False, str(path)
        bpy.ops.render.render(write_still=True)
        return pixels(path)

    def prepare(self, scene):
        """Gives the scene the size of the small pictures."""
        render = scene.render
        render.resolution_x, render.resolution_y = self.size
        render.resolution_percentage, render.pixel_aspect_x, render.pixel_aspect_y = 100, 1, 1

    def agrees(self, target, quads):
        """Renders `target` in citylights, prints the differences, and says whether they lie within the tolerance."""
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "citylights.exr"
            command = [find(self.wanted.citylights), "reference", target, "-o", path, "--cache", folder]
            command += ["--resolution", "{}x{}".format(*self.size), "--noise", "1e-4"]
            done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
            if done.returncode:
                fail(f"--check: citylights says: {done.stderr.strip()}")
            here = pixels(path)
        shown, places = self.surfaces(quads)
        if not shown.any():
            fail("--check: the camera sees no surface that reflects")
        return self.compare(here, shown, places)

    def surfaces(self, quads):
        """Which pixels of the converted scene show a surface that reflects, and where in the world each lies."""
        scene = bpy.context.scene
        self.prepare(scene)
        graph, matrix = bpy.context.evaluated_depsgraph_get(), scene.camera.matrix_world
        corners = [np.array(corner) for corner in scene.camera.data.view_frame(scene=scene)]
        top_right, _, bottom_left, top_left = corners
        width, height = self.size
        shown, places = np.zeros((height, width), bool), np.zeros((height, width, 3))
        for y, x in np.ndindex(height, width):
            at = top_left + (x + 0.5) / width * (top_right - top_left) + (y + 0.5) / height * (bottom_left - top_left)
            direction = matrix.to_3x3() @ Vector(at)
            hit, place, _, face, thing, _ = scene.ray_cast(graph, matrix.to_translation(), direction)
            if hit and thing.name not in quads:
                material = thing.data.materials[thing.data.polygons[face].material_index]
                shown[y, x], places[y, x] = strength(material) == 0, place
        return shown, places

    def compare(self, here, shown, places):
        means = [picture[shown].mean() for picture in (self.cycles, here)]
        scale, tolerance = max(abs(means[0]), 1e-9), self.wanted.tolerance
        whole = (means[1] - means[0]) / scale
        print(f"mean radiance of surfaces: Cycles {means[0]:.5g}, citylights {means[1]:.5g}, differing by {whole:+.1%}")
        compared = []
        for rows, columns, number in tiles(self.size):
            inside = shown[rows, columns]
            if inside.any():
                pair = [picture[rows, columns][inside].mean(axis=0) for picture in (self.cycles, here)]
                noise = NOISE * np.sqrt(self.variance[rows, columns][inside].sum(axis=0)) / inside.sum()
                place = places[rows, columns][inside].mean(axis=0)
                compared.append(Tile(number, pair, noise, max(scale, pair[0].mean()), place))
        compared.sort(key=lambda tile: -abs(tile.worst()))
        outside = [tile for tile in compared if tile.is_off(tolerance)]
        for tile in outside[:TOLD]:
            print(f"  {tile}{self.nearest(tile.place)}")
        noise = max((tile.noise / tile.scale).max() for tile in compared)
        print(f"Cycles' noise may be {noise:.1%} of a tile" + ("; give more --samples" if noise > tolerance else ""))
        if outside or abs(whole) > tolerance:
            print(f"light differs by more than {tolerance:.1%} in {len(outside)} of {len(compared)} tiles")
            return False
        worst = abs(compared[0].worst())
        print(f"light agrees within {tolerance:.1%} and noise in all {len(compared)} tiles; the worst is off by {worst:.1%}")
        return True

    def nearest(self, place):
        """Which lamp or emitter of the scene as opened is nearest to a place."""
        away = [(float(np.linalg.norm(np.array(at) - place)), name) for name, at in self.found.sources]
        return "; nearest to it is `{1}`, {0:.3g} m off".format(*min(away)) if away else ""


def tiles(size):
    """Rows and columns of each tile, and its number across and down from 1."""
    width, height = size
    for row in range(TILES[1]):
        for column in range(TILES[0]):
            rows = slice(row * height // TILES[1], (row + 1) * height // TILES[1])
            columns = slice(column * width // TILES[0], (column + 1) * width // TILES[0])
            yield rows, columns, (column + 1, row + 1)


def strength(material):
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    return shader.inputs["Emission Strength"].default_value


def make_lambertian(material, looks):
    """Leaves of the Principled shaders of a material diffuse reflection of the file's base colour, and emission."""
    if material.name_full not in looks.known:
        return
    tree = material.node_tree
    for node in tree.nodes if tree else ():
        if node.type != "BSDF_PRINCIPLED":
            continue
        values = {**OTHER_THAN_DIFFUSE, "Base Color": (*looks.of(material).base, 1)}
        for name, value in values.items():
            for link in list(node.inputs[name].links):
                tree.links.remove(link)
            node.inputs[name].default_value = value
        for link in list(node.inputs["Normal"].links):
            tree.links.remove(link)


def give_materials():
    """Gives a grey material to what has none: without one Cycles shows a surface that gleams."""
    grey = bpy.data.materials.new("no material")
    if not grey.node_tree:
        grey.use_nodes = True
    tree = grey.node_tree
    diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (*NO_MATERIAL, 1)
    tree.links.new(diffuse.outputs[0], tree.get_output_node("CYCLES").inputs["Surface"])
    for thing in bpy.data.objects:
        if thing.type in SURFACES and not thing.material_slots:
            thing.data.materials.append(grey)
        for slot in thing.material_slots:
            slot.material = slot.material or grey


def pixels(path):
    """The linear RGB of an EXR file, rows from the top."""
    image = bpy.data.images.load(str(path))
    image.colorspace_settings.name = "Non-Color"
    values = np.empty(image.size[0] * image.size[1] * image.channels, np.float32)
    image.pixels.foreach_get(values)
    values = values.reshape(image.size[1], image.size[0], image.channels)[::-1, :, :3].copy()
    bpy.data.images.remove(image)
    return values
