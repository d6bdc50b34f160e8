# SPDX-License-Identifier: MIT
"""Page of a sweep: gains while the properties of a scene change."""

import math

from matplotlib import pyplot

from rtrays.documents.curves import label
from rtrays.documents.document import value
from rtrays.documents.intervals import reach_of
from rtrays.documents.sweep import (
    base_of,
    delta_pixels,
    gain,
    position,
    share_of_part,
    sweeps,
)
from rtrays.pages.page import Figure, Page, TableBlock
from rtrays.pages.provenance import run_made_by, survey_provenance
from rtrays.plots.style import legend_below, line_at_one, save, series_style, set_ticks
from rtrays.tables.cells import NONE, interval
from rtrays.tables.table import Table

SERIES = {
    "samples": "equal samples",
    "time": "equal device time",
    "rest": "equal samples, pixels without mirrors and glass",
}
COLUMNS = 3


def draw_sweep(axes, sweep, rows):
    """Draws the gains of the first curve of a sweep."""
    rows = sorted(rows, key=lambda row: position(sweep, row))
    for index, (key, words) in enumerate(SERIES.items()):
        gains = [(position(sweep, row), gain(row, value(row, "curves.0"), key)) for row in rows]
        shown = [(x, measured) for x, measured in gains if measured]
        if not shown:
            continue
        middle, reach = reach_of([measured for _, measured in shown])
        axes.errorbar([x for x, _ in shown], middle, yerr=reach, label=words, **series_style(index))
    line_at_one(axes.axhline)
    axes.set(
        xscale="log", yscale="log", xlabel=value(sweep, "axis.label"), title=value(sweep, "title")
    )
    set_ticks(axes.set_xticks, [float(f"{position(sweep, row):.3g}") for row in rows])
    axes.minorticks_off()


def sweep_figure(run):
    """Draws a panel for every sweep."""
    entries = sweeps(run)
    lines = math.ceil(len(entries) / COLUMNS)
    figure, grid = pyplot.subplots(
        lines,
        COLUMNS,
        figsize=(3.4 * COLUMNS, 2.9 * lines),
        layout="constrained",
        squeeze=False,
        sharey=True,
    )
    panels = list(grid.flat)
    for axes, (sweep, rows) in zip(panels, entries):
        draw_sweep(axes, sweep, rows)
    for axes in panels[len(entries) :]:
        axes.set_axis_off()
    low, high = panels[0].get_ylim()
    ticks = [tick for tick in (0.25, 0.5, 1, 2, 4, 8, 16, 32, 64) if low <= tick <= high]
    for line in grid:
        set_ticks(line[0].set_yticks, ticks)
        line[0].set_ylabel("gain")
    legend_below(figure, len(SERIES), panels[0])
    return figure


def sweep_table(run, sweep, rows):
    """Returns the gains of all curves of a sweep but the last, row by row."""
    cells = []
    for row in rows:
        base = base_of(row)
        for curve in value(row, "curves")[:-1]:
            gains = [gain(row, curve, key) for key in SERIES]
            cells.append(
                [f"{value(row, 'value'):g}", label(curve), f"{100 * delta_pixels(row):.2f}"]
                + [f"{100 * value(row, 'pixels.light_behind_delta'):.2f}"]
                + [f"{100 * share_of_part(base, 'light_behind_delta'):.1f}"]
                + [f"{100 * share_of_part(curve, 'light_behind_delta'):.1f}"]
                + [interval(each, form="{:.2f}") if each else NONE for each in gains]
            )
    base = label(base_of(rows[0]))
    return Table(
        value(sweep, "title")[0].upper() + value(sweep, "title")[1:],
        [
            "x",
            "curve",
            "pixels that show mirrors or glass, %",
            "pixels that show lights in them, %",
            f"MSE in the latter, % of that of {base}",
            "MSE in the latter, % of that of the curve",
            *(f"gain in {words}" for words in SERIES.values()),
        ],
        cells,
        [f"Gains are over {base}. Horizontal axis of the plot: {value(sweep, 'axis.label')}."],
    )


def extremes(run, key):
    """Returns the smallest and the largest gain of the first curve over all sweeps as text."""
    found = []
    for sweep, rows in sweeps(run):
        for row in rows:
            measured = gain(row, value(row, "curves.0"), key)
            if measured:
                found.append((measured, value(sweep, "title"), value(row, "value")))

    def text(entry):
        return f"{interval(entry[0], form='{:.2f}')} ({entry[1]}, x = {entry[2]:g})"

    low, high = (pick(found, key=lambda entry: entry[0]["value"]) for pick in (min, max))
    return f"between {text(low)} and {text(high)}"


def sweep_finding(run):
    """Returns the sentences that state the extremes of the gains over all sweeps."""
    first, *_, last = value(run.document, "rows.0.curves")
    return (
        f"In equal device time the gain of {label(first)} over {label(last)} is"
        f" {extremes(run, 'time')}. In pixels without mirrors and glass, in equal samples, it is"
        f" {extremes(run, 'rest')}."
    )


def page_of_gains(run, figure, tables, finding, label_of_picture):
    """Writes plot and tables, by name, into the folder of a run without references; returns its
    page."""
    save(figure, run.folder / "gain", ".svg", ".png")
    size, spp, seeds = (run.get(f"experiment.{key}") for key in ("size", "spp", "seeds"))
    caption = (
        f"Gains with 95 % intervals over {seeds} seeds of {spp} samples per pixel at"
        f" {size[0]} x {size[1]}; below 1 is a loss. There is no reference: the error is the"
        " variance over the seeds, since all curves are unbiased."
    )
    blocks = [Figure("gain.svg", caption, png=True)]
    for name, table in tables.items():
        table.write(run.folder / "tables", name)
        blocks.append(TableBlock(table, f"tables/{name}"))
    return Page(
        run.folder,
        f"{run.get('experiment.name')}.md",
        run.prose("title"),
        finding,
        blocks,
        source=run.source,
        claim=run.prose("claim"),
        claim_head="The thesis claims" if run.source else "Claim",
        provenance=survey_provenance(run),
        picture="gain.svg",
        picture_label=label_of_picture,
        made=run_made_by(run),
    )


def sweep_page(run):
    """Writes plot and tables into the run's folder; returns the page."""
    return page_of_gains(
        run,
        sweep_figure(run),
        {sweep["name"]: sweep_table(run, sweep, rows) for sweep, rows in sweeps(run)},
        sweep_finding(run),
        "Gain by size of lamps and share of mirrors",
    )
