"""What is shown, hidden, instanced, linked, driven or in the way; the world and other surfaces."""

import bpy

from .build import Case, added, black_world, lamp, square


def driven():
    data = lamp("POINT").data
    data.driver_add("energy").driver.expression = "700"


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


def with_camera(change):
    """A lit box in a wide picture with sky, and a second camera that is not the scene's; `change` gets the camera."""

    def build():
        lamp("POINT", (2, 1, 3))
        scene, box = bpy.context.scene, square("wall", 1.5)
        box.location, box.rotation_euler = (0, 1, 0.75), (1.57, 0, 0)
        second = added("another", bpy.data.cameras.new("another"))
        scene.collection.objects.unlink(second)
        scene.collection.objects.link(second)
        scene.render.resolution_x, scene.render.resolution_y = 1920, 1080
        camera = scene.camera
        camera.data.sensor_fit, camera.location, camera.rotation_euler = "AUTO", (1, -4, 1.5), (1.45, 0, 0.2)
        change(camera, scene)

    return build


def shifted(camera, scene):
    camera.data.shift_x = 0.2


def scaled(camera, scene):
    camera.scale = (2, 2, 2)


def upright(camera, scene):
    scene.render.resolution_x, scene.render.resolution_y, scene.render.pixel_aspect_x = 540, 960, 1.5


def unset(camera, scene):
    bpy.data.objects.remove(bpy.data.objects["another"])
    scene.camera = None


def pointless(camera, scene):
    """Settings of a render that are no light."""
    scene.cycles.film_exposure, scene.view_settings.exposure, scene.render.film_transparent = 3, 2, True
    scene.render.resolution_percentage, scene.render.use_border = 50, True
    camera.data.dof.use_dof = True


def world():
    lamp("POINT")
    made = bpy.context.scene.world = black_world()
    made.node_tree.nodes["Background"].inputs["Color"].default_value = (1, 1, 1, 1)


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


CASES = {
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
    "world": Case(world, "left out: the light of the world", agrees=False),
    "floor without material": Case(no_material),
    "floor that gleams": Case(glossy_floor),
    "camera": Case(with_camera(lambda *_: None)),
    "camera shifted": Case(with_camera(shifted), "cameras with a shift"),
    "camera scaled": Case(with_camera(scaled)),
    "camera upright, wide pixels": Case(with_camera(upright)),
    "camera not set": Case(with_camera(unset)),
    "exposures of the camera": Case(with_camera(pointless)),
    "nothing": Case(nothing, "nothing in the scene gives light", lit=False),
}
