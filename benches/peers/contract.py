"""What every peer script shares: the command line, and one JSON object a line on standard output. See README.md."""

import argparse
import json
import os
import sys


def begin():
    """Keeps standard output for the contract: whatever else prints goes to standard error. Gives `say`."""
    kept = os.fdopen(os.dup(1), "w")
    sys.stdout.flush()
    os.dup2(2, 1)

    def say(**line):
        print(json.dumps(line), file=kept, flush=True)

    return say


def command_line(description):
    """A parser of the arguments that every script takes."""
    numbers = lambda text: [int(number) for number in text.split(",") if number]
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("scene", help="the exported scene")
    parser.add_argument("--out", required=True, help="the folder for images")
    parser.add_argument("--spp", required=True, type=numbers, help="sample counts, ascending: 1,4,16")
    parser.add_argument("--seeds", required=True, type=numbers, help="one a run: 1,2,3; with none, only say what this is")
    return parser


def run(say, arguments, setup_s, render):
    """Renders every seed at every sample count and tells of each image.

    `render(count, seed, path)` renders, writes `path` and gives the CPU and the wall seconds of rendering. Part of those
    is paid whatever the count; so an image's time is its count times the slope between the least and the largest one.
    `setup_s` is the CPU time up to and with a first rendering at one sample.
    """
    counts = arguments.spp
    for seed in arguments.seeds:
        files = {count: f"{seed}-{count}.exr" for count in counts}
        spent = {count: render(count, seed, os.path.join(arguments.out, files[count])) for count in counts}
        low, high = counts[0], counts[-1]
        if low == high:
            high = 4 * low
            spent[high] = render(high, seed, os.path.join(arguments.out, "more.exr"))
        cpu, wall = ((spent[high][i] - spent[low][i]) / (high - low) for i in (0, 1))
        if cpu <= 0:
            # Too few samples for a slope: all of the largest count's time is a bound from above.
            cpu, wall = (spent[high][i] / high for i in (0, 1))
        for count in counts:
            say(
                kind="image",
                seed=seed,
                spp=count,
                setup_s=max(setup_s - cpu, 0.0),
                cpu_s=count * cpu,
                wall_s=max(count * wall, 0.0),
                file=files[count],
            )
