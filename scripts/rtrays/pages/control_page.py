# SPDX-License-Identifier: MIT
"""Page of the survey of convergence control."""

from matplotlib import pyplot

from rtrays.documents.curves import algorithm_name
from rtrays.documents.document import value
from rtrays.documents.intervals import reach_of
from rtrays.pages.page import Figure, Page, TableBlock
from rtrays.pages.provenance import run_made_by, survey_provenance
from rtrays.plots.style import line_at_one, name_rows, save, series_style
from rtrays.tables.cells import interval, number
from rtrays.tables.table import Table
from rtrays.tables.text import name


def control_name(row):
    """Returns the name of a row in the plot."""
    return f"{name(row['scene'])}, {algorithm_name(row['algorithm'])}, error {row['error']:g}"


def control_figure(rows):
    """Draws the gain over samples spread evenly, and the device time saved."""
    figure, panels = pyplot.subplots(
        1, 2, figsize=(9, 0.3 * len(rows) + 1.3), sharey=True, layout="constrained"
    )
    shown = (
        ("efficiency", "rays of even samples for the same error / rays used"),
        ("seconds", "device time with control / without"),
    )
    for i, (panel, (key, label)) in enumerate(zip(panels, shown)):
        middle, reach = reach_of([value(row, key) for row in rows])
        panel.errorbar(middle, range(len(rows)), xerr=reach, linestyle="none", **series_style(i))
        line_at_one(panel.axvline)
        panel.set(xlabel=label, xlim=(0, 1.1))
    name_rows(panels[0], list(map(control_name, rows)))
    return figure


def control_table(run):
    """Returns the table of renders with convergence control against those without it."""
    size, spp, seeds = (run.get(f"experiment.{key}") for key in ("size", "spp", "seeds"))
    cells = []
    for row in run.get("rows"):
        bias = value(row, "bias")
        percent = [
            f"{100 * value(row, key):.1f}" for key in ("live", "paths", "rays", "seconds.value")
        ]
        cells.append(
            [
                name(row["scene"]),
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
    return Table(
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
            f"{size} x {size} pixels, at most {spp} samples"
            f" each, {seeds} seeds. Paths, rays and device time: with control over"
            " without. Gain: how many times the rays evenly spread samples need for the same RMSE;"
            " below 1 is a loss. A pixel that stops by its own estimate is biased. Blocks are of"
            " 16 x 16 pixels and channel (Holm, 0.01)."
        ],
    )


def control_finding(rows):
    """Returns the sentence that states savings and gains."""
    saved = [100 * (1 - value(row, "seconds.value")) for row in rows]
    gains = [value(row, "efficiency.value") for row in rows]
    but, only = ("; ", "") if max(gains) >= 1 else (", but ", "only ")
    return (
        f"Convergence control saves {min(saved):.0f} to {max(saved):.0f} % of the device"
        f" time{but}evenly spread samples need {only}{min(gains):.2f} to {max(gains):.2f} times the"
        " rays for the error that it reaches."
    )


def control_page(run):
    """Writes the plot; returns the page of the run."""
    save(control_figure(run.get("rows")), run.folder / "gain")
    caption = (
        "Gain over samples spread evenly (99 % intervals), and device time with control over"
        " without; below 1 on the left is a loss."
    )
    return Page(
        run.folder,
        "convergence_control.md",
        "Convergence control",
        control_finding(run.get("rows")),
        [Figure("gain.svg", caption), TableBlock(control_table(run))],
        source="section 3.3.7",
        provenance=survey_provenance(run),
        picture="gain.svg",
        picture_label="Gain and device time by case",
        made=run_made_by(run),
    )
