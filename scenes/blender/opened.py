"""What does Cycles get to see of a scene?

Blender gives a renderer a list of all that is shown in a render: objects with modifiers at the levels of a render, each
instance, and nothing that is hidden in renders or lies in an excluded collection. A renderer that only reads that list is
registered here and asked for a picture.
"""

import sys

import bpy

OPENERS = {
    ".fbx": lambda path: bpy.ops.wm.fbx_import(filepath=path),
    ".obj": lambda path: bpy.ops.wm.obj_import(filepath=path),
    ".usd": lambda path: bpy.ops.wm.usd_import(filepath=path),
    ".gltf": lambda path: bpy.ops.import_scene.gltf(filepath=path, export_import_convert_lighting_mode="COMPAT"),
}
ALIASES = {".usda": ".usd", ".usdc": ".usd", ".usdz": ".usd", ".glb": ".gltf"}


def open_scene(path):
    """Opens `path`, a file of another kind than Blender's own in an empty Blender."""
    kind = path.suffix.lower()
    kind = ALIASES.get(kind, kind)
    if not path.is_file():
        sys.exit(f"{path}: no such file")
    if kind != ".blend" and kind not in OPENERS:
        sys.exit(f"{path}: .blend, .fbx, .usd, .obj, .gltf or .glb is asked for")
    try:
        if kind == ".blend":
            bpy.ops.wm.open_mainfile(filepath=str(path))
        else:
            bpy.ops.wm.read_factory_settings(use_empty=True)
            OPENERS[kind](str(path))
    except RuntimeError as error:
        sys.exit(f"{path}: Blender cannot open it: {error}")
    # Values that are animated or driven take those of the present frame.
    bpy.context.scene.frame_set(bpy.context.scene.frame_current)


def first_camera(scene):
    """The scene's camera, or its first where none is set, or None."""
    return scene.camera or next((thing for thing in scene.objects if thing.type == "CAMERA"), None)


def as_rendered(read):
    """Calls `read` with the dependency graph of a render of the present view layer."""
    failures, layer = [], bpy.context.view_layer.name

    class Reading(bpy.types.RenderEngine):
        bl_idname = "CITYLIGHTS_READING"
        bl_label = "Reading"

        def render(self, graph):
            try:
                if graph.view_layer.name == layer:
                    read(graph)
            # Blender would print it and go on.
            except BaseException as error:
                failures.append(error)

    scene = bpy.context.scene
    kept = scene.camera
    stand_in = None
    if first_camera(scene) is None:
        # Blender renders nothing without a camera.
        stand_in = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
        scene.collection.objects.link(stand_in)
    scene.camera = first_camera(scene)
    engine, render = scene.render.engine, scene.render
    settings = {
        "resolution_x": 64,
        "resolution_y": 64,
        "resolution_percentage": 100,
        "use_compositing": False,
        "use_sequencer": False,
        "use_single_layer": False,
        "use_border": False,
        "use_multiview": False,
    }
    before = {name: getattr(render, name) for name in settings}
    in_use = bpy.context.view_layer.use
    bpy.utils.register_class(Reading)
    try:
        render.engine, bpy.context.view_layer.use = Reading.bl_idname, True
        for name, value in settings.items():
            setattr(render, name, value)
        bpy.ops.render.render()
    finally:
        render.engine, bpy.context.view_layer.use = engine, in_use
        for name, value in before.items():
            setattr(render, name, value)
        bpy.utils.unregister_class(Reading)
        scene.camera = kept
        if stand_in:
            bpy.data.objects.remove(stand_in)
    if failures:
        raise failures[0]
