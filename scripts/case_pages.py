# SPDX-License-Identifier: MIT
"""Pages of the surveys: stiff and extreme cases, stiffness towards zero, and convergence
control."""

import json
import math
import textwrap

import numpy

from cells import NONE, Table, interval, number
from measurement_plots import reach_of
from pages import Figure, Page, TableBlock
from plots import COLOURS, MARKERS, pyplot, series_style
from run_document import RunError, algorithm_name, file_name, value

PASSING = ("ok", "out of reach")


def read(folder, file):
    path = folder / file
    try:
        return json.loads(path.read_text())
    except (OSError, ValueError) as error:
        raise RunError(
            f"{path}: cannot be read: {error}; rtrays-experiment run ... --out {folder} makes it"
        ) from error


def save(figure, folder, stem):
    """Writes STEM.svg; equal input gives equal files (plots.py)."""
    temporary = folder / f"{stem}.tmp.svg"
    figure.savefig(temporary, bbox_inches="tight", metadata={"Date": None})
    pyplot.close(figure)
    temporary.replace(folder / f"{stem}.svg")


def rename_images(folder):
    """Replaces the blanks in the names of a survey's images, which are named after its cases."""
    for path in folder.glob("images/*.exr"):
        path.rename(path.with_name(file_name(path.name)))


def provenance(document):
    changed = " with uncommitted changes" if document.get("dirty") else ""
    profile = f", profile {document['profile']}" if "profile" in document else ""
    return [
        f"commit {value(document, 'commit')[:12]}{changed}{profile}",
        f"device: {value(document, 'device')}",
    ]


def made_by(document):
    return {
        "device": value(document, "device"),
        "commit": value(document, "commit")[:12],
        "finished": document.get("finished_at", ""),
        "profile": document.get("profile", ""),
    }


# --- stiff and extreme cases


def case_row(row):
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
    """How many checks pass, how many fail, and how many are out of an algorithm's reach."""
    passed, unseen = (sum(row["verdict"] == word for row in rows) for word in PASSING)
    failed = len(rows) - passed - unseen
    return (
        f"{len(rows)} checks: {passed} pass, {failed} fail, {unseen} are out of the algorithm's"
        " reach."
    )


def differences_figure(rows):
    """How far the measured mean can be from the expected one, by case."""
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
    figure.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, 0), ncols=6)
    return figure


