"""What every peer script shares: the command line, and one JSON object a line on standard output. See README.md."""

import argparse
import json
import os
import sys
import time


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


def run(say, arguments, begun, render):
    """Renders every seed at every sample count, each image in one block, and tells of each.

    `render(count, seed, path)` renders, writes `path` and gives the CPU and the wall seconds of rendering: all that is
    paid for that image once the scene is ready. `begun` is the CPU time of the process before it loaded the scene. The
    set-up is what a first image takes beyond the same image made again: loading, building, compiling.
    """
    first = os.path.join(arguments.out, "first.exr")
    render(1, 0, first)
    ready = time.process_time()
    render(1, 0, first)
    again = time.process_time() - ready
    setup_s = max(ready - begun - again, 0.0)
    for seed in arguments.seeds:
        files = {count: f"{seed}-{count}.exr" for count in arguments.spp}
        # The largest first: it shows best which thread computes.
        largest_first = reversed(arguments.spp)
        spent = {count: render(count, seed, os.path.join(arguments.out, files[count])) for count in largest_first}
        for count in arguments.spp:
            cpu, wall = spent[count]
            say(kind="image", seed=seed, spp=count, setup_s=setup_s, cpu_s=cpu, wall_s=wall, file=files[count])
