# SPDX-License-Identifier: MIT
"""Plots of rays: speeds over Embree, and hits that differ from Embree's."""

from matplotlib import pyplot

from rtrays.documents.document import entry_named, value
from rtrays.documents.intervals import named_reach
from rtrays.documents.measurements import KINDS
from rtrays.plots.style import (
    COLOURS,
    MARKERS,
    legend_below,
    legend_below_axes,
    line_at_one,
    name_rows,
    save,
    series_style,
    set_ticks,
)
from rtrays.tables.text import name


def draw_speeds(panel, run, kind):
    """Draws the speeds over Embree of one kind of ray."""
    groups = [entry_named(value(row, "kinds"), kind, "kind") for row in run.get("rows")]
    contestants = [value(group, "contestants") for group in groups]
    for i, contestant in enumerate(contestants[0]):
        speed = value(contestant, "speed_over_embree")
        if value(speed, "low") == value(speed, "high"):
            continue  # Embree ray by ray, the denominator of all speeds
        middle, reach = named_reach(contestants, contestant["name"], "speed_over_embree")
        is_ours = contestant["side"] == "ours"
        panel.errorbar(
            middle,
            range(len(groups)),
            xerr=reach,
            linestyle="none",
            **series_style(i),
            label=name(contestant["name"]) if is_ours else "Embree, 16 rays at a time",
        )
    line_at_one(panel.axvline)
    panel.set(title=name(kind), xscale="log", xlabel="speed over Embree ray by ray")
    if run.clock == "processor":
        set_ticks(panel.set_xticks, [0.2, 0.5, 1, 2, 5])
        panel.minorticks_off()


def speeds(run):
    """Draws speeds over Embree: a panel for each kind of ray, a row for each mesh."""
    rows = run.get("rows")
    figure, panels = pyplot.subplots(
        1, len(KINDS), figsize=(11, 0.26 * len(rows) + 1.8), sharey=True, layout="constrained"
    )
    for panel, kind in zip(panels, KINDS):
        draw_speeds(panel, run, kind)
    name_rows(panels[0], [name(row["mesh"]) for row in rows])
    legend_below(figure, len(panels[0].get_legend_handles_labels()[1]), panels[0])
    save(figure, run.folder / "speeds")
    return {
        "speeds": (
            f"Rays per {run.clock} second over Embree ray by ray (1), by mesh and kind of ray,"
            " medians with 95 % intervals."
        )
    }


def hits(run):
    """Draws the share of fuzzed rays whose hit differs from Embree's, by mesh; the layout with the
    most differences counts."""
    rows = [row for row in run.get("rows") if row["check"] == "hits"]
    figure, axes = pyplot.subplots(figsize=(7.5, 0.24 * len(rows) + 1.6), layout="constrained")
    for i, kind in enumerate(("random", "grazing", "tied", "wrong")):
        shares = [
            max(value(layout, kind) for layout in row["layouts"]) / value(row, "rays")
            for row in rows
        ]
        axes.plot(
            shares,
            range(len(rows)),
            linestyle="none",
            marker=MARKERS[i],
            color=COLOURS[i],
            markersize=5,
            label=kind,
            markerfacecolor="none" if kind == "wrong" else COLOURS[i],
        )
    axes.set_xscale("symlog", linthresh=1e-7)
    set_ticks(axes.set_xticks, [0, 1e-6, 1e-4, 1e-2, 1])
    axes.minorticks_off()
    axes.set(xlim=(-2e-8, 1), xlabel="share of the rays (linear below 1e-7)")
    axes.axvline(1e-6, color="black", linewidth=0.8, linestyle=":")
    name_rows(axes, [name(row["mesh"]) for row in rows])
    legend_below_axes(axes, 0.4, -0.14, 4)
    save(figure, run.folder / "hits")
    return {
        "hits": (
            "Share of fuzzed rays whose hit differs from Embree's, by the kind of ray, and share of"
            " wrong hits by brute force in double precision; dotted: the limit of wrong hits."
        )
    }
