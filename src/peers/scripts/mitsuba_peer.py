"""Mitsuba 3 as a peer of citylights: renders an exported scene at pixel centres, direct light only, on one thread.

To make the environment, once, in the folder of the repository (Python 3.9 or later):

    python3 -m venv src/peers/scripts/.venv
    src/peers/scripts/.venv/bin/pip install mitsuba

`citylights compare SCENE --peer mitsuba` then finds it. What is asked of this script and what it prints stands in
README.md beside it.

The variant llvm_ad_rgb, Mitsuba's fastest on a CPU, is taken where an LLVM library works with it. Without one scalar_rgb
is taken, where the pixel centres cost more than the rendering: its times then mean little, and the remarks say so.
"""

import os
import subprocess
import sys
import time

from contract import begin, command_line, run

say = begin()

try:
    import drjit as dr
    import mitsuba as mi
except ImportError as error:
    say(kind="missing", why=str(error))
    raise SystemExit(0)


PROBE = """
import drjit as dr, mitsuba as mi
mi.set_variant("llvm_ad_rgb")
x = dr.arange(mi.Float, 16)
dr.eval(dr.maximum(dr.sqrt(x), 1) + dr.minimum(x, dr.floor(x)))
"""


def choose_variant():
    """The fastest variant that works here: an LLVM too old for Dr.Jit ends the process that tries it."""
    probe = subprocess.run([sys.executable, "-c", PROBE], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return "llvm_ad_rgb" if probe.returncode == 0 else "scalar_rgb"


variant = choose_variant()
mi.set_variant(variant)
dr.set_thread_count(1)


class PixelCentres(mi.Sensor):
    """The exported camera with every ray through the centre of its pixel."""

    def __init__(self, props):
        super().__init__(props)
        self.size = mi.ScalarVector2f(self.film().crop_size())
        self.camera = None

    def centred(self, position):
        return (dr.floor(position * self.size) + 0.5) / self.size

    def sample_ray(self, time, wavelength, position, aperture, active=True):
        return self.camera.sample_ray(time, wavelength, self.centred(position), aperture, active)

    def sample_ray_differential(self, time, wavelength, position, aperture, active=True):
        return self.camera.sample_ray_differential(time, wavelength, self.centred(position), aperture, active)


def main():
    arguments = command_line(__doc__.split("\n")[0]).parse_args()
    slow = "; without LLVM the pixel centres cost more than the rendering" if variant == "scalar_rgb" else ""
    say(
        kind="about",
        renderer=f"Mitsuba {mi.__version__} ({variant})",
        remarks=[
            "one light sample and one shadow ray a sample, lights chosen uniformly by shape: all triangles of one "
            "radiance are one shape; independent random numbers",
            "CPU s are those of the process, one thread, each image rendered in one block, which begins with tracing its "
            "program in Python. Set-up is loading, building and compiling, unless Dr.Jit has the program in its cache on disk: "
            f"what a first image takes beyond the same image made again, without the start of Python{slow}",
        ],
    )
    if not arguments.seeds:
        return
    mi.register_sensor("pixel_centres", PixelCentres)
    begun = time.process_time()
    scene = mi.load_file(arguments.scene)
    camera = scene.sensors()[0]
    sensor = mi.load_dict({"type": "pixel_centres", "film": camera.film(), "sampler": camera.sampler()})
    sensor.camera = camera

    lanes = camera.film().crop_size()
    # Above that many samples at once, memory and not the renderer would be measured.
    most = max(1, 2**24 // (lanes[0] * lanes[1]))

    def render(count, seed, path):
        cpu, wall = time.process_time(), time.perf_counter()
        image, done = 0, 0
        while done < count:
            part = min(most, count - done)
            image += mi.render(scene, sensor=sensor, spp=part, seed=seed + done) * (part / count)
            dr.eval(image)
            done += part
        dr.sync_thread()
        cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
        bitmap = mi.Bitmap(image).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, srgb_gamma=False)
        dr.set_thread_count(2)  # Mitsuba 3.9 writes EXR on the same pool, and waits for ever where it has one thread.
        bitmap.write(path)
        dr.set_thread_count(1)
        return cpu, wall

    run(say, arguments, begun, render)


main()
