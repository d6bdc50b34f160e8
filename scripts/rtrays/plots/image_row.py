# SPDX-License-Identifier: MIT
"""A figure for a paper: images of several curves after about the same time, enlarged parts of them,
and their errors in false colours."""

import textwrap

import numpy
from matplotlib import colormaps, patches, pyplot
from matplotlib.colors import LogNorm

from rtrays.documents.curves import clock_of, label, seconds
from rtrays.documents.document import RunError, value
from rtrays.documents.points import chosen_curves
from rtrays.plots.image_plots import to_display
from rtrays.plots.style import COLOURS

# Smallest and largest error of the colour scale, in quantiles of all shown errors.
SCALE = (0.05, 0.995)
# Characters in a line of a title.
LINE = 22


def kept_images(run, curve):
    """Returns {samples per pixel: file} of the images of the first seed that the run keeps."""
    return {value(each, "spp"): value(each, "image") for each in value(curve, "early_images")}


def image_near(run, curve, time):
    """Returns (measurement, linear image) of the kept image whose seconds are nearest to `time` by
    their ratio; the latest one without a time. The measurement has samples, seconds and errors."""
    kept = kept_images(run, curve)
    measured = [
        {
            **value(point, "repetitions")[0],
            "spp": value(point, "spp"),
            "seconds": seconds(curve, value(point, "repetitions")[0], clock_of(run)),
        }
        for point in value(curve, "points")
        if value(point, "spp") in kept
    ]
    if not measured:
        raise RunError(
            f"curve {value(curve, 'id')} has no images of single renders; add \"early_images\" to"
            " the profile and run it again"
        )
    nearest = (
        measured[-1]
        if time is None
        else min(measured, key=lambda each: abs(numpy.log(each["seconds"] / time)))
    )
    return nearest, run.image(kept[nearest["spp"]])


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


def image_row(run, time=None, ids=(), insets=(), width=7.0):
    """Draws the reference and one image of every curve, with insets and errors. `time` in seconds
    chooses the images; `insets` are (x, y, width, height) in pixels; `width` in inches."""
    curves = chosen_curves(run, ids)
    reference = run.image(run.get("reference.image"))
    for inset in insets:
        require_inside(inset, reference.shape)
    aspect = reference.shape[0] / reference.shape[1]
    heights = [aspect, *(height / part for _, _, part, height in insets), aspect]
    figure, grid = pyplot.subplots(
        len(heights),
        1 + len(curves),
        figsize=(width, width / (1 + len(curves)) * (sum(heights) + 0.5)),
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
        of, picture = image_near(run, curve, time)
        maps.append(numpy.abs(picture.astype(float) - reference).mean(axis=2))
        note = (
            f"{of['spp']} spp, {of['seconds']:.3g} s\nRMSE {of['rmse']:.3g}\nrelMSE"
            f" {of['relmse']:.3g}"
        )
        draw_column(column, picture, label(curve), insets, note)
    positive = numpy.concatenate([each[each > 0] for each in maps])
    norm = LogNorm(*numpy.quantile(positive, SCALE)) if positive.size else None
    colours = colormaps["inferno"].copy()
    colours.set_bad(colours(0.0))  # no logarithm: pixels without an error
    for column, difference in zip(grid.T[1:], maps):
        drawn = column[-1].imshow(difference, norm=norm, cmap=colours, interpolation="nearest")
    bar = figure.colorbar(drawn, ax=list(grid[-1, 1:]), pad=0.01)
    bar.set_label("|difference|", fontsize=7)
    bar.ax.tick_params(labelsize=7)
    return figure
