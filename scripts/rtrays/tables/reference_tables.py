# SPDX-License-Identifier: MIT
"""Tables of how references by several renderers and our own image agree."""

from rtrays.documents.document import value
from rtrays.documents.undecided import factor_of_agreement, with_advice
from rtrays.tables.cells import NONE, interval
from rtrays.tables.table import Table
from rtrays.tables.text import name


def mean_difference(agreement):
    """Returns the cell of the difference of the means, in percent."""
    return interval(value(agreement, "relative_difference"), 100, "{:+.3f}")


def rejections(agreement):
    """Returns the cells of the block tests that reject."""
    return (
        f"{value(agreement, 'rejected')} of {value(agreement, 'tests')}",
        f"{value(agreement, 'unconfirmed')}",
    )


def probe_rows(row):
    """Yields a row for every renderer of a probe; Embree, with which the others are compared, comes
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


def probes_table(run):
    """Returns the renderers of all probes."""
    return Table(
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
        [cells for row in run.get("rows") if "probe" in row for cells in probe_rows(row)],
        ["All installed renderers render the probes (scenes/probes) again in the profile full."],
    )


def scene_rows(run):
    """Returns the rows of scenes, without those of probes."""
    return [row for row in run.get("rows") if "scene" in row]


def size_text(run):
    """Returns the size of the compared images."""
    width, height = run.get("experiment.settings.size")
    return f"{width} x {height}"


def equivalence(agreement):
    """Returns the verdict on the difference of the means."""
    return with_advice(value(agreement, "equivalence"), lambda: factor_of_agreement(agreement))


def pairs_table(run):
    """Returns all pairs of images with their differences and tests."""
    columns = [
        ("scene", lambda e: name(value(e[0], "scene"))),
        ("image", lambda e: value(e[1], "image")),
        ("against", lambda e: value(e[1], "against")),
        ("difference of the mean, % [99 %]", lambda e: mean_difference(e[2])),
        ("mean within 0.1 %", lambda e: equivalence(e[2])),
        ("block tests that reject", lambda e: rejections(e[2])[0]),
        ("rejected, but not by both halves", lambda e: rejections(e[2])[1]),
        ("largest z", lambda e: f"{value(e[2], 'largest_z'):.2f}"),
        ("at", lambda e: value(e[2], "largest_z_at")),
    ]
    note = (
        f"References of results/references/ averaged to {size_text(run)} pixels, and an image of"
        " ours, tested pair by pair: means of blocks of 16 x 16 pixels and of the image, by"
        " channel, with Holm's correction at 0.01 within a pair. The standard error of a difference"
        " comes from the noise of both images; for Mitsuba and Cycles that is the scatter of their"
        " batches. Every image is the mean of two halves with different seeds. A rejection counts"
        " if both halves alone reject again; its z is then the smaller one of the two. A dash:"
        " missing."
    )
    entries = [
        (row, pair, value(pair, "agreement")) for row in scene_rows(run) for pair in row["pairs"]
    ]
    return Table.of("Images against each other", columns, entries, [note])


def findings_table(run):
    """Returns the differences whose cause is known."""
    rows = [
        [name(value(finding, "scene")), value(finding, "renderer"), value(finding, "what")]
        for finding in run.prose("findings") or []
    ]
    return Table("Explained differences", ["scene", "renderer", "finding"], rows)


def renderers_table(run):
    """Returns the images that are here, and the renderers that are missing."""
    rows = []
    for row in scene_rows(run):
        scene = name(value(row, "scene"))
        for renderer in value(row, "renderers"):
            noise = f"{value(renderer, 'noise_rmse'):.3g}"
            rows.append([scene, value(renderer, "engine"), f"{value(renderer, 'spp')}", noise])
        rows += [[scene, missing, NONE, NONE] for missing in value(row, "absent")]
    heads = ["scene", "renderer", "samples per pixel", f"noise, RMSE at {size_text(run)}"]
    return Table("Images that are here", heads, rows)


def agreement_finding(run):
    """Returns how many pairs of images agree in all blocks, and how many means are equivalent."""
    results = [value(pair, "agreement") for row in scene_rows(run) for pair in value(row, "pairs")]
    agreeing = sum(value(result, "agrees") for result in results)
    equivalent = sum(value(result, "equivalence") == "equivalent" for result in results)
    return (
        f"{agreeing} of {len(results)} pairs of images of {len(scene_rows(run))} scenes agree in"
        f" all blocks, and {equivalent} have means within 0.1 % of each other."
    )


def reference_agreement(run):
    """Returns the finding and the tables of references against each other."""
    makers = (pairs_table, findings_table, probes_table, renderers_table)
    tables = [make(run) for make in makers]
    return agreement_finding(run), [table for table in tables if table.rows]
