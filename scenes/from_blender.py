"""Turns what Blender opens into a glTF file that citylights reads.

    python3.11 -m venv .venv && .venv/bin/pip install bpy numpy
    .venv/bin/python scenes/from_blender.py SCENE.{blend,fbx,usd,usdc,gltf,glb,obj} OUT.glb [--dim X]

It also runs inside an installed Blender: blender -b --python scenes/from_blender.py -- SCENE OUT.glb

What stays the same: geometry with modifiers and instances, cameras, point, spot and sun lights (1 W/sr becomes 1 cd),
base colours. What changes, with its power kept:
- a textured base colour becomes the texture's mean;
- an emission texture becomes a few plain emissive materials: each face takes the texture's mean over itself, faces of
  like brightness share their area-weighted mean, and faces under --dim (0.01 of the material's brightest) go dark;
- area lights become emissive quads of the same power.
What reaches citylights of a material is the Principled shader's base colour and emission, on Lambertian surfaces. Each
thing that gives light and cannot be carried (a world that is not black, lamps within instanced collections, other shaders
that emit) is told in a line.
"""

import math
import sys
from pathlib import Path

import bpy
import numpy as np

# Faces of like brightness share a material: levels half a stop apart.
LEVELS_PER_STOP = 2
# Texture look-ups per triangle: a regular grid of barycentric points.
GRID = [((i + 1 / 3) / 8, (j + 1 / 3) / 8) for i in range(8) for j in range(8 - i)]


def open_scene(path):
    """Opens `path` in an empty Blender."""
    kind = path.suffix.lower()
    if kind == ".blend":
        bpy.ops.wm.open_mainfile(filepath=str(path))
        return
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if kind == ".fbx":
        bpy.ops.wm.fbx_import(filepath=str(path))
    elif kind in (".usd", ".usda", ".usdc", ".usdz"):
        bpy.ops.wm.usd_import(filepath=str(path))
    elif kind == ".obj":
        bpy.ops.wm.obj_import(filepath=str(path))
    elif kind in (".gltf", ".glb"):
        bpy.ops.import_scene.gltf(filepath=str(path), export_import_convert_lighting_mode="COMPAT")
    else:
        sys.exit(f"{path}: .blend, .fbx, .usd, .obj, .gltf or .glb is right")


def principled(material):
    """The Principled BSDF of a material, or None."""
    nodes = material.node_tree.nodes if material and material.node_tree else []
    return next((node for node in nodes if node.type == "BSDF_PRINCIPLED"), None)


