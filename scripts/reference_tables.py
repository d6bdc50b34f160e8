# SPDX-License-Identifier: MIT
"""The table of how references by several renderers agree, and our own image with them."""

from measurement_tables import NONE, name
from run_document import value
from tables import Table


def mean_difference(agreement):
    percent = {end: 100 * value(agreement, f"relative_difference.{end}") for end in ("value", "low", "high")}
    return f"{percent['value']:+.3f} [{percent['low']:+.3f}, {percent['high']:+.3f}]"


def rejections(agreement):
    return f"{value(agreement, 'rejected')} of {value(agreement, 'tests')}", f"{value(agreement, 'unconfirmed')}"


def probe_rows(row):
    """A row for every renderer of a probe, Embree's first, which the others are set against."""
    against = {value(pair, "image"): value(pair, "agreement") for pair in value(row, "pairs") if value(pair, "against") == "embree"}
    for renderer in value(row, "renderers"):
        result = against.get(value(renderer, "name"))
        yield [name(value(row, "probe")), value(renderer, "engine"), f"{value(renderer, 'spp')}",
               f"{value(renderer, 'mean'):.5f} ± {value(renderer, 'standard_error'):.5f}",
               mean_difference(result) if result else NONE,
               *(rejections(result) if result else [NONE] * 2)]
    for missing in value(row, "absent"):
        yield [name(value(row, "probe")), missing, *[NONE] * 5]


def reference_agreement(run):
    renderers, pairs, probes = [], [], []
    for row in run.get("rows"):
        if "probe" in row:
            probes += probe_rows(row)
            continue
        scene = value(row, "scene")
        for renderer in value(row, "renderers"):
            renderers.append([name(scene), value(renderer, "engine"), f"{value(renderer, 'spp')}", f"{value(renderer, 'noise_rmse'):.3g}"])
        renderers += [[name(scene), missing, NONE, NONE] for missing in value(row, "absent")]
        for pair in value(row, "pairs"):
            result = value(pair, "agreement")
            pairs.append([name(scene), value(pair, "image"), value(pair, "against"), mean_difference(result),
                          *rejections(result), f"{value(result, 'largest_z'):.2f}",
                          value(result, "largest_z_at"), value(result, "equivalence")])
    findings = [[name(value(finding, "scene")), value(finding, "renderer"), value(finding, "what")]
                for finding in run.get("experiment").get("findings", [])]
    width, height = run.get("experiment.settings.size")
    tables = [
        Table("Images against each other", ["scene", "image", "against", "difference of the mean, % [99 %]", "block tests that reject",
                                            "not by both halves", "largest z", "at", "within 0.1 %"], pairs),
        Table("Where they differ, and why", ["scene", "renderer", "what was found"], findings),
        Table("What there is", ["scene", "renderer", "samples per pixel", f"noise, RMSE at {width} x {height}"], renderers),
    ]
    if probes:
        tables.insert(2, Table("Probes", ["probe", "renderer", "samples per pixel", "mean ± standard error",
                                          "difference from embree, % [99 %]", "block tests that reject", "not by both halves"], probes))
    what = (f"References of results/references/ averaged to {width} x {height} pixels, and an image of ours, tested pair by pair: means "
            "of blocks of 16 x 16 pixels and of the image, by channel, Holm's correction at 0.01 within a pair. What the noise of "
            "both images says of a difference is its standard error; for Mitsuba and Cycles that is the scatter of their "
            "batches. Every image is the mean of two halves with other seeds; what rejects counts where both halves alone "
            "reject it again, and its z is then the smaller one of theirs. Probes (scenes/probes) are rendered anew by all that are installed, in the profile full. A dash: there is none.")
    return what, tables


REFERENCE_TABLES = {"reference_agreement": reference_agreement}
