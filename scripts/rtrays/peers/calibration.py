# SPDX-License-Identifier: MIT
"""Compares the units of the peers' lights and textures with closed forms."""

import math
import statistics

from rtrays.paths import SCENES
from rtrays.peers.renderers import PEERS, export

RHO, STEPS = (0.8, 0.5, 0.2), (1, 2, 4)
# Mean radiance of scenes/analytic per channel, as derived in the scenes' descriptions.
CLOSED_FORMS = {
    "fov_axis": ("radiance of an emissive mesh, seen directly", [s / 16 for s in STEPS]),
    "disc_light": (
        "radiance of an emissive disc, by its illumination",
        [r * s * 0.25 / 16.25 for r, s in zip(RHO, STEPS)],
    ),
    "sphere_light": (
        "radiance of an emissive sphere, by its illumination",
        [r * s * 0.25 / 16 for r, s in zip(RHO, STEPS)],
    ),
    "three_lamps": (
        "radiance of three emissive spheres, one per channel, by their illumination",
        [0.8 * r * s * 0.25 / 16 for r, s in zip(RHO, STEPS)],
    ),
    "point_light": (
        "intensity of a point light",
        [r / math.pi * 10 * s / 4 for r, s in zip(RHO, STEPS)],
    ),
    "spot_light": (
        "intensity of a spot light",
        [r / math.pi * 10 * s / 4 for r, s in zip(RHO, STEPS)],
    ),
    "directional_light": (
        "irradiance of a directional light",
        [r / math.pi * s / 2 for r, s in zip(RHO, STEPS)],
    ),
    "dome": ("radiance of the surroundings", [r * s for r, s in zip(RHO, STEPS)]),
    "texture_srgb": ("sRGB texels", [((128 / 255 + 0.055) / 1.055) ** 2.4] * 3),
}
# Allows for Cycles' triangulation of a sphere and for the cosines across half a degree of field.
CALIBRATION_TOLERANCE = 3e-4
# As few samples per run as a step of the references has (reference/peer.cpp). Point sets that are
# laid out for more samples hide their bias.
CALIBRATION = {"spp": 256, "runs": 64}


def ratio_of(means, expected):
    """Returns the ratio of the mean of several runs to the expected value, its relative standard
    error, and whether the ratio is 1 up to the tolerance."""
    error = statistics.stdev(means) / math.sqrt(len(means)) / expected
    ratio = statistics.fmean(means) / expected
    # Student's t with 63 degrees of freedom: 54 tests at 0.01 together.
    meets = abs(ratio - 1) <= 4.0 * error + CALIBRATION_TOLERANCE and error < 2e-3
    return ratio, error, meets


def calibrate_unit(name, peer, folder):
    """Compares one unit in one peer with its closed form. Returns a row of the table."""
    what, expected = CLOSED_FORMS[name]
    ending, render, seed = PEERS[peer]
    scene = folder / (name + ending)
    export(SCENES / f"analytic/{name}.json", scene)
    image = folder / f"{name}.{peer}.exr"
    runs = render(scene, image, CALIBRATION["spp"], seed, 0, CALIBRATION["runs"])
    channels = zip(*(run["mean"] for run in runs))
    ratios, errors, meets = zip(*map(ratio_of, channels, expected))
    return {
        "what": what,
        "scene": name,
        "peer": peer,
        "ratio": list(ratios),
        "standard_error": list(errors),
        "meets": all(meets),
    }


def calibrate(folder):
    """Compares every unit in every peer with its closed form. Returns the rows of the table."""
    rows = []
    for name in CLOSED_FORMS:
        for peer in PEERS:
            row = calibrate_unit(name, peer, folder)
            verdict = "ok  " if row["meets"] else "FAIL"
            ratios = [round(ratio, 5) for ratio in row["ratio"]]
            print(f"{verdict} {row['what']}, {peer}: {ratios}", flush=True)
            rows.append(row)
    return rows
