"""Turns what Blender opens into a glTF file that citylights reads.

    python3.11 -m venv .venv && .venv/bin/pip install bpy numpy
    .venv/bin/python scenes/from_blender.py SCENE.{blend,fbx,usd,usdc,gltf,glb,obj} OUT.glb [--dim X] [--check]

It also runs inside an installed Blender, 4.5 or newer: blender -b --python scenes/from_blender.py -- SCENE OUT.glb
What it does is in the files of scenes/blender/ beside it.

Cycles' rendering of the scene is what is right: what is hidden in renders or excluded gives no light, instances do, fields
and plain nodes of lamps count (exposure, temperature, normalize, strength). Where the scene is glTF, the edges of spots and
the sides on which materials shine stay those of the file.

What stays the same: geometry with modifiers and instances, cameras, the power of lamps (1 W/sr becomes 1 cd), base colours
and emission of Principled, Emission and Diffuse shaders, also where they are added or mixed by numbers. What changes, with
its power kept:
- a textured base colour becomes the texture's mean;
- an emission texture becomes a few plain emissive materials: each face takes the texture's mean over itself, faces of
  like brightness and hue share their mean, and faces under --dim (0.01 of the material's brightest) go dark;
- area lamps become emissive quads, which block light and are seen; those with a spread become grids of spots;
- the soft edge of a spot becomes glTF's, which has another profile;
- lamps with a radius become points, suns with an angle become directions: their shadows are hard.
All surfaces are Lambertian. Whatever else loses or changes light is told in a line.

--check renders a small picture of the scene as it was opened in Cycles, in direct light, with all Principled surfaces made
Lambertian as citylights has them, and the same view of OUT.glb in citylights. It says how far the light differs and where,
and exits with 1 where a tile of the picture or all of it differs by more than --tolerance beyond Cycles' noise: in parts of
the tile's mean, or of the picture's where the tile is darker. Pixels that show the sky or an emitter are not compared.
"""

import argparse
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))
from blender import check, found, opened, plain  # noqa: E402
from blender.notes import Notes  # noqa: E402


def command_line(arguments):
    parser = argparse.ArgumentParser(
        prog="from_blender.py", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("scene", type=Path, metavar="SCENE", help=".blend, .fbx, .usd, .obj, .gltf or .glb")
    parser.add_argument("out", type=Path, metavar="OUT.glb", help="the file to write")
    parser.add_argument("--dim", type=float, default=0.01, help="share of a texture's brightest below which faces go dark [0.01]")
    parser.add_argument("--check", action="store_true", help="compare with a picture in Cycles")
    parser.add_argument("--citylights", default="citylights", metavar="PROGRAM", help="for --check [citylights]")
    parser.add_argument("--tolerance", type=float, default=0.05, help="for --check: most relative difference [0.05]")
    parser.add_argument("--samples", type=int, default=256, help="for --check: Cycles' samples per pixel [256]")
    return parser.parse_args(arguments)


def main(arguments):
    wanted = command_line(arguments)
    target = wanted.out
    if target.suffix.lower() != ".glb" or not target.parent.is_dir():
        sys.exit(f"{target}: a name that ends in .glb, in a folder that exists, is asked for")
    if wanted.check:
        check.find(wanted.citylights)
    opened.open_scene(wanted.scene)
    notes = Notes()
    what = found.Found(wanted.scene.suffix.lower() in (".gltf", ".glb"), notes)
    picture = check.Check(what, wanted) if wanted.check else None
    quads = plain.replace(what, wanted.dim)
    bpy.ops.export_scene.gltf(
        filepath=str(target),
        export_format="GLB",
        use_active_scene=True,
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
    for line in notes.lines():
        print(line)
    if not what.lamps and not any(mesh.shines for mesh in what.meshes):
        print("nothing in the scene gives light")
    if picture and not picture.agrees(target, quads):
        sys.exit(1)
    print(f"{target}: citylights inspect {target}")


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:])
