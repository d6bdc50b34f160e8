# SPDX-License-Identifier: MIT
"""The table of how references by several renderers agree, and our own image with them."""

from measurement_tables import NONE, name
from run_document import value
from tables import Table

# What was looked into, by scene and renderer.
KNOWN = {
    ("cornell_bumps", "mitsuba"):
        "Mitsuba starts rays 1.8e-4 (1 + the largest coordinate) off their surface, here 0.1, where bumps are 8 high: light of "
        "their grooves is lost. At the upper middle of the back wall its red is 0.23 % below Embree's; with the scene moved so "
        "that this wall lies at the origin it is 0.02 % ± 0.03 % above, and moved away by 1000 it is 0.9 % below.",
    ("glass_goblets", "cycles"):
        "We and Embree end paths whose direction lies on different sides of the interpolated and the geometric normal, a rule "
        "that holds backwards too, as light paths need; Cycles and Mitsuba let refracted light pass. In a uniform dome, where "
        "every pixel should be 1 (scenes/peers/goblet_furnace.json, 4096 samples, ours 1024), a goblet is 0.044 % ± 0.0003 too "
        "dark by Embree, up to 7 % in a pixel of its outline, 0.045 % ± 0.0005 by ours, -0.004 % ± 0.005 by Cycles, -0.006 % ± "
        "0.008 by Mitsuba. At the left goblet's rim (scenes/peers/goblet_rim.json, 8192 samples) Cycles is 2.2 % above Embree "
        "(0.1916 ± 0.0002, 0.1874 ± 0.0001), and without interpolated normals equal (0.1884 ± 0.0002, 0.1884 ± 0.0001).",
    ("floor_lamps", "mitsuba"): "Mitsuba 3 has no cone, which the lamps stand on.",
}


def reference_agreement(run):
    renderers, pairs, notes = [], [], []
    for row in run.get("rows"):
        scene = value(row, "scene")
        for renderer in value(row, "renderers"):
            renderers.append([name(scene), value(renderer, "engine"), f"{value(renderer, 'spp')}", f"{value(renderer, 'noise_rmse'):.3g}"])
        renderers += [[name(scene), missing, NONE, NONE] for missing in value(row, "absent")]
        for pair in value(row, "pairs"):
            result = value(pair, "agreement")
            percent = {end: 100 * value(result, f"relative_difference.{end}") for end in ("value", "low", "high")}
            pairs.append([name(scene), value(pair, "image"), value(pair, "against"),
                          f"{percent['value']:+.3f} [{percent['low']:+.3f}, {percent['high']:+.3f}]",
                          f"{value(result, 'rejected')} of {value(result, 'tests')}", f"{value(result, 'largest_z'):.2f}",
                          value(result, "largest_z_at"), value(result, "equivalence")])
        notes += [[name(scene), engine, text] for (where, engine), text in KNOWN.items() if where == scene]
    width, height = run.get("experiment.settings.size")
    tables = (
        Table("Images against each other", ["scene", "image", "against", "difference of the mean, % [99 %]", "block tests that reject",
                                            "largest z", "at", "within 0.1 %"], pairs),
        Table("Where they differ, and why", ["scene", "renderer", "what was found"], notes),
        Table("What there is", ["scene", "renderer", "samples per pixel", f"noise, RMSE at {width} x {height}"], renderers),
    )
    what = (f"References of results/references/ averaged to {width} x {height} pixels, and an image of ours, tested pair by pair: means "
            "of blocks of 16 x 16 pixels and of the image, by channel, Holm's correction at 0.01 within a pair. What the noise of "
            "both images says of a difference is its standard error; for Mitsuba and Cycles that is the scatter of their "
            "batches. A dash: there is none.")
    return what, tables


REFERENCE_TABLES = {"reference_agreement": reference_agreement}
