# SPDX-License-Identifier: MIT
"""A figure for a paper: images of several curves after about the same time, enlarged parts of them,
and their errors in false colours."""

import textwrap

import numpy
from matplotlib import colormaps, patches, pyplot
from matplotlib.colors import LogNorm, Normalize

from rtrays.documents.curves import label
from rtrays.documents.document import RunError
from rtrays.documents.points import chosen_curves, require_metric
from rtrays.metrics.flip import METRICS as FLIP_METRICS
from rtrays.plots.image_plots import to_display
from rtrays.plots.kept_images import finite_image, kept_renders, require_images
from rtrays.plots.style import COLOURS

# Smallest and largest error of the colour scale, in quantiles of all shown errors.
SCALE = (0.05, 0.995)
# Characters in a line of a title; such a column and a row with few columns are so wide, in inches.
LINE = 22
COLUMN, ROW = 1.35, 7.0


def image_near(run, curve, time):
    """Returns (render, linear image) of the kept render whose seconds are nearest to `time` by
    their ratio; the latest one without a time. The render has samples, seconds and errors."""
    renders = kept_renders(run, curve)
    nearest = (
        renders[-1]
        if time is None
        else min(renders, key=lambda each: abs(numpy.log(each["seconds"] / time)))
    )
    return nearest, finite_image(run, nearest["image"])


def require_inside(inset, shape):
    """Raises RunError unless a part (x, y, width, height) is inside an image."""
    x, y, width, height = inset
    if min(inset) < 0 or min(width, height) < 1 or x + width > shape[1] or y + height > shape[0]:
        raise RunError(
            f"inset {x},{y},{width}x{height} is not inside the image of {shape[1]}x{shape[0]}"
        )


def clear(axes):
    """Removes ticks, grid and frame of axes that show an image."""
    axes.set_xticks([])
    axes.set_yticks([])
    axes.grid(False)
    for spine in axes.spines.values():
        spine.set_visible(False)


def draw_column(column, picture, title, insets, note=""):
    """Draws an image and its insets into the axes of a column."""
    column[0].imshow(to_display(picture), interpolation="nearest")
    column[0].set_title(textwrap.fill(title, LINE), fontsize=7)
    for index, (x, y, width, height) in enumerate(insets):
        colour = COLOURS[(index + 1) % len(COLOURS)]
        column[0].add_patch(
            patches.Rectangle(
                (x - 0.5, y - 0.5), width, height, fill=False, edgecolor=colour, linewidth=1
            )
        )
        part = picture[y : y + height, x : x + width]
        column[1 + index].imshow(to_display(part), interpolation="nearest")
        for spine in column[1 + index].spines.values():
            spine.set(visible=True, color=colour, linewidth=1.2)
    column[len(insets)].set_xlabel(note, fontsize=7)


def absolute_difference(picture, reference):
    """Returns the map whose mean is the MAE: the absolute difference, averaged over R, G, B."""
    return numpy.abs(picture.astype(float) - reference).mean(axis=2)


# Maps of an error by metric: the label of their scale, and the function that returns them.
MAPS = {"mae": ("|difference|", absolute_difference), **FLIP_METRICS}


def colour_scale(metric, maps):
    """Returns the norm and the colours of the maps of an error: those of the paper for FLIP, else
    logarithmic between two quantiles of all maps."""
    if metric in FLIP_METRICS:
        return Normalize(0, 1), colormaps["magma"]
    positive = numpy.concatenate([each[each > 0] for each in maps])
    norm = LogNorm(*numpy.quantile(positive, SCALE)) if positive.size else None
    colours = colormaps["inferno"].copy()
    colours.set_bad(colours(0.0))  # no logarithm: pixels without an error
    return norm, colours


def draw_maps(figure, axes, metric, maps):
    """Draws the maps of an error, each into its axes, and their common scale beside them."""
    norm, colours = colour_scale(metric, maps)
    for panel, errors in zip(axes, maps):
        drawn = panel.imshow(errors, norm=norm, cmap=colours, interpolation="nearest")
    bar = figure.colorbar(drawn, ax=list(axes), pad=0.01)
    bar.set_label(MAPS[metric][0], fontsize=7)
    bar.ax.tick_params(labelsize=7)


def note_below(render, metric, errors):
    """Returns the text below an image: samples, seconds and errors of its render, and the mean of
    the map of FLIP."""
    lines = [
        f"{render['spp']} spp, {render['seconds']:.3g} s",
        f"RMSE {render['rmse']:.3g}",
        f"relMSE {render['relmse']:.3g}",
    ]
    if metric in FLIP_METRICS:
        lines.append(f"{MAPS[metric][0]} {errors.mean():.3g}")
    return "\n".join(lines)


def image_row(run, time=None, ids=(), insets=(), metric="mae", width=None):
    """Draws the reference and one image of every curve, with insets and maps of an error. `time` in
    seconds chooses the images; `insets` are (x, y, width, height) in pixels; `width` is in inches,
    by default that of a page or as many as the titles need."""
    require_metric(metric, MAPS)
    require_images(run)
    curves = chosen_curves(run, ids)
    columns = 1 + len(curves)
    width = width or max(ROW, COLUMN * columns)
    reference = finite_image(run, run.get("reference.image"))
    for inset in insets:
        require_inside(inset, reference.shape)
    aspect = reference.shape[0] / reference.shape[1]
    heights = [aspect, *(height / part for _, _, part, height in insets), aspect]
    figure, grid = pyplot.subplots(
        len(heights),
        columns,
        figsize=(width, width / columns * (sum(heights) + 0.5)),
        height_ratios=heights,
        layout="compressed",
        squeeze=False,
    )
    for axes in grid.flat:
        clear(axes)
    draw_column(grid[:, 0], reference, f"reference, {run.get('reference.spp')} spp", insets)
    grid[-1, 0].set_axis_off()
    maps = []
    for column, curve in zip(grid.T[1:], curves):
        render, picture = image_near(run, curve, time)
        maps.append(MAPS[metric][1](picture, reference))
        note = note_below(render, metric, maps[-1])
        draw_column(column, picture, label(curve), insets, note)
    draw_maps(figure, grid[-1, 1:], metric, maps)
    return figure
