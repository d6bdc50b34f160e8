# SPDX-License-Identifier: MIT
"""Plots of this renderer beside others."""

import numpy
from matplotlib import pyplot

from rtrays.documents.document import value
from rtrays.documents.renderers import error_times_seconds, name_of
from rtrays.plots.style import COLOURS, legend_below, save
from rtrays.tables.text import name


def efficiencies(run):
    """Draws the efficiency of every contestant, relative to the first one, by scene."""
    rows = run.get("rows")
    figure, axes = pyplot.subplots(figsize=(8, 4), layout="constrained")
    names = [name_of(contestant) for contestant in value(rows[0], "contestants")]
    width = 0.8 / len(names)
    for i, contestant in enumerate(names):
        relative = [
            error_times_seconds(run, value(row, "contestants.0"))
            / error_times_seconds(run, value(row, f"contestants.{i}"))
            for row in rows
        ]
        axes.bar(
            numpy.arange(len(rows)) + width * (i - (len(names) - 1) / 2),
            relative,
            0.93 * width,
            color=COLOURS[i % len(COLOURS)],
            label=contestant,
        )
    axes.set_xticks(range(len(rows)), [name(row["scene"]) for row in rows])
    axes.axhline(1, color="0.4", linewidth=0.8)
    axes.set(yscale="log", ylabel=f"efficiency over {names[0]}")
    legend_below(figure, 1, axes)
    save(figure, run.folder / "efficiencies")
    return {"efficiencies": "1 / (MSE x time) of every contestant, relative to the first one."}
