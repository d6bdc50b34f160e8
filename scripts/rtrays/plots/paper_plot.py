# SPDX-License-Identifier: MIT
"""A plot for a paper: one metric of the error over samples or seconds, for chosen curves."""

from matplotlib import pyplot

from rtrays.documents.curves import is_other, label, usable_points
from rtrays.documents.document import RunError, value
from rtrays.documents.points import METRICS, chosen_curves, of_seeds, spread
from rtrays.plots.curve_plots import x_of
from rtrays.plots.style import COLOURS, MARKERS, METADATA


def paper_figure(run, metric, over, ids=(), width=3.4):
    """Draws a metric over "spp", "device" or "wall" seconds, log-log; `width` in inches is that of
    a column by default."""
    if metric not in METRICS:
        raise RunError(f"unknown metric '{metric}'; metrics are: {', '.join(METRICS)}")
    curves = chosen_curves(run, ids)
    for curve in curves:
        if over == "device" and is_other(curve):
            raise RunError(f"curve {value(curve, 'id')} has no device time; use --over wall")
    x_key = over if over == "spp" else f"seconds_{over}"
    figure, axes = pyplot.subplots(figsize=(width, 0.7 * width + 0.16 * len(curves)))
    for index, curve in enumerate(curves):
        points = usable_points(curve)
        x = [x_of(curve, point, x_key) for point in points]
        middle, low, high = zip(
            *(spread(of_seeds(curve, point, metric)) for point in points)
        )
        colour = COLOURS[index % len(COLOURS)]
        axes.fill_between(x, low, high, color=colour, alpha=0.2, linewidth=0)
        axes.plot(
            x,
            middle,
            color=colour,
            marker=MARKERS[index % len(MARKERS)],
            markersize=3.5,
            linewidth=1.2,
            label=label(curve),
        )
    across = "samples per pixel" if over == "spp" else f"{over} time, s"
    axes.set(xscale="log", yscale="log", xlabel=across, ylabel=METRICS[metric])
    axes.legend(fontsize=7, loc="upper center", bbox_to_anchor=(0.5, -0.22))
    return figure


def write_figure(figure, path):
    """Writes a figure as PDF, SVG or PNG, by the suffix of the path."""
    if path.suffix not in (".pdf", *METADATA):
        raise RunError(f"{path}: unknown suffix '{path.suffix}'; expected .pdf, .svg or .png")
    path.parent.mkdir(parents=True, exist_ok=True)
    metadata = METADATA.get(path.suffix, {"CreationDate": None})
    figure.savefig(path, dpi=300, metadata=metadata, bbox_inches="tight")
    pyplot.close(figure)
