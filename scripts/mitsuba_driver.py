# SPDX-License-Identifier: MIT
"""Renders a scene with Mitsuba 3, such as one exported by `rtrays-render SCENE --export NAME.xml`.

Needs a Python that has Mitsuba; `scripts/install --peers` installs one in build/peers.

    build/peers/bin/python scripts/mitsuba_driver.py NAME.xml OUT.exr --spp N [--seed S]
        [--max-depth D] [--runs K]
    build/peers/bin/python scripts/mitsuba_driver.py NAME.xml --serve [--variant V]

With --runs K, renders the seeds S .. S + K - 1 to OUT.S.exr and so on; their spread estimates the
noise. Prints one line of JSON per image: file, seed, spp, seconds, mean of R, G and B. The depth
follows RTRays' convention; Mitsuba's is larger by one. The reconstruction filter is always a box of
one pixel; another filter in the file is ignored.

With --serve, renders whenever a line "MAX_DEPTH SPP SEED" arrives on standard input. It renders
without Russian roulette and keeps no image. It answers with a line of JSON: wall-clock seconds and
processor seconds of all its threads.
"""

import argparse
import json
import os
import pathlib
import re
import sys
import time


def serve(mitsuba, scene, variant):
    print(json.dumps({"engine": f"Mitsuba {mitsuba.__version__} {variant}"}), flush=True)
    for line in sys.stdin:
        depth, spp, seed = map(int, line.split())
        integrator = mitsuba.load_dict({"type": "path", "max_depth": depth + 1,
                                        "rr_depth": 1 << 30})
        start, processor = time.perf_counter(), time.process_time()
        mitsuba.Bitmap(mitsuba.render(scene, integrator=integrator, spp=spp, seed=seed))
        print(json.dumps({"seconds": time.perf_counter() - start,
                          "processor_seconds": time.process_time() - processor}), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path, nargs="?")
    parser.add_argument("--serve", action="store_true")
    parser.add_argument("--spp", type=int)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--max-depth", type=int,
                        help="scattering events, 0 for no limit; by default the scene's value")
    parser.add_argument("--runs", type=int)
    parser.add_argument("--variant", default="llvm_ad_rgb",
                        help="Mitsuba variant; scalar_rgb is slower and does not need LLVM")
    parser.add_argument("--define", action="append", default=[], metavar="NAME=VALUE",
                        help="sets a <default> parameter of the file")
    options = parser.parse_args()
    if not options.serve and (options.output is None or options.spp is None):
        parser.error("expected OUT.exr and --spp, or --serve")
    # Dr.Jit loads any LLVM it finds. Versions before 19 fail on processors with AVX512-FP16
    # ("cannot select").
    libraries = sorted(pathlib.Path("/usr/lib/x86_64-linux-gnu").glob("libLLVM*19*.so*"))
    if libraries:
        os.environ.setdefault("DRJIT_LIBLLVM_PATH", str(libraries[0]))
    try:
        import mitsuba
        import numpy
    except ImportError as error:
        print(f"mitsuba_driver: {error}; scripts/install --peers installs Mitsuba", file=sys.stderr)
        return 77
    mitsuba.set_variant(options.variant)
    mitsuba.set_log_level(mitsuba.LogLevel.Warn)
    defines = dict(define.split("=", 1) for define in options.define)
    if options.max_depth is not None:
        defines["max_depth"] = str(options.max_depth + 1 if options.max_depth > 0 else -1)
    mitsuba.file_resolver().prepend(str(options.scene.resolve().parent))
    text = re.sub(r'<rfilter\s+type="\w+"', '<rfilter type="box"', options.scene.read_text())
    scene = mitsuba.load_string(text, **defines)
    if options.serve:
        serve(mitsuba, scene, options.variant)
        return 0

    for run in range(options.runs or 1):
        seed = options.seed + run
        output = (options.output if options.runs is None
                  else options.output.with_suffix(f".{seed}.exr"))
        start = time.perf_counter()
        image = mitsuba.Bitmap(mitsuba.render(scene, spp=options.spp, seed=seed))
        seconds = time.perf_counter() - start
        formats = (mitsuba.Bitmap.PixelFormat.RGB, mitsuba.Struct.Type.Float32, False)
        part = output.with_suffix(".part.exr")  # renamed when complete
        image.convert(*formats).write(str(part))
        part.replace(output)
        record = {"file": str(output), "seed": seed, "spp": options.spp, "seconds": seconds}
        record["mean"] = [
            float(x) for x in numpy.array(image, dtype=numpy.float64).mean((0, 1))[:3]]
        print(json.dumps({**record, "engine": f"Mitsuba {mitsuba.__version__} {options.variant}"}),
              flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
