# SPDX-License-Identifier: MIT
"""Page of the survey of stiff and extreme cases."""

import numpy
from matplotlib import pyplot

from rtrays.documents.curves import algorithm_name
from rtrays.documents.survey import rename_images
from rtrays.pages.page import Figure, Page, TableBlock
from rtrays.pages.provenance import run_made_by, survey_provenance
from rtrays.plots.style import COLOURS, MARKERS, legend_below, save
from rtrays.tables.cells import NONE, interval, number
from rtrays.tables.table import Table

PASSING = ("ok", "out of reach")


def case_row(row):
    """Returns the cells of a checked case."""
    measured = (
        [
            row["against"],
            number(row["expected"], 6),
            number(row["measured"], 6),
            interval(row["difference"], form="{:+.1e}"),
        ]
        if "difference" in row
        else [NONE] * 4
    )
    counts = [str(row.get(key, NONE)) for key in ("non_finite", "saturated")]
    return [
        row["case"],
        algorithm_name(row["algorithm"]),
        row["verdict"],
        *measured,
        *counts,
        row.get("reason", ""),
    ]


def counts_of(rows):
    """Returns how many checks pass, how many fail, and how many are out of an algorithm's reach."""
    passed, unseen = (sum(row["verdict"] == word for row in rows) for word in PASSING)
    failed = len(rows) - passed - unseen
    return (
        f"{len(rows)} checks: {passed} pass, {failed} fail, {unseen} are out of the algorithm's"
        " reach."
    )


def differences_figure(rows):
    """Draws how far the measured mean can be from the expected one, by case."""
    cases = list(dict.fromkeys(row["case"] for row in rows))
    figure, axes = pyplot.subplots(figsize=(8, 3.6), layout="constrained")
    algorithms = list(dict.fromkeys(row["algorithm"] for row in rows if "difference" in row))
    for i, algorithm in enumerate(algorithms):
        own = [row for row in rows if row["algorithm"] == algorithm and "difference" in row]
        reach = [max(abs(row["difference"][end]) for end in ("low", "high")) for row in own]
        axes.plot(
            [cases.index(row["case"]) for row in own],
            numpy.maximum(reach, 1e-9),
            MARKERS[i % len(MARKERS)],
            color=COLOURS[i % len(COLOURS)],
            markersize=3,
            linestyle="none",
            label=algorithm_name(algorithm),
        )
    axes.set(
        yscale="log",
        xlabel="case, in the order of the table",
        ylabel="relative difference, end of interval",
    )
    legend_below(figure, 6)
    return figure


def cases_table(rows):
    """Returns the table of all checks, failures first."""
    rows = sorted(rows, key=lambda row: row["verdict"] in PASSING)
    return Table(
        "Every case by every algorithm",
        [
            "case",
            "algorithm",
            "verdict",
            "against",
            "expected mean",
            "measured mean",
            "relative difference [99 %]",
            "values not finite",
            "values saturated",
            "remark",
        ],
        list(map(case_row, rows)),
        [
            "Means are of radiance over pixels and channels. Verdicts: off: a block of 8 x 8 pixels"
            " or the whole image differs in a channel from the expected value by more than the"
            " bound, at a level of 0.01 over all tests; imprecise: the interval is wider than the"
            " case allows; undecided: the batches are too skewed for a t test."
        ],
    )


def stability_page(run):
    """Writes the plot; returns the page of the run."""
    rename_images(run.folder)
    rows = run.get("rows")
    save(differences_figure(rows), run.folder / "differences")
    titles = dict.fromkeys((row["group"], row["title"]) for row in rows)
    groups = Table("Groups of cases", ["group", "case"], [list(entry) for entry in titles])
    caption = (
        "End of the 99 % interval of the relative difference that is farther from zero, by case and"
        " algorithm."
    )
    return Page(
        run.folder,
        "stability.md",
        "Stiff and extreme cases",
        counts_of(rows),
        [Figure("differences.svg", caption), TableBlock(cases_table(rows)), TableBlock(groups)],
        provenance=survey_provenance(run),
        picture="differences.svg",
        picture_label="Relative differences by case",
        made=run_made_by(run),
    )