def texture_of(socket):
    """The pixels (rows from the bottom, columns, linear RGB) of an image that feeds `socket` directly, or None."""
    node = socket.links[0].from_node if socket.is_linked else None
    if node is None or node.type != "TEX_IMAGE" or node.image is None or node.image.size[0] == 0:
        return None
    image = node.image
    pixels = np.empty(image.size[0] * image.size[1] * image.channels, np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(image.size[1], image.size[0], image.channels)
    rgb = pixels[..., :3] if image.channels >= 3 else np.repeat(pixels[..., :1], 3, axis=2)
    if image.colorspace_settings.name == "sRGB" and not image.is_float:
        rgb = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    return rgb


def disconnect(material, socket, value):
    """Gives `socket` a plain value in place of its links."""
    for link in list(socket.links):
        material.node_tree.links.remove(link)
    socket.default_value = value


def plain_base_colours():
    """Puts means in place of base colour textures."""
    for material in bpy.data.materials:
        shader = principled(material)
        if shader and shader.inputs["Base Color"].is_linked:
            texels = texture_of(shader.inputs["Base Color"])
            mean = texels.mean(axis=(0, 1)) if texels is not None else np.full(3, 0.5)
            disconnect(material, shader.inputs["Base Color"], (*mean, 1.0))


def means_over_faces(mesh, texels):
    """Mean of a texture over each triangle of a triangulated mesh; the texture repeats."""
    corners = np.empty(len(mesh.loops) * 2, np.float32)
    mesh.uv_layers.active.data.foreach_get("uv", corners)
    a, b, c = np.moveaxis(corners.reshape(-1, 3, 2), 1, 0)
    height, width = texels.shape[:2]
    total = np.zeros((len(a), 3))
    for u, v in GRID:
        at = a + u * (b - a) + v * (c - a)
        x = np.floor(at[:, 0] * width).astype(int) % width
        y = np.floor(at[:, 1] * height).astype(int) % height
        total += texels[y, x]
    return total / len(GRID)


def split_emission(mesh, slot, material, dim):
    """Gives the faces of `mesh` with `material` in `slot` plain emissive materials by brightness."""
    texels = texture_of(principled(material).inputs["Emission Color"])
    faces = np.array([p.index for p in mesh.polygons if p.material_index == slot])
    if len(faces) == 0:
        return
    if texels is None or mesh.uv_layers.active is None:
        print(f"{material.name}: emission that is no plain image is taken as it shows by default")
        colours = np.repeat([principled(material).inputs["Emission Color"].default_value[:3]], len(faces), axis=0)
    else:
        colours = means_over_faces(mesh, texels)[faces]
    areas = np.array([mesh.polygons[i].area for i in faces])
    brightness = colours.max(axis=1)
    level = np.floor(LEVELS_PER_STOP * np.log2(np.maximum(brightness, 1e-12))).astype(int)
    level[brightness <= dim * brightness.max()] = -10_000
    for value in np.unique(level):
        members = level == value
        copy = material.copy()
        shader = principled(copy)
        mean = np.average(colours[members], axis=0, weights=areas[members] + 1e-30)
        disconnect(copy, shader.inputs["Emission Color"], (*mean, 1.0))
        if value == -10_000:
            shader.inputs["Emission Strength"].default_value = 0.0
        mesh.materials.append(copy)
        for i in faces[members]:
            mesh.polygons[i].material_index = len(mesh.materials) - 1


def tell_what_is_lost():
    """A line for each thing whose light does not come along."""
    world = bpy.context.scene.world
    background = next((n for n in world.node_tree.nodes if n.type == "BACKGROUND"), None) if world and world.node_tree else None
    if background and (background.inputs["Color"].is_linked or max(background.inputs["Color"].default_value[:3]) > 0):
        print("left out: the light of the world (sky or environment map)")
    for instance in bpy.context.evaluated_depsgraph_get().object_instances:
        if instance.is_instance and instance.object.type == "LIGHT":
            print(f"left out: lamp `{instance.object.name}` within an instanced collection")
    for material in bpy.data.materials:
        nodes = material.node_tree.nodes if material.node_tree else []
        if any(node.type == "EMISSION" for node in nodes):
            print(f"left out: the Emission shader of material `{material.name}`; only Principled is read")
        shader = principled(material)
        if shader and shader.inputs["Emission Strength"].is_linked:
            print(f"left out: the texture on the emission strength of material `{material.name}`")


def plain_emission(dim):
    """Puts plain emissive materials in place of emission textures."""
    for mesh in [thing.data for thing in bpy.data.objects if thing.type == "MESH"]:
        for slot, material in enumerate(list(mesh.materials)):
            shader = principled(material)
            if shader and shader.inputs["Emission Color"].is_linked and shader.inputs["Emission Strength"].default_value > 0:
                split_emission(mesh, slot, material, dim)


def freeze_meshes():
    """Applies modifiers, makes instances real, gives each object a triangulated mesh with its own materials."""
    import bmesh

    graph = bpy.context.evaluated_depsgraph_get()
    made = []
    for instance in graph.object_instances:
        source = instance.object
        if source.hide_render or source.type not in ("MESH", "CURVE", "SURFACE", "FONT", "META"):
            continue
        mesh = bpy.data.meshes.new_from_object(source, depsgraph=graph)
        if not mesh or not mesh.polygons:
            continue
        mesh.transform(instance.matrix_world)
        if instance.matrix_world.determinant() < 0:
            mesh.flip_normals()
        triangles = bmesh.new()
        triangles.from_mesh(mesh)
        bmesh.ops.triangulate(triangles, faces=triangles.faces[:])
        triangles.to_mesh(mesh)
        triangles.free()
        made.append((source.name, mesh))
    for thing in list(bpy.data.objects):
        if thing.type not in ("LIGHT", "CAMERA"):
            world = {child: child.matrix_world.copy() for child in thing.children if child.type in ("LIGHT", "CAMERA")}
            bpy.data.objects.remove(thing)
            for child, matrix in world.items():
                child.matrix_world = matrix
    for name, mesh in made:
        bpy.context.scene.collection.objects.link(bpy.data.objects.new(name, mesh))


def quads_for_area_lights():
    """Puts emissive quads of the same power in place of area lights."""
    for lamp in [thing for thing in bpy.data.objects if thing.type == "LIGHT" and thing.data.type == "AREA"]:
        data = lamp.data
        width = data.size
        height = data.size_y if data.shape in ("RECTANGLE", "ELLIPSE") else data.size
        if data.shape in ("DISK", "ELLIPSE"):
            width, height = (side * math.sqrt(math.pi) / 2 for side in (width, height))
        scale = lamp.matrix_world.to_scale()
        area = width * scale.x * height * scale.y
        material = bpy.data.materials.new(f"{lamp.name} glow")
        material.use_nodes = True
        material.use_backface_culling = True
        shader = principled(material)
        shader.inputs["Base Color"].default_value = (0, 0, 0, 1)
        shader.inputs["Emission Color"].default_value = (*data.color, 1.0)
        shader.inputs["Emission Strength"].default_value = data.energy * 2 ** getattr(data, "exposure", 0) / (math.pi * area)
        x, y = width / 2, height / 2
        mesh = bpy.data.meshes.new(f"{lamp.name} quad")
        # An area light shines along its own -z: corners clockwise about +z.
        mesh.from_pydata([(-x, -y, 0), (-x, y, 0), (x, y, 0), (x, -y, 0)], [], [(0, 1, 2, 3)])
        mesh.materials.append(material)
        quad = bpy.data.objects.new(lamp.name, mesh)
        quad.matrix_world = lamp.matrix_world
        bpy.context.scene.collection.objects.link(quad)
        bpy.data.objects.remove(lamp)


def main(arguments):
    dim = 0.01
    if len(arguments) == 4 and arguments[2] == "--dim":
        dim = float(arguments[3])
    elif len(arguments) != 2:
        sys.exit(__doc__)
    source, target = map(Path, arguments[:2])
    if not source.exists():
        sys.exit(f"{source}: no such file")
    open_scene(source)
    tell_what_is_lost()
    for thing in [thing for thing in bpy.data.objects if thing.type == "LIGHT" and thing.hide_render]:
        bpy.data.objects.remove(thing)
    freeze_meshes()
    quads_for_area_lights()
    plain_emission(dim)
    plain_base_colours()
    bpy.ops.export_scene.gltf(
        filepath=str(target),
        export_format="GLB",
        export_cameras=True,
        export_lights=True,
        export_import_convert_lighting_mode="COMPAT",
        export_materials="EXPORT",
        export_image_format="NONE",
        export_texcoords=False,
        export_animations=False,
        export_skins=False,
        export_morph=False,
    )
    print(f"{target}: citylights inspect {target}")


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:])
