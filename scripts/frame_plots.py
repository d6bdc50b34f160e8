# SPDX-License-Identifier: MIT
"""Plots of the measurements of whole frames."""

import numpy
from matplotlib import pyplot

from frame_tables import shares, stage_order
from measurement_plots import reach_of, save
from measurement_text import mesh_name, name
from plots import COLOURS, series_style
from run_document import value


def stage_shares(run):
    """Figure 4.21: a bar for each scene."""
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
    axes.set_yticks(range(len(rows)), [mesh_name(run, row["mesh"]) for row in rows])
    axes.invert_yaxis()
    axes.set(xlim=(0, 100), xlabel="share of the device's time in a frame, %")
    figure.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, 0), ncols=4)
    save(figure, run, "stage_shares")
    return {
        "stage_shares": (
            "Share of each stage in a frame of one sample per pixel (thesis figure 4.21)."
        )
    }


def samples_per_second(run):
    """Figure 4.22: a panel for each scene, groups of bars by bounces."""
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
        depths = value(row, "depths")
        names = [c["name"] for c in value(depths[0], "contestants")]
        for i, contestant in enumerate(names):
            rates = [
                next(c for c in value(depth, "contestants") if c["name"] == contestant)[
                    "Msamples_s"
                ]
                for depth in depths
            ]
            middle, reach = reach_of(rates)
            width = 0.8 / len(names)
            panel.bar(
                numpy.arange(len(depths)) + width * (i - (len(names) - 1) / 2),
                middle,
                0.93 * width,
                yerr=reach,
                color=COLOURS[i],
                label=contestant,
                error_kw={"linewidth": 0.8},
            )
        panel.set_xticks(range(len(depths)), [f"{value(depth, 'bounces')}" for depth in depths])
        panel.set(title=mesh_name(run, row["mesh"]), xlabel="bounces", ylabel="Msamples/s")
    handles, labels = panels[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, fontsize=8, loc="upper center", bbox_to_anchor=(0.5, 0), ncols=3)
    save(figure, run, "samples_per_second")
    return {
        "samples_per_second": (
            "Samples per second on the wall by number of bounces, medians with 95 % intervals"
            " (thesis figure 4.22)."
        )
    }


def speeds_over_defaults(run):
    """Frames and builds: a line for each setting, a marker for each scene."""
    rows = run.get("rows")
    # A setting that only concerns frames has no builds, and the other way round.
    names_of = {
        what: [entry["name"] for entry in value(rows[0], what)][1:] for what in ("frames", "builds")
    }
    shown = {what: names for what, names in names_of.items() if names}
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
    panels = panels[:, 0]
    for panel, (what, names) in zip(panels, shown.items()):
        for i, row in enumerate(rows):
            middle, reach = reach_of(
                [
                    next(e for e in value(row, what) if e["name"] == setting)["speed_over_defaults"]
                    for setting in names
                ]
            )
            panel.errorbar(
                middle,
                numpy.arange(len(names)) + 0.12 * (i - (len(rows) - 1) / 2),
                xerr=reach,
                linestyle="none",
                **series_style(i),
                label=mesh_name(run, row["mesh"]),
            )
        panel.axvline(1, color="black", linewidth=0.8, linestyle=":")
        panel.set_yticks(range(len(names)), names)
        panel.set(title=what, xlabel="speed over defaults", ylim=(len(names) - 0.5, -0.5))
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, fontsize=8, loc="upper center", bbox_to_anchor=(0.5, 0), ncols=2)
    save(figure, run, "speeds_over_defaults")
    return {
        "speeds_over_defaults": (
            "Speed of frames and of building the hierarchy with one setting changed over that with"
            f" the defaults, by {run.clock} time, medians with 95 % intervals."
        )
    }


FRAME_PLOTS = {
    "ablations": speeds_over_defaults,
    "bounces": samples_per_second,
    "frame_times": stage_shares,
}
