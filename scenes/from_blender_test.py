"""Holds from_blender.py against Cycles: one small scene for each thing that a Blender file may hold.

    .venv/bin/python scenes/from_blender_test.py target/release/citylights [PART OF A NAME ...]

Each case of scenes/blender/cases.py is saved, converted with --check and compared: light or dark, agreement or none, and
the line that is told must be as the case says, and none told where it says none. Takes about five minutes; ends with how
many passed, and with exit code 1 if one failed.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

import bpy

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
from blender.cases import CASES  # noqa: E402
from blender.cases.build import empty_scene  # noqa: E402

MEANS = re.compile(r"Cycles (\S+), citylights (\S+), differing")
TOLD = re.compile(r"^.*: \d+ \(`.*$", re.MULTILINE)


def convert(*arguments):
    command = [sys.executable, HERE / "from_blender.py", *arguments]
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)


def faults(case, done):
    """What is wrong with the outcome of a case."""
    means = MEANS.search(done.stdout)
    if done.returncode not in (0, 1) or not means:
        return [f"no comparison: {(done.stderr or done.stdout).strip()[-500:]}"]
    found = []
    cycles, here = float(means[1]), float(means[2])
    if (abs(cycles) > 1e-4) != case.lit:
        found.append(f"Cycles' mean is {cycles}")
    if case.agrees and case.lit and here < 1e-4:
        found.append(f"the mean in citylights is {here}")
    if (done.returncode == 0) != case.agrees:
        found.append("they should " + ("agree" if case.agrees else "differ"))
    told = TOLD.findall(done.stdout)
    if case.told is None and told:
        found.append(f"told: {told}")
    if case.told is not None and case.told not in done.stdout:
        found.append(f"`{case.told}` is not told")
    return found


def refusals(folder, citylights):
    """What is refused: each as (its name, the arguments, a part of the line that says why)."""
    empty_scene()
    scene = str(folder / "scene.blend")
    bpy.ops.wm.save_as_mainfile(filepath=scene)
    bpy.data.objects.remove(bpy.data.objects["camera"])
    bare = str(folder / "bare.blend")
    bpy.ops.wm.save_as_mainfile(filepath=bare)
    broken = folder / "broken.blend"
    broken.write_text("no scene")
    out = folder / "out.glb"
    return [
        ("no such file", [folder / "nowhere.blend", out], "no such file"),
        ("another kind of file", [HERE / "plaza.toml", out], "is asked for"),
        ("a broken file", [broken, out], "cannot open"),
        ("a file to write that is no .glb", [scene, folder / "out.png"], "ends in .glb"),
        ("a check without camera", [bare, out, "--check", "--citylights", citylights], "no camera"),
        ("a check without citylights", [scene, out, "--check", "--citylights", "no-such-program"], "no-such-program"),
    ]


def main(citylights, *parts):
    chosen = {name: case for name, case in CASES.items() if not parts or any(part in name for part in parts)}
    if not chosen:
        sys.exit(f"no case has {' or '.join(parts)} in its name")
    outcomes = []
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        for name, case in chosen.items():
            empty_scene()
            case.build()
            blend = folder / "case.blend"
            bpy.ops.wm.save_as_mainfile(filepath=str(blend))
            done = convert(blend, folder / "case.glb", "--check", "--citylights", citylights, "--tolerance", case.tolerance)
            means = MEANS.search(done.stdout)
            outcomes.append((name, "{} {}".format(*means.groups()) if means else "", faults(case, done)))
            print(*outcomes[-1], sep="; ", flush=True)
        for name, arguments, why in [] if parts else refusals(folder, citylights):
            done = convert(*arguments)
            clear = done.returncode != 0 and why in done.stderr and "Traceback" not in done.stderr
            outcomes.append((name, "", [] if clear else [f"{done.returncode}: {done.stderr.strip()[-500:]}"]))
            print(*outcomes[-1], sep="; ", flush=True)
    failed = sum(bool(found) for *_, found in outcomes)
    print(f"{len(outcomes) - failed} passed, {failed} failed")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(*sys.argv[1:])
