# SPDX-License-Identifier: MIT
"""Renders a scene with Mitsuba 3, such as one exported by `rtrays-render SCENE --export NAME.xml`.

Needs a Python that has Mitsuba; `scripts/install --peers` installs one in build/peers.

    build/peers/bin/python scripts/rtrays/peers/mitsuba_driver.py NAME.xml [OUT.exr] [--spp N]
        [--seed S] [--max-depth D] [--runs K] [--serve] [--variant V]

driver.py explains --runs and --serve. The depth follows RTRays' convention; Mitsuba's is larger by
one. The reconstruction filter is always a box of one pixel; another filter in the file is ignored.
"""

import os
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))

from rtrays.peers.driver import parser_of, render_runs, serve, timed  # noqa: E402


def parse():
    """Returns the arguments of the command line."""
    parser = parser_of("mitsuba_driver", __doc__.split("\n\n")[0])
    parser.add_argument(
        "--variant",
        default="llvm_ad_rgb",
        help="Mitsuba variant; scalar_rgb is slower and does not need LLVM",
    )
    parser.add_argument(
        "--define",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="sets a <default> parameter of the file",
    )
    options = parser.parse_args()
    if not options.serve and (options.output is None or options.spp is None):
        parser.error("expected OUT.exr and --spp, or --serve")
    return options


def choose_llvm():
    """Chooses LLVM 19: Dr.Jit loads any version that it finds, and older ones fail on processors
    with AVX512-FP16 ("cannot select")."""
    libraries = sorted(pathlib.Path("/usr/lib/x86_64-linux-gnu").glob("libLLVM*19*.so*"))
    if libraries:
        os.environ.setdefault("DRJIT_LIBLLVM_PATH", str(libraries[0]))


def load(mitsuba, options):
    """Returns the scene of the file."""
    defines = dict(define.split("=", 1) for define in options.define)
    if options.max_depth is not None:
        defines["max_depth"] = str(options.max_depth + 1 if options.max_depth > 0 else -1)
    mitsuba.file_resolver().prepend(str(options.scene.resolve().parent))
    text = re.sub(r'<rfilter\s+type="\w+"', '<rfilter type="box"', options.scene.read_text())
    return mitsuba.load_string(text, **defines)


def main():
    options = parse()
    choose_llvm()
    try:
        import mitsuba
        import numpy
    except ImportError as error:
        print(f"mitsuba_driver: {error}; scripts/install --peers installs Mitsuba", file=sys.stderr)
        return 77
    mitsuba.set_variant(options.variant)
    mitsuba.set_log_level(mitsuba.LogLevel.Warn)
    scene = load(mitsuba, options)
    engine = f"Mitsuba {mitsuba.__version__} {options.variant}"

    images = []

    def keep(**settings):
        images[:] = [mitsuba.Bitmap(mitsuba.render(scene, **settings))]

    def write(output):
        """Writes the image that was rendered last."""
        formats = (mitsuba.Bitmap.PixelFormat.RGB, mitsuba.Struct.Type.Float32, False)
        part = output.with_suffix(".part.exr")  # renamed when complete
        images[0].convert(*formats).write(str(part))
        part.replace(output)

    def render_request(depth, spp, seed, roulette):
        """Renders path tracing with the given depth and roulette."""
        integrator = mitsuba.load_dict(
            {
                "type": "path",
                "max_depth": depth + 1 if depth > 0 else -1,
                "rr_depth": roulette or 1 << 30,
            }
        )
        keep(integrator=integrator, spp=spp, seed=seed)

    def render_image(seed, output):
        """Renders an image into a file; returns its seconds and the means of R, G and B."""
        seconds, _ = timed(lambda: keep(spp=options.spp, seed=seed))
        write(output)
        means = numpy.array(images[0], dtype=numpy.float64).mean((0, 1))[:3]
        return seconds, [float(mean) for mean in means]

    if options.serve:
        serve(engine, render_request, write)
    else:
        render_runs(options, options.spp, engine, render_image)
    return 0


if __name__ == "__main__":
    sys.exit(main())
