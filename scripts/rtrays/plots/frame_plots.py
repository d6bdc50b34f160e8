# SPDX-License-Identifier: MIT
"""Plots of the measurements of whole frames."""

import numpy
from matplotlib import pyplot

from rtrays.documents.document import entry_named, value
from rtrays.documents.intervals import named_reach, reach_of
from rtrays.plots.style import COLOURS, legend_below, line_at_one, name_rows, save, series_style
from rtrays.tables.frame_tables import shares, stage_order
from rtrays.tables.text import mesh_name, name


def stage_shares(run):
    """Draws figure 4.21: a bar for each scene, a part for each stage."""
    rows, stages = run.get("rows"), stage_order(run)
    figure, axes = pyplot.subplots(figsize=(8, 0.45 * len(rows) + 1.6), layout="constrained")
    left = numpy.zeros(len(rows))
    for i, stage in enumerate([*stages, None]):
        width = numpy.array([shares(row).get(stage, 0) for row in rows]) if stage else 100 - left
        axes.barh(
            range(len(rows)),
            width,
            left=left,
            color=COLOURS[i % len(COLOURS)],
            label=name(stage or "others"),
            hatch="//" if i >= len(COLOURS) else None,
        )
        left = left + width
    name_rows(axes, [mesh_name(run, row["mesh"]) for row in rows])
    axes.set(xlim=(0, 100), xlabel="share of the device's time in a frame, %")
    legend_below(figure, 4)
    save(figure, run.folder / "stage_shares")
    return {
        "stage_shares": (
            "Share of each stage in a frame of one sample per pixel (thesis figure 4.21)."
        )
    }


def draw_rates(panel, depths):
    """Draws the samples per second of every contestant as groups of bars by bounces."""
    contestants = [value(depth, "contestants") for depth in depths]
    width = 0.8 / len(contestants[0])
    for i, contestant in enumerate(contestants[0]):
        middle, reach = named_reach(contestants, contestant["name"], "Msamples_s")
        panel.bar(
            numpy.arange(len(depths)) + width * (i - (len(contestants[0]) - 1) / 2),
            middle,
            0.93 * width,
            yerr=reach,
            color=COLOURS[i],
            label=contestant["name"],
            error_kw={"linewidth": 0.8},
        )
    panel.set_xticks(range(len(depths)), [f"{value(depth, 'bounces')}" for depth in depths])


def samples_per_second(run):
    """Draws figure 4.22: a panel for each scene."""
    rows = run.get("rows")
    columns = min(3, len(rows))
    lines = -(-len(rows) // columns)
    figure, panels = pyplot.subplots(
        lines,
        columns,
        figsize=(3.4 * columns, 2.6 * lines + 0.6),
        squeeze=False,
        layout="constrained",
    )
    for panel in panels.flat[len(rows) :]:
        panel.remove()
    for panel, row in zip(panels.flat, rows):
        draw_rates(panel, value(row, "depths"))
        panel.set(title=mesh_name(run, row["mesh"]), xlabel="bounces", ylabel="Msamples/s")
    legend_below(figure, 3, panels[0][0])
    save(figure, run.folder / "samples_per_second")
    return {
        "samples_per_second": (
            "Samples per second on the wall by number of bounces, medians with 95 % intervals"
            " (thesis figure 4.22)."
        )
    }


def draw_settings(panel, run, what, names):
    """Draws the speeds of frames or builds: a line for each setting, a marker for each scene."""
    rows = run.get("rows")
    for i, row in enumerate(rows):
        entries = [entry_named(value(row, what), setting) for setting in names]
        middle, reach = reach_of([value(entry, "speed_over_defaults") for entry in entries])
        panel.errorbar(
            middle,
            numpy.arange(len(names)) + 0.12 * (i - (len(rows) - 1) / 2),
            xerr=reach,
            linestyle="none",
            **series_style(i),
            label=mesh_name(run, row["mesh"]),
        )
    line_at_one(panel.axvline)
    panel.set_yticks(range(len(names)), names)
    panel.set(title=what, xlabel="speed over defaults", ylim=(len(names) - 0.5, -0.5))


def speeds_over_defaults(run):
    """Draws frames and builds with one setting changed, a panel each."""
    row = run.get("rows")[0]
    # A setting that only concerns frames has no builds, and the other way round.
    changed = {
        what: [entry["name"] for entry in value(row, what)][1:] for what in ("frames", "builds")
    }
    shown = {what: names for what, names in changed.items() if names}
    if not shown:
        return {}
    lengths = [len(names) for names in shown.values()]
    figure, panels = pyplot.subplots(
        len(shown),
        1,
        figsize=(7, 0.24 * sum(lengths) + 1.1 * len(shown)),
        layout="constrained",
        gridspec_kw={"height_ratios": lengths},
        squeeze=False,
    )
    for panel, (what, names) in zip(panels[:, 0], shown.items()):
        draw_settings(panel, run, what, names)
    legend_below(figure, 2, panels[0][0])
    save(figure, run.folder / "speeds_over_defaults")
    return {
        "speeds_over_defaults": (
            "Speed of frames and of building the hierarchy with one setting changed over that with"
            f" the defaults, by {run.clock} time, medians with 95 % intervals."
        )
    }
