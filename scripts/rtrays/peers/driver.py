# SPDX-License-Identifier: MIT
"""The part that the drivers of Mitsuba and Cycles share: arguments, seeds, and timed renders.

With --runs K, a driver renders the seeds S .. S + K - 1 to OUT.S.exr and so on; their spread
estimates the noise. It prints one line of JSON per image: file, seed, spp, seconds, and the mean of
R, G and B.

With --serve, a driver renders whenever a line "MAX_DEPTH SPP SEED ROULETTE [OUT.exr]" arrives on
standard input. ROULETTE is the scattering event from which Russian roulette may end a path, 0 for
none. It answers with a line of JSON: wall-clock seconds and processor seconds of all its threads,
without the time to write OUT.exr.
"""

import argparse
import json
import pathlib
import sys
import time


def parser_of(name, description):
    """Returns the parser of a driver's arguments."""
    parser = argparse.ArgumentParser(prog=name, description=description)
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path, nargs="?")
    parser.add_argument("--serve", action="store_true")
    parser.add_argument("--spp", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument(
        "--max-depth",
        type=int,
        help="scattering events, 0 for no limit; by default the scene's value",
    )
    parser.add_argument("--runs", type=int)
    return parser


def show(record):
    """Prints a line of JSON at once."""
    print(json.dumps(record), flush=True)


def timed(render, *arguments):
    """Returns the wall-clock and processor seconds of a render."""
    start, processor = time.perf_counter(), time.process_time()
    render(*arguments)
    return time.perf_counter() - start, time.process_time() - processor


def serve(engine, render, write):
    """Answers requests on standard input. `render` takes depth, samples per pixel, seed and first
    event of roulette; `write` takes the file for the rendered image."""
    show({"engine": engine})
    for line in sys.stdin:
        *numbers, output = (line.rstrip("\n") + " ").split(" ", 4)
        seconds, processor = timed(render, *map(int, numbers))
        if output.strip():
            write(pathlib.Path(output.strip()))
        show({"seconds": seconds, "processor_seconds": processor})


def render_runs(options, spp, engine, render):
    """Renders all seeds. `render` takes seed and output; it writes the image and returns its
    seconds and means."""
    for seed in range(options.seed, options.seed + (options.runs or 1)):
        output = options.output.resolve()
        if options.runs is not None:
            output = output.with_suffix(f".{seed}.exr")
        seconds, mean = render(seed, output)
        record = {"file": str(output), "seed": seed, "spp": spp, "seconds": seconds, "mean": mean}
        show({**record, "engine": engine})
