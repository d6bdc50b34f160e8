# SPDX-License-Identifier: MIT
"""Tables of how references by several renderers and our own image agree."""

from cells import NONE, Table, interval
from measurement_text import name
from run_document import value
from undecided import factor_of_agreement, with_advice


def mean_difference(agreement):
    return interval(value(agreement, "relative_difference"), 100, "{:+.3f}")


def rejections(agreement):
    return (
        f"{value(agreement, 'rejected')} of {value(agreement, 'tests')}",
        f"{value(agreement, 'unconfirmed')}",
    )


def probe_rows(row):
    """A row for every renderer of a probe; Embree, with which the others are compared, comes
    first."""
    against = {
        value(pair, "image"): value(pair, "agreement")
        for pair in value(row, "pairs")
        if value(pair, "against") == "embree"
    }
    for renderer in value(row, "renderers"):
        result = against.get(value(renderer, "name"))
        yield [
            name(value(row, "probe")),
            value(renderer, "engine"),
            f"{value(renderer, 'spp')}",
            f"{value(renderer, 'mean'):.5f} ± {value(renderer, 'standard_error'):.5f}",
            mean_difference(result) if result else NONE,
            *(rejections(result) if result else [NONE] * 2),
        ]
    for missing in value(row, "absent"):
        yield [name(value(row, "probe")), missing, *[NONE] * 5]


def scene_rows(run):
    return [row for row in run.get("rows") if "scene" in row]


def reference_agreement(run):
    renderers, pairs, probes = [], [], []
    for row in run.get("rows"):
        if "probe" in row:
            probes += probe_rows(row)
            continue
        scene = value(row, "scene")
        for renderer in value(row, "renderers"):
            renderers.append(
                [
                    name(scene),
                    value(renderer, "engine"),
                    f"{value(renderer, 'spp')}",
                    f"{value(renderer, 'noise_rmse'):.3g}",
                ]
            )
        renderers += [[name(scene), missing, NONE, NONE] for missing in value(row, "absent")]
        for pair in value(row, "pairs"):
            result = value(pair, "agreement")
            pairs.append(
                [
                    name(scene),
                    value(pair, "image"),
                    value(pair, "against"),
                    mean_difference(result),
                    with_advice(
                        value(result, "equivalence"), lambda r=result: factor_of_agreement(r)
                    ),
                    *rejections(result),
                    f"{value(result, 'largest_z'):.2f}",
                    value(result, "largest_z_at"),
                ]
            )
    findings = [
        [name(value(finding, "scene")), value(finding, "renderer"), value(finding, "what")]
        for finding in run.prose("findings") or []
    ]
    width, height = run.get("experiment.settings.size")
    tables = [
        Table(
            "Images against each other",
            [
                "scene",
                "image",
                "against",
                "difference of the mean, % [99 %]",
                "mean within 0.1 %",
                "block tests that reject",
                "rejected, but not by both halves",
                "largest z",
                "at",
            ],
            pairs,
            [
                f"References of results/references/ averaged to {width} x {height} pixels, and an"
                " image of ours, tested pair by pair: means of blocks of 16 x 16 pixels and of the"
                " image, by channel, with Holm's correction at 0.01 within a pair. The standard"
                " error of a difference comes from the noise of both images; for Mitsuba and"
                " Cycles that is the scatter of their batches. Every image is the mean of two"
                " halves with different seeds. A rejection counts if both halves alone reject"
                " again; its z is then the smaller one of the two. A dash: missing."
            ],
        ),
        Table("Explained differences", ["scene", "renderer", "finding"], findings),
        Table(
            "Images that are here",
            ["scene", "renderer", "samples per pixel", f"noise, RMSE at {width} x {height}"],
            renderers,
        ),
    ]
    if probes:
        tables.insert(
            2,
            Table(
                "Probes: small scenes that show the cause of a difference",
                [
                    "probe",
                    "renderer",
                    "samples per pixel",
                    "mean ± standard error",
                    "difference from Embree, % [99 %]",
                    "block tests that reject",
                    "rejected, but not by both halves",
                ],
                probes,
                [
                    "All installed renderers render the probes (scenes/probes) again in the profile"
                    " full."
                ],
            ),
        )
    return agreement_finding(run), [table for table in tables if table.rows]


def agreement_finding(run):
    """How many pairs of images agree in all blocks, and how many means are within the limit."""
    results = [value(pair, "agreement") for row in scene_rows(run) for pair in value(row, "pairs")]
    agreeing = sum(value(result, "agrees") for result in results)
    equivalent = sum(value(result, "equivalence") == "equivalent" for result in results)
    return (
        f"{agreeing} of {len(results)} pairs of images of {len(scene_rows(run))} scenes agree in"
        f" all blocks, and {equivalent} have means within 0.1 % of each other."
    )


REFERENCE_TABLES = {"reference_agreement": reference_agreement}
