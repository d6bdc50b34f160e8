# SPDX-License-Identifier: MIT
"""Plot of references against each other."""

from matplotlib import pyplot

from rtrays.documents.document import value
from rtrays.documents.intervals import reach_of
from rtrays.plots.style import COLOURS, legend_below_axes, name_rows, save, series_style, set_ticks
from rtrays.tables.reference_tables import scene_rows
from rtrays.tables.text import name


def mean_differences(run):
    """Draws the difference of every mean from Embree's reference, a row for each scene."""
    rows = scene_rows(run)
    figure, axes = pyplot.subplots(figsize=(7, 0.4 * len(rows) + 1.5), layout="constrained")
    found = {}
    for line, row in enumerate(rows):
        for pair in value(row, "pairs"):
            if value(pair, "against") == "embree":
                found.setdefault(value(pair, "image"), []).append(
                    (line, value(pair, "agreement.relative_difference"))
                )
    for i, (image, entries) in enumerate(found.items()):
        middle, reach = reach_of([entry for _, entry in entries])
        axes.errorbar(
            100 * middle,
            [line + 0.2 * (i - (len(found) - 1) / 2) for line, _ in entries],
            xerr=[100 * part for part in reach],
            linestyle="none",
            **series_style(i),
            label=image,
        )
    axes.axvspan(-0.1, 0.1, color=COLOURS[0], alpha=0.08, linewidth=0)
    axes.axvline(0, color="black", linewidth=0.8, linestyle=":")
    axes.set_xscale("symlog", linthresh=0.1)
    set_ticks(axes.set_xticks, [-1, -0.1, 0, 0.1, 1])
    name_rows(axes, [name(row["scene"]) for row in rows])
    axes.set(xlabel="difference of the mean from Embree's reference, % (linear within 0.1 %)")
    legend_below_axes(axes, 0.4, -0.22, 4)
    save(figure, run.folder / "mean_differences")
    return {
        "mean_differences": (
            "Difference of the mean of every image from Embree's reference with 99 % intervals;"
            " shaded: within 0.1 %."
        )
    }
