# SPDX-License-Identifier: MIT
"""Plots of the curves of a run: error over samples and over time (figure 4.3)."""

import numpy
from matplotlib import pyplot

from rtrays.documents.curves import clock_of, label, left_out, seconds, usable_points
from rtrays.documents.document import value
from rtrays.plots.error_plots import write_error_plots
from rtrays.plots.image_plots import write_pictures
from rtrays.plots.style import colour_and_marker, legend_below_axes, save

AXES = {
    "spp": "samples per pixel",
    "seconds_device": "device time, s (pilot included; without compilation and BVH construction)",
    "seconds_wall": "wall time, s (pilot included; without compilation and BVH construction)",
}


def band(curve_points, key):
    """Returns the central 95 % of the seeds at each point: (low, high)."""
    samples = [
        [value(repetition, key) for repetition in value(point, "repetitions")]
        for point in curve_points
    ]
    return numpy.quantile(numpy.array(samples), [0.025, 0.975], axis=1)


def draw_guide(axes, x, y):
    """Draws a line of slope -1/2 over the range of x, from y at its left end."""
    ends = numpy.array([min(x), max(x)], dtype=float)
    axes.plot(
        ends,
        y * (ends / ends[0]) ** -0.5,
        color="black",
        linewidth=0.8,
        linestyle=":",
        label="slope $-1/2$",
    )


# Curves this close to an earlier one at every point cover it.
COINCIDENT = 0.08
DASHES = ((0, (2.5, 2.5)), (2.5, (1, 4)))


def x_of(curve, point, key):
    """Returns the samples of a point, or its seconds with the pilot."""
    if key == "spp":
        return value(point, "spp")
    return seconds(curve, point, key.removeprefix("seconds_"))


def covers(over, under):
    """Whether a curve lies on another one, point by point, where both have samples; curves are (x,
    y), log-log."""
    inside = (over[0] >= under[0][0] / 1.001) & (over[0] <= under[0][-1] * 1.001)
    expected = numpy.exp(numpy.interp(numpy.log(over[0][inside]), *map(numpy.log, under)))
    return inside.sum() > 1 and bool((abs(over[1][inside] / expected - 1) < COINCIDENT).all())


def draw_curve(axes, curve, index, line, below):
    """Draws one curve; `line` is (x, y). A curve that covers earlier ones, `below`, is thinner and
    dashed, so that each can be seen, and the legend says so."""
    style, covered = colour_and_marker(index), min(len(below), len(DASHES))
    on = f"\n(on {label(below[-1])})" if below else ""
    spread = band(usable_points(curve), "rmse")
    axes.fill_between(line[0], *spread, color=style["color"], alpha=0.2, linewidth=0)
    axes.plot(
        *line,
        **style,
        markersize=6 - 1.5 * covered,
        linewidth=2 - 0.4 * covered,
        linestyle=DASHES[covered - 1] if below else "-",
        label=f"{label(curve)}, slope {value(curve, 'slope.value'):.3f}{on}",
        markerfacecolor="white" if below else style["color"],
    )


# Longest line of a legend in two columns, in characters.
HALF_A_LINE = 60


def add_legend(figure, axes):
    """Adds the legend below the axes: in two columns, or in one if names are long. The figure then
    becomes higher, so that the axes keep their size."""
    names = axes.get_legend_handles_labels()[1]
    lines = [line for name in names for line in name.splitlines()]
    columns = 2 if max(map(len, lines)) <= HALF_A_LINE else 1
    if columns == 1:
        figure.set_size_inches(6.4, 4.2 + 0.16 * len(lines))
    legend_below_axes(axes, 0.5, -0.12, columns)


def curves_figure(run, x_key):
    """Draws RMSE against `x_key`, log-log. Curves stop where the reference's noise passes 10 % of
    their MSE."""
    figure, axes = pyplot.subplots(figsize=(6.4, 5.2), layout="constrained")
    floor = run.get("reference.noise_floor.rmse")
    drawn = []
    for index, curve in enumerate(run.curves):
        points = usable_points(curve)
        x = numpy.array([x_of(curve, point, x_key) for point in points], dtype=float)
        line = x, numpy.array([value(point, "rmse") for point in points])
        below = [earlier for earlier, other in drawn if covers(line, other)]
        draw_curve(axes, curve, index, line, below)
        drawn.append((curve, line))
    all_x = [x for _, line in drawn for x in line[0]]
    draw_guide(axes, all_x, 0.6 * min(line[1][0] for _, line in drawn))
    axes.axhline(
        floor,
        color="gray",
        linestyle="--",
        linewidth=0.9,
        label=f"noise of the reference ({run.get('reference.spp')} spp)",
    )
    axes.set(
        xscale="log", yscale="log", xlabel=AXES[x_key], ylabel="RMSE", ylim=(0.5 * floor, None)
    )
    if x_key == "spp":
        axes.set_xscale("log", base=2)
    add_legend(figure, axes)
    return figure


def write_curves(run, folder):
    """Writes the plots of errors; returns {file: caption}."""
    folder.mkdir(parents=True, exist_ok=True)
    figures, note = {}, left_out(run.curves, lambda curve: value(curve, "points"))
    for x_key, axis in AXES.items():
        if x_key == "seconds_device" and clock_of(run) == "wall":
            continue  # another renderer has none
        save(curves_figure(run, x_key), folder / f"rmse_{x_key}", ".svg", ".png")
        caption = f"RMSE against {axis}; medians and the central 95 % of the seeds. {note}"
        figures[f"rmse_{x_key}.svg"] = caption.rstrip()
    return figures


def write_plots(run):
    """Writes all figures of a run into its folder "plots"; returns {file: caption}."""
    folder = run.folder / "plots"
    return {
        **write_curves(run, folder),
        **write_error_plots(run, folder),
        **write_pictures(run, folder),
    }
