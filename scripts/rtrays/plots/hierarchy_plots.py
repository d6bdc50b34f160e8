# SPDX-License-Identifier: MIT
"""Plots of building the hierarchy, and of rebuilding or refitting it for a moving mesh."""

import numpy
from matplotlib import pyplot

from rtrays.documents.document import value
from rtrays.documents.intervals import named_reach
from rtrays.plots.style import legend_below, legend_below_axes, save, series_style
from rtrays.tables.text import name


def exponent_label(run, contestant):
    """Returns the name of a builder with the exponent of its power law, if it has one."""
    exponent = run.get("summary.exponents").get(contestant)
    if not exponent:
        return name(contestant)
    middle, low, high = (value(exponent, key) for key in ("value", "low", "high"))
    return f"{name(contestant)}, k = {middle:.3f} [{low:.3f}, {high:.3f}]"


def build_time(run):
    """Draws the time of a build over the number of triangles, for all builders."""
    figure, axes = pyplot.subplots(figsize=(6.4, 5.2), layout="constrained")
    rows = sorted(run.get("rows"), key=lambda row: value(row, "triangles"))
    triangles = numpy.array([value(row, "triangles") for row in rows], dtype=float)
    contestants = [value(row, "contestants") for row in rows]
    for i, contestant in enumerate(contestants[0]):
        middle, reach = named_reach(contestants, contestant["name"], f"{run.clock}_ms")
        axes.errorbar(
            triangles,
            middle,
            yerr=reach,
            **series_style(i),
            linestyle="-" if contestant["side"] == "ours" else "--",
            label=exponent_label(run, contestant["name"]),
        )
    axes.set(
        xscale="log",
        yscale="log",
        xlabel="triangles",
        ylabel=f"{run.clock} time of a build, ms (all threads)",
        title="medians with 95 % intervals, time = c · triangles$^k$",
    )
    legend_below_axes(axes, 0.5, -0.12, 2)
    save(figure, run.folder / "build_time")
    return {
        "build_time": (
            f"{run.clock.capitalize()} time of a build against triangles, with the exponents of"
            " power laws and their 95 % intervals over the meshes; dashed: Embree."
        )
    }


def draw_updates(panel, frames, what, key):
    """Draws the figures of "updates" or "rays" by frame; a strategy has one colour in both."""
    strategies = [update["name"] for update in value(frames[0], "updates")]
    for entry in value(frames[0], what):
        middle, reach = named_reach([frame[what] for frame in frames], entry["name"], key)
        panel.errorbar(
            [value(frame, "frame") for frame in frames],
            middle,
            yerr=reach,
            **series_style(strategies.index(entry["name"])),
            label=name(entry["name"]),
        )


def animation(run):
    """Draws the time of an update above, the speed of rays below; a column for each mesh."""
    rows = run.get("rows")
    figure, panels = pyplot.subplots(
        2,
        len(rows),
        figsize=(1.2 + 3.2 * len(rows), 5.2),
        sharex="col",
        squeeze=False,
        layout="constrained",
    )
    for (above, below), row in zip(panels.T, rows):
        draw_updates(above, value(row, "frames"), "updates", f"{run.clock}_ms")
        draw_updates(below, value(row, "frames"), "rays", "speed_over_build")
        above.set(
            title=f"{name(row['mesh'])}, {value(row, 'triangles')} triangles",
            yscale="log",
            ylabel=f"update, {run.clock} ms",
        )
        below.set(xlabel="frame", ylabel="speed of diffuse rays")
    legend_below(figure, 2, panels[0][0])
    save(figure, run.folder / "animation")
    return {
        "animation": (
            f"{run.clock.capitalize()} time of an update by frame, and the rate of diffuse rays"
            " after it over that of a tree rebuilt by the default builder."
        )
    }
