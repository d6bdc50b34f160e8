# SPDX-License-Identifier: MIT
"""A plot for a paper: one metric of the error over samples or seconds, for chosen curves."""

from matplotlib import pyplot
from matplotlib.ticker import MaxNLocator, NullLocator

from rtrays.documents.curves import is_other, is_usable, label, left_out
from rtrays.documents.document import RunError, value
from rtrays.documents.points import METRICS, chosen_curves, of_seeds, require_metric, spread
from rtrays.metrics.flip import METRICS as FLIP_METRICS
from rtrays.plots.curve_plots import x_of
from rtrays.plots.kept_images import finite_image, kept_renders, require_images
from rtrays.plots.style import METADATA, colour_and_marker, legend_below


def points_with(run, curve, metric):
    """Returns the points of a curve that have a metric: all, or for FLIP the kept renders."""
    return kept_renders(run, curve) if metric in FLIP_METRICS else value(curve, "points")


def drawn_points(run, curve, metric):
    """Returns the points of a curve that have a metric before the reference's noise dominates."""
    points = [point for point in points_with(run, curve, metric) if is_usable(curve, point)]
    if not points:
        raise RunError(
            f"curve {value(curve, 'id')} keeps no image above the reference's noise; the reference"
            " needs more samples"
        )
    return points


def value_at(run, curve, point, metric):
    """Returns (value, low, high) of a metric at a point: the spread of the seeds, or FLIP of the
    only seed whose images a run keeps."""
    if metric not in FLIP_METRICS:
        return spread(of_seeds(curve, point, metric))
    images = (finite_image(run, file) for file in (point["image"], run.get("reference.image")))
    return (FLIP_METRICS[metric][1](*images).mean(),) * 3


def note_of(run, metric, ids=()):
    """Returns the sentence that counts the points that paper_figure leaves out; empty without
    any."""
    return left_out(chosen_curves(run, ids), lambda curve: points_with(run, curve, metric))


def axis_label(metric):
    """Returns the label of the axis of a metric."""
    return f"{FLIP_METRICS[metric][0]}, first seed" if metric in FLIP_METRICS else METRICS[metric]


def draw_spread(axes, x, values, index, name):
    """Draws a curve as a line with a band; `values` are (value, low, high)."""
    middle, low, high = zip(*values)
    style = colour_and_marker(index)
    axes.fill_between(x, low, high, color=style["color"], alpha=0.2, linewidth=0)
    axes.plot(x, middle, **style, markersize=3.5, linewidth=1.2, label=name)


def label_short_axis(axis):
    """Gives a logarithmic axis of less than a decade plain numbers at even distances."""
    low, high = axis.get_view_interval()
    if high < 10 * low:
        axis.set_major_locator(MaxNLocator(5))
        axis.set_minor_locator(NullLocator())
        axis.set_major_formatter("{x:g}")


def paper_figure(run, metric, over, ids=(), width=3.4):
    """Draws a metric over "spp", "device" or "wall" seconds, log-log; `width` in inches is that of
    a column by default."""
    require_metric(metric, [*METRICS, *FLIP_METRICS])
    if metric in FLIP_METRICS:
        require_images(run)
    curves = chosen_curves(run, ids)
    for curve in curves:
        if over == "device" and is_other(curve):
            raise RunError(f"curve {value(curve, 'id')} has no device time; use --over wall")
    x_key = over if over == "spp" else f"seconds_{over}"
    figure, axes = pyplot.subplots(figsize=(width, 0.75 * width), layout="constrained")
    for index, curve in enumerate(curves):
        points = drawn_points(run, curve, metric)
        x = [x_of(curve, point, x_key) for point in points]
        draw_spread(
            axes, x, [value_at(run, curve, point, metric) for point in points], index, label(curve)
        )
    across = "samples per pixel" if over == "spp" else f"{over} time, s"
    axes.set(xscale="log", yscale="log", xlabel=across, ylabel=axis_label(metric))
    label_short_axis(axes.yaxis)
    if over == "spp":
        axes.set_xscale("log", base=2)
    else:
        label_short_axis(axes.xaxis)
    legend_below(figure, 1)
    return figure


def write_figure(figure, path):
    """Writes a figure as PDF, SVG or PNG, by the suffix of the path."""
    if path.suffix not in (".pdf", *METADATA):
        raise RunError(f"{path}: unknown suffix '{path.suffix}'; expected .pdf, .svg or .png")
    path.parent.mkdir(parents=True, exist_ok=True)
    metadata = METADATA.get(path.suffix, {"CreationDate": None})
    figure.savefig(path, dpi=300, metadata=metadata, bbox_inches="tight")
    pyplot.close(figure)
