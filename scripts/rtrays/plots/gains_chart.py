# SPDX-License-Identifier: MIT
"""Chart of the gains of truncated BDPT over path tracing."""

import numpy
from matplotlib import pyplot

from rtrays.documents.document import value
from rtrays.documents.gains import KEYS, expected_gains, gain_entries
from rtrays.documents.intervals import reach_of
from rtrays.plots.chart import Chart
from rtrays.plots.style import COLOURS, MARKERS, legend_below, save, set_ticks
from rtrays.tables.text import name, span


def draw_gains(axes, entries, key, words, index):
    """Draws the thesis' gains as bars and ours as markers, by time or by samples."""
    lines = numpy.arange(len(entries)) + 0.16 * (2 * index - 1)
    middle, reach = reach_of([ours[key] for _, _, ours in entries])
    ranges = [thesis[key] for _, thesis, _ in entries]
    axes.hlines(
        lines,
        [low / 1.02 for low, _ in ranges],
        [high * 1.02 for _, high in ranges],
        color=COLOURS[index],
        alpha=0.35,
        linewidth=7,
        label=f"thesis, {words}",
    )
    axes.errorbar(
        middle,
        lines,
        xerr=reach,
        linestyle="none",
        marker=MARKERS[index],
        color=COLOURS[index],
        markersize=5,
        linewidth=1.4,
        capsize=3,
        label=f"measured, {words}",
    )


def limits_of(entries):
    """Returns the limits of the axis of gains."""
    ends = [
        end
        for _, thesis, ours in entries
        for key in KEYS
        for end in (*thesis[key], value(ours[key], "low"), value(ours[key], "high"), 1)
    ]
    return min(ends) / 1.15, max(ends) * 1.15


def gains_figure(entries):
    """Draws the gains of all scenes, a line each."""
    figure, axes = pyplot.subplots(figsize=(8, 0.62 * len(entries) + 1.5), layout="constrained")
    draw_gains(axes, entries, "time", "equal device time", 0)
    draw_gains(axes, entries, "samples", "equal samples", 1)
    axes.axvline(1, color="black", linewidth=0.9, linestyle=":")
    low, high = limits_of(entries)
    ticks = [tick for tick in (0.25, 0.5, 1, 2, 3, 4, 6, 8, 12, 16) if low <= tick <= high]
    axes.set_xscale("log")
    set_ticks(axes.set_xticks, ticks)
    axes.minorticks_off()
    axes.set_yticks(numpy.arange(len(entries)), [name(run) for run, _, _ in entries])
    axes.set(
        xlabel="gain of truncated BDPT over path tracing (MIS), times",
        xlim=(low, high),
        ylim=(len(entries) - 0.5, -0.5),
    )
    legend_below(figure, 4)
    return figure


def gains_chart(folder):
    """Writes the chart of gains; returns it."""
    entries = gain_entries(folder)
    if not entries:
        runs = ", ".join(expected_gains())
        missing = f"The gains of truncated BDPT need one of these runs: {runs}."
        return Chart("gains", "", missing=missing)
    save(gains_figure(entries), folder / "gains", ".svg", ".png")
    gaining = [ours["time"] for _, _, ours in entries if value(ours["time"], "low") > 1]
    reached = sum(value(ours["time"], "high") >= thesis["time"][0] for _, thesis, ours in entries)
    measured = [value(ours["time"], "value") for _, _, ours in entries]
    finding = (
        f"In equal device time truncated BDPT has {span(measured)} times the efficiency of path"
        f" tracing (MIS): a gain in {len(gaining)} of {len(entries)} scenes, as large as the thesis"
        f" claims in {reached or 'none'}."
    )
    return Chart("gains", finding, "Markers: measured, with 95 % intervals; bars: the thesis.")
