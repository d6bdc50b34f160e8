# SPDX-License-Identifier: MIT
"""Figures that say where the error of a run of curves is."""

import numpy
from matplotlib import pyplot
from matplotlib.colors import to_rgb

from rtrays.documents.curves import base_curve, label
from rtrays.documents.error_parts import (
    CLASSES,
    common_spp,
    errors,
    has_parts,
    pixel_shares,
    present_classes,
    shares_of_error,
)
from rtrays.plots.image_plots import draw_image, to_display
from rtrays.plots.style import COLOURS, legend_below, save

# Colours of the classes, in plots and over the picture.
OF_CLASS = dict(zip(CLASSES, (COLOURS[1], COLOURS[0], "#BBBBBB")))


def parts_figure(run):
    """Draws the shares of pixels and of every curve's mean squared error as bars of 100 %."""
    base, classes = base_curve(run), present_classes(run)
    bars = [("pixels", pixel_shares(run))]
    for curve in run.curves:
        spp = common_spp(run, base, curve)
        mse = errors(run, curve, spp, "mse").mean()
        bars.append(
            (f"{label(curve)},\nMSE × samples {mse * spp:.3g}", shares_of_error(run, curve, spp))
        )
    figure, axes = pyplot.subplots(figsize=(6.8, 0.7 + 0.42 * len(bars)), layout="constrained")
    left = numpy.zeros(len(bars))
    for key in classes:
        widths = numpy.array([100 * max(shares[key], 0) for _, shares in bars])
        axes.barh(range(len(bars)), widths, left=left, color=OF_CLASS[key], label=CLASSES[key])
        left += widths
    axes.set_yticks(range(len(bars)), [name for name, _ in bars])
    axes.set(xlabel="share, %", xlim=(0, 100))
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    legend_below(figure, len(classes))
    return figure


def classes_figure(run):
    """Draws the reference, and the classes of its pixels in their colours over its brightness."""
    reference = run.image(run.get("reference.image"))
    classes = run.image(run.get("first_hits.image"))
    grey = to_display(reference).mean(axis=2, keepdims=True)
    colours = numpy.array([to_rgb(colour) for colour in OF_CLASS.values()])
    shown = (0.35 + 0.65 * grey) * (classes @ colours)
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(6.4, 3.5), layout="constrained")
    draw_image(left, f"reference, {run.get('reference.spp')} spp", reference)
    right.imshow(shown, interpolation="nearest")
    right.set_title("what the camera sees first", fontsize=9)
    right.set_axis_off()
    handles = [
        pyplot.Rectangle((0, 0), 1, 1, color=OF_CLASS[key], label=CLASSES[key])
        for key in present_classes(run)
    ]
    figure.legend(
        handles=handles, fontsize=8, loc="upper center", bbox_to_anchor=(0.5, 0), ncols=3
    )
    return figure


def write_error_plots(run, folder):
    """Writes the figures of the parts of the error; returns {file: caption}. The picture of the
    classes is made of images; without them the stored one stays as it is."""
    if not has_parts(run):
        return {}
    folder.mkdir(parents=True, exist_ok=True)
    save(parts_figure(run), folder / "error_parts", ".svg", ".png")
    figures = {
        "error_parts.svg": "Where the error is, by what the camera sees first. MSE × samples is"
        " proportional to the cost of equal error."
    }
    if run.has_images():
        save(classes_figure(run), folder / "first_hits", ".png")
    if (folder / "first_hits.png").exists():
        figures["first_hits.png"] = "Classes of pixels by what the camera sees first."
    return figures
