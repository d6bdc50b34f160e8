# SPDX-License-Identifier: MIT
"""Page of the gains of algorithms over many scenes."""

from matplotlib import pyplot

from rtrays.documents.curves import label
from rtrays.documents.document import value
from rtrays.documents.intervals import reach_of
from rtrays.documents.sweep import base_of, gain
from rtrays.pages.sweep_page import page_of_gains
from rtrays.plots.style import legend_below, line_at_one, name_rows, series_style, set_ticks
from rtrays.tables.cells import interval
from rtrays.tables.table import Table


def sorted_rows(run):
    """Returns the rows of a run by the gain of their first curve in equal time, least first."""
    return sorted(
        run.get("rows"), key=lambda row: gain(row, value(row, "curves.0"), "time")["value"]
    )


def gains_figure(run):
    """Draws the gains of all scenes in equal device time."""
    rows = sorted_rows(run)
    figure, axes = pyplot.subplots(figsize=(7.5, 1 + 0.17 * len(rows)), layout="constrained")
    for index, curve in enumerate(value(rows[0], "curves")[:-1]):
        gains = [gain(row, value(row, f"curves.{index}"), "time") for row in rows]
        middle, reach = reach_of(gains)
        style = {**series_style(index), "linestyle": "none"}
        axes.errorbar(middle, range(len(rows)), xerr=reach, label=label(curve), **style)
    line_at_one(axes.axvline)
    name_rows(axes, [value(row, "scene") for row in rows])
    axes.set(xscale="log", xlabel="gain in equal device time, times", ylim=(len(rows) - 0.5, -0.5))
    low, high = axes.get_xlim()
    powers = [2.0**exponent for exponent in range(-20, 21)]
    set_ticks(axes.set_xticks, [power for power in powers if low <= power <= high])
    axes.minorticks_off()
    legend_below(figure, 1)
    return figure


def gains_table(run):
    """Returns the gains of every curve but the last in every scene."""
    cells = []
    for row in sorted_rows(run):
        for curve in value(row, "curves")[:-1]:
            gains = (gain(row, curve, key) for key in ("samples", "rays", "time"))
            cells.append(
                [value(row, "scene"), label(curve)]
                + [interval(each, form="{:.2f}") for each in gains]
            )
    base = label(base_of(value(run.document, "rows.0")))
    return Table(
        f"Gains over {base}, least first",
        ["scene", "curve", "equal samples", "equal numbers of rays", "equal device time"],
        cells,
        ["Every seed has its own pilot. Rays and times include the pilots."],
    )


def gains_finding(run):
    """Returns the sentence that states the least and the largest gain."""
    rows = sorted_rows(run)
    first, *_, base = value(rows[0], "curves")
    gains = [gain(row, value(row, "curves.0"), "time") for row in rows]
    below = sum(each["value"] < 0.9 for each in gains)
    surely = sum(each["high"] < 0.9 for each in gains)

    def text(index):
        return f"{interval(gains[index], form='{:.2f}')} ({value(rows[index], 'scene')})"

    return (
        f"In equal device time, pilots included, {label(first)} has between {text(0)} and"
        f" {text(-1)} times the efficiency of {label(base)}. It is below 0.9 in {below} of"
        f" {len(rows)} scenes, with the whole interval in {surely}."
    )


def scene_gains_page(run):
    """Writes plot and table into the run's folder; returns the page."""
    return page_of_gains(
        run, gains_figure(run), {"gains": gains_table(run)}, gains_finding(run), "Gain by scene"
    )
