# SPDX-License-Identifier: MIT
"""Page of the survey of stiffness: where each algorithm fails."""

import math
import textwrap

from matplotlib import pyplot

from rtrays.documents.curves import algorithm_name
from rtrays.documents.survey import rename_images
from rtrays.pages.page import Figure, Page, TableBlock
from rtrays.pages.provenance import run_made_by, survey_provenance
from rtrays.plots.style import COLOURS, MARKERS, save
from rtrays.tables.table import Table

MEASURES = (
    ("relative MSE of one batch", lambda row: row["mse"]),
    ("1 / (relative MSE × device seconds)", lambda row: 1 / (row["mse"] * row["seconds"])),
)


def is_known(row):
    """Whether the error is distinguishable from the noise of the expected image."""
    return row["mse"] > row["mse_expected"]


def families(rows):
    """Returns {group: {algorithm: rows by falling stiffness parameter}}."""
    result = {}
    for row in sorted(rows, key=lambda row: -row["stiffness"]):
        result.setdefault(row["group"], {}).setdefault(row["algorithm"], []).append(row)
    return result


def title_of(algorithms):
    """Returns the title of a group."""
    return next(iter(algorithms.values()))[0]["title"]


def draw_stiffness(plot, algorithms, measure):
    """Draws a measure over the stiffness of one group; returns the lines by algorithm."""
    lines = {}
    for index, (algorithm, rows) in enumerate(algorithms.items()):
        x = [row["stiffness"] for row in rows]
        y = [measure(row) if is_known(row) else math.nan for row in rows]
        found = [b if row["verdict"] != "off" else math.nan for b, row in zip(y, rows)]
        (lines[algorithm],) = plot.plot(x, found, color=COLOURS[index], linewidth=1.2)
        for kept, fill in ((True, COLOURS[index]), (False, "white")):
            some = [(a, b) for a, b, row in zip(x, y, rows) if (row["verdict"] == "ok") == kept]
            plot.plot(
                [a for a, _ in some],
                [b for _, b in some],
                MARKERS[index],
                color=COLOURS[index],
                markerfacecolor=fill,
                markersize=5,
            )
    return lines


def stiffness_figure(groups):
    """Draws both measures, a column for each group."""
    figure, axes = pyplot.subplots(
        len(MEASURES),
        len(groups),
        figsize=(4.6 * len(groups), 6.4),
        layout="constrained",
        squeeze=False,
    )
    for column, (group, algorithms) in enumerate(groups.items()):
        for line, (label, measure) in enumerate(MEASURES):
            plot = axes[line][column]
            lines = draw_stiffness(plot, algorithms, measure)
            if line == column == 0:
                for algorithm, drawn in lines.items():
                    drawn.set_label(algorithm_name(algorithm))
            plot.set(
                xscale="log",
                yscale="log",
                xlabel=f"{group.replace('_', ' ')} (stiffer to the right)",
                ylabel=label,
                title=textwrap.fill(title_of(algorithms), 52) if line == 0 else "",
            )
            plot.invert_xaxis()
    figure.legend(
        loc="upper center",
        bbox_to_anchor=(0.5, 0),
        ncols=4,
        title="hollow: not ok (see the tables); no line: light is missing",
    )
    return figure


def stiffness_cell(row):
    """Returns the error of a case, and its verdict if it is not ok."""
    error = f"{row['mse']:.1e}" if is_known(row) else f"< {row['mse_expected']:.0e}"
    return error + ("" if row["verdict"] == "ok" else f" ({row['verdict']})")


def stiffness_table(group, algorithms, note):
    """Returns the errors of one group: algorithms by stiffness."""
    first = next(iter(algorithms.values()))
    return Table(
        f"{group.replace('_', ' ').capitalize()}: {title_of(algorithms)}",
        ["algorithm", *(f"{row['stiffness']:g}" for row in first)],
        [
            [algorithm_name(algorithm), *map(stiffness_cell, rows)]
            for algorithm, rows in algorithms.items()
        ],
        [note],
    )


def stiffness_note(run):
    """Returns the note that explains the cells of the tables."""
    spp, batches = run.get("rows")[0]["spp"], run.get("experiment.batches")
    return (
        f"Relative MSE of a batch of {spp / batches:g} samples per pixel against the"
        f" Embree reference; columns: stiffness parameter. After {spp} samples per pixel the image"
        " is off if more is missing than intervals allow (light that cannot be found, or was not"
        " found in so many samples), undecided if batches are too skewed for an interval,"
        " imprecise if the interval of the mean is wider than the case allows. <: less than the"
        " noise of the reference."
    )


def stiffness_finding(rows):
    """Returns how many cases each algorithm renders right and precisely, best first."""
    shares = {
        algorithm: [row["verdict"] == "ok" for row in rows if row["algorithm"] == algorithm]
        for algorithm in dict.fromkeys(row["algorithm"] for row in rows)
    }
    best = sorted(shares, key=lambda algorithm: -sum(shares[algorithm]))
    return (
        "Cases that each algorithm renders right and precisely: "
        + ", ".join(
            f"{algorithm_name(algorithm)} {sum(shares[algorithm])} of {len(shares[algorithm])}"
            for algorithm in best
        )
        + "."
    )


def stiffness_page(run):
    """Writes stiffness.svg; returns the map of where each algorithm fails."""
    rename_images(run.folder)
    rows = [row for row in run.get("rows") if row.get("stiffness", 0) > 0]
    groups = families(rows)
    save(stiffness_figure(groups), run.folder / "stiffness")
    note = stiffness_note(run)
    tables = [
        TableBlock(stiffness_table(group, algorithms, note if index == 0 else ""))
        for index, (group, algorithms) in enumerate(groups.items())
    ]
    caption = "Relative MSE of a batch and efficiency, by algorithm and stiffness."
    return Page(
        run.folder,
        "stiffness.md",
        "Algorithms as scenes become stiffer",
        stiffness_finding(rows),
        [Figure("stiffness.svg", caption), *tables],
        provenance=survey_provenance(run),
        picture="stiffness.svg",
        picture_label="Error and efficiency by stiffness",
        made=run_made_by(run),
    )
