# SPDX-License-Identifier: MIT
"""Compares third-party scenes: our import with Mitsuba's rendering of the original file, and with
the image that is distributed with the scene."""

from rtrays.peers.renderers import RUNS, average, compare, mitsuba, own_image
from rtrays.peers.results import result_of

# Name, size of the comparison, size of the distributed image, and depth.
SCENES = (
    ("cornell-box-bitterli", (256, 256), (1024, 1024), 0),
    ("veach-mis", (320, 180), (1280, 720), 1),
)
SPP = 512


def render(scene, output, spp, seed, size, max_depth):
    """Renders a third-party scene with rtrays-render."""
    film = ["--size", "{}x{}".format(*size), "--set", f"integrator.max_depth={max_depth}"]
    own_image("rtrays-render", scene, output, "--spp", spp, "--seed", seed, *film)


def render_original(scene, output, size, max_depth):
    """Renders the original file with Mitsuba."""
    defines = (f"resx={size[0]}", f"resy={size[1]}", "integrator=path")
    more = [word for define in defines for word in ("--define", define)]
    average(mitsuba(scene, output, SPP // RUNS, 41, max_depth, RUNS, *more), output)


def compare_scene(meshes, folder, name, size, full, max_depth):
    """Returns the comparisons of one scene."""
    scene, ours, theirs = (
        meshes / name / "scene.xml",
        folder / "renderer.exr",
        folder / "mitsuba.exr",
    )
    folder.mkdir(parents=True, exist_ok=True)
    render(scene, ours, SPP, 31, size, max_depth)
    render_original(scene, theirs, size, max_depth)
    render(scene, folder / "full.exr", 64, 32, full, max_depth)
    other = compare(folder / "full.exr", meshes / name / "TungstenRender.exr")
    return {
        "scene": name,
        "max_depth": max_depth,
        "original": result_of(compare(ours, theirs)),
        "tungsten": {key: other[key] for key in ("mean_ratio", "relmse")},
    }


def compare_third_party(meshes, folder):
    """Compares the third-party scenes in the folder `meshes`. Returns the rows of the table."""
    rows = []
    for name, *settings in SCENES:
        row = compare_scene(meshes, folder / name, name, *settings)
        ratios = [round(ratio, 5) for ratio in row["tungsten"]["mean_ratio"]]
        print(f"{name}: mean ratio to Tungsten {ratios}", flush=True)
        rows.append(row)
    return rows