def stability_page(folder):
    """Writes the plot; returns the page of stability.json, failures first."""
    document = read(folder, "stability.json")
    rename_images(folder)
    rows = sorted(document["rows"], key=lambda row: row["verdict"] in PASSING)
    save(differences_figure(document["rows"]), folder, "differences")
    table = Table(
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
    titles = dict.fromkeys((row["group"], row["title"]) for row in document["rows"])
    groups = Table("Groups of cases", ["group", "case"], [list(entry) for entry in titles])
    caption = (
        "End of the 99 % interval of the relative difference that is farther from zero, by case and"
        " algorithm."
    )
    return Page(
        folder,
        "stability.md",
        "Stiff and extreme cases",
        counts_of(rows),
        [Figure("differences.svg", caption), TableBlock(table), TableBlock(groups)],
        provenance=provenance(document),
        picture="differences.svg",
        picture_label="Relative differences by case",
        made=made_by(document),
    )


# --- stiffness towards zero

MEASURES = (
    ("relative MSE of one batch", lambda row: row["mse"]),
    ("1 / (relative MSE × device seconds)", lambda row: 1 / (row["mse"] * row["seconds"])),
)


def is_known(row):
    """Whether the error is distinguishable from the noise of the expected image."""
    return row["mse"] > row["mse_expected"]


def families(rows):
    """group -> algorithm -> rows by falling stiffness parameter."""
    result = {}
    for row in sorted(rows, key=lambda row: -row["stiffness"]):
        result.setdefault(row["group"], {}).setdefault(row["algorithm"], []).append(row)
    return result


def stiffness_figure(groups):
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
            for index, (algorithm, rows) in enumerate(algorithms.items()):
                x, y = [row["stiffness"] for row in rows], [
                    measure(row) if is_known(row) else math.nan for row in rows
                ]
                found = [b if row["verdict"] != "off" else math.nan for b, row in zip(y, rows)]
                plot.plot(
                    x,
                    found,
                    color=COLOURS[index],
                    linewidth=1.2,
                    label=algorithm_name(algorithm) if line == column == 0 else None,
                )
                for kept, fill in ((True, COLOURS[index]), (False, "white")):
                    some = [
                        (a, b) for a, b, row in zip(x, y, rows) if (row["verdict"] == "ok") == kept
                    ]
                    plot.plot(
                        [a for a, _ in some],
                        [b for _, b in some],
                        MARKERS[index],
                        color=COLOURS[index],
                        markerfacecolor=fill,
                        markersize=5,
                    )
            plot.set(
                xscale="log",
                yscale="log",
                xlabel=f"{group.replace('_', ' ')} (stiffer to the right)",
                ylabel=label,
                title=textwrap.fill(rows[0]["title"], 52) if line == 0 else "",
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
    error = f"{row['mse']:.1e}" if is_known(row) else f"< {row['mse_expected']:.0e}"
    return error + ("" if row["verdict"] == "ok" else f" ({row['verdict']})")


def stiffness_table(group, algorithms, note):
    first = next(iter(algorithms.values()))
    return Table(
        f"{group.replace('_', ' ').capitalize()}: {first[0]['title']}",
        ["algorithm", *(f"{row['stiffness']:g}" for row in first)],
        [
            [algorithm_name(algorithm), *map(stiffness_cell, rows)]
            for algorithm, rows in algorithms.items()
        ],
        [note],
    )


def stiffness_page(folder):
    """Writes stiffness.svg; returns the map of where each algorithm fails."""
    document = read(folder, "stability.json")
    rename_images(folder)
    rows = [row for row in document["rows"] if row.get("stiffness", 0) > 0]
    groups = families(rows)
    save(stiffness_figure(groups), folder, "stiffness")
    spp = document["rows"][0]["spp"]
    note = (
        f"Relative MSE of a batch of {spp / document['batches']:g} samples per pixel against the"
        f" Embree reference; columns: stiffness parameter. After {spp} samples per pixel the image"
        " is off if more is missing than intervals allow (light that cannot be found, or was not"
        " found in so many samples), undecided if batches are too skewed for an interval,"
        " imprecise if the interval of the mean is wider than the case allows. <: less than the"
        " noise of the reference."
    )
    shares = {
        algorithm: [row["verdict"] == "ok" for row in rows if row["algorithm"] == algorithm]
        for algorithm in dict.fromkeys(row["algorithm"] for row in rows)
    }
    best = sorted(shares, key=lambda algorithm: -sum(shares[algorithm]))
    finding = (
        "Cases that each algorithm renders right and precisely: "
        + ", ".join(
            f"{algorithm_name(algorithm)} {sum(shares[algorithm])} of {len(shares[algorithm])}"
            for algorithm in best
        )
        + "."
    )
    tables = [
        TableBlock(stiffness_table(group, algorithms, note if index == 0 else ""))
        for index, (group, algorithms) in enumerate(groups.items())
    ]
    caption = "Relative MSE of a batch and efficiency, by algorithm and stiffness."
    return Page(
        folder,
        "stiffness.md",
        "Algorithms as scenes become stiffer",
        finding,
        [Figure("stiffness.svg", caption), *tables],
        provenance=provenance(document),
        picture="stiffness.svg",
        picture_label="Error and efficiency by stiffness",
        made=made_by(document),
    )


# --- convergence control


def control_name(row):
    return (
        f"{row['scene'].replace('_', ' ')}, {algorithm_name(row['algorithm'])}, error"
        f" {row['error']:g}"
    )


def control_figure(rows):
    """The gain over samples spread evenly, and the device time saved."""
    figure, panels = pyplot.subplots(
        1, 2, figsize=(9, 0.3 * len(rows) + 1.3), sharey=True, layout="constrained"
    )
    lines = range(len(rows))
    for i, (panel, key, label) in enumerate(
        zip(
            panels,
            ("efficiency", "seconds"),
            (
                "rays of even samples for the same error / rays used",
                "device time with control / without",
            ),
        )
    ):
        middle, reach = reach_of([value(row, key) for row in rows])
        panel.errorbar(
            middle,
            lines,
            xerr=reach,
            linestyle="none",
            **series_style(i),
        )
        panel.axvline(1, color="black", linewidth=0.8, linestyle=":")
        panel.set(xlabel=label, xlim=(0, 1.1))
    panels[0].set_yticks(lines, map(control_name, rows))
    panels[0].invert_yaxis()
    return figure


def control_page(folder):
    """Writes the plot; returns the page of convergence_control.json."""
    document = read(folder, "convergence_control.json")
    rows = document["rows"]
    save(control_figure(rows), folder, "gain")
    cells = []
    for row in rows:
        bias = value(row, "bias")
        percent = [
            f"{100 * value(row, key):.1f}" for key in ("live", "paths", "rays", "seconds.value")
        ]
        cells.append(
            [
                row["scene"].replace("_", " "),
                algorithm_name(row["algorithm"]),
                f"{value(row, 'error'):g}",
                interval(value(row, "efficiency"), form="{:.2f}"),
                interval(value(bias, "mean"), 100, "{:+.3f}"),
                *percent,
                number(value(row, "rmse")),
                number(value(row, "rmse_without")),
                f"{value(bias, 'rejected')} of {value(bias, 'tests')}",
                f"{value(bias, 'undecided')}",
            ]
        )
    table = Table(
        "Renders with convergence control against the same renders without it",
        [
            "scene",
            "algorithm",
            "error setting",
            "gain [99 %]",
            "bias of the mean, % [99 %]",
            "pixels live to the end, %",
            "camera paths, %",
            "rays, %",
            "device time, %",
            "RMSE",
            "RMSE without control",
            "blocks that see the bias",
            "blocks too skewed to judge",
        ],
        cells,
        [
            f"{document['size']} x {document['size']} pixels, at most {document['spp']} samples"
            f" each, {document['seeds']} seeds. Paths, rays and device time: with control over"
            " without. Gain: how many times the rays evenly spread samples need for the same RMSE;"
            " below 1 is a loss. A pixel that stops by its own estimate is biased. Blocks are of"
            " 16 x 16 pixels and channel (Holm, 0.01)."
        ],
    )
    saved = [100 * (1 - value(row, "seconds.value")) for row in rows]
    gains = [value(row, "efficiency.value") for row in rows]
    finding = (
        f"Convergence control saves {min(saved):.0f} to {max(saved):.0f} % of the device time, but"
        f" evenly spread samples need only {min(gains):.2f} to {max(gains):.2f} times the rays for"
        " the error that it reaches."
    )
    if max(gains) >= 1:
        finding = (
            f"Convergence control saves {min(saved):.0f} to {max(saved):.0f} % of the device time;"
            f" evenly spread samples need {min(gains):.2f} to {max(gains):.2f} times the rays for"
            " the error that it reaches."
        )
    caption = (
        "Gain over samples spread evenly (99 % intervals), and device time with control over"
        " without; below 1 on the left is a loss."
    )
    return Page(
        folder,
        "convergence_control.md",
        "Convergence control",
        finding,
        [Figure("gain.svg", caption), TableBlock(table)],
        source="section 3.3.7",
        provenance=provenance(document),
        picture="gain.svg",
        picture_label="Gain and device time by case",
        made=made_by(document),
    )
