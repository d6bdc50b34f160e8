# SPDX-License-Identifier: MIT
"""Figures made of images: beside the reference, by pass, and after few samples (figure 4.2)."""

import numpy
from matplotlib import pyplot

from rtrays.documents.curves import label, shown_curves
from rtrays.documents.document import file_name, value
from rtrays.plots.style import METADATA, save


def to_display(linear):
    """Returns linear values as sRGB, clipped; for display only, never for metrics."""
    clipped = numpy.clip(linear, 0, 1)
    return numpy.where(clipped <= 0.0031308, 12.92 * clipped, 1.055 * clipped ** (1 / 2.4) - 0.055)


def draw_image(axes, title, picture):
    """Draws a linear image under a title."""
    axes.imshow(to_display(picture), interpolation="nearest")
    axes.set_title(title, fontsize=9)
    axes.set_axis_off()


def panels_figure(panels):
    """Draws pictures side by side; `panels`: (title, linear image)."""
    figure, grid = pyplot.subplots(
        1, len(panels), figsize=(3.2 * len(panels), 3.5), layout="constrained"
    )
    for axes, panel in zip(grid, panels):
        draw_image(axes, *panel)
    return figure


def images_figure(run, curve):
    """Draws the reference, ours, and ten times their absolute difference."""
    reference = run.image(run.get("reference.image"))
    ours = run.image(value(curve, "image"))
    panels = (
        (f"reference, {run.get('reference.spp')} spp", reference),
        (f"{label(curve)}, {value(curve, 'image_spp')} spp", ours),
        ("10 × |difference|", 10 * numpy.abs(ours.astype(float) - reference)),
    )
    return panels_figure(panels)


def contributions_figure(run, curve):
    """Draws the contribution of each pass of an algorithm, and the sum (figures 4.8, 4.11, 4.14,
    4.17)."""
    image = value(curve, "image")
    panels = [(f"{layer} paths", run.layer(image, layer)) for layer in value(curve, "layers")]
    panels.append((f"{label(curve)}, {value(curve, 'image_spp')} spp", run.image(image)))
    return panels_figure(panels)


def early_figure(run, curves):
    """Draws the first seed's images after few samples, a row for each curve (figures 4.9, 4.12,
    4.15, 4.18)."""
    rows = [
        [
            (f"{label(curve)}, {value(early, 'spp')} spp", run.image(value(early, "image")))
            for early in value(curve, "early_images")
        ]
        for curve in curves
    ]
    columns = max(map(len, rows))
    figure, grid = pyplot.subplots(
        len(rows),
        columns,
        figsize=(2.9 * columns, 3.1 * len(rows)),
        layout="constrained",
        squeeze=False,
    )
    for axes in grid.flat:
        axes.set_axis_off()
    for line, panels in zip(grid, rows):
        for axes, panel in zip(line, panels):
            draw_image(axes, *panel)
    return figure


def pictures(run):
    """Yields (file, caption, function that draws it) of every figure that is made of images."""
    curves = shown_curves(run)
    for curve in curves:
        stem = file_name(value(curve, "id"))
        yield (
            f"images_{stem}.png",
            f"Reference, {label(curve)}, and ten times their absolute difference (sRGB for"
            " display).",
            lambda curve=curve: images_figure(run, curve),
        )
        if value(curve, "layers"):
            yield (
                f"contributions_{stem}.png",
                f"Contributions of the passes of {label(curve)}, and their sum.",
                lambda curve=curve: contributions_figure(run, curve),
            )
    if any(value(curve, "early_images") for curve in curves):
        caption = "Images after few samples, first seed."
        yield "early.png", caption, lambda: early_figure(run, curves)


def write_pictures(run, folder):
    """Writes the figures made of images, and the reference for the index; returns {file: caption}.

    Without the images the stored PNG files stay as they are.
    """
    if not run.has_images():
        return {file: caption for file, caption, _ in pictures(run) if (folder / file).exists()}
    folder.mkdir(parents=True, exist_ok=True)
    pyplot.imsave(
        folder / "reference.png",
        to_display(run.image(run.get("reference.image"))),
        metadata=METADATA[".png"],
    )
    figures = {}
    for file, caption, draw in pictures(run):
        save(draw(), folder / file.removesuffix(".png"), ".png")
        figures[file] = caption
    return figures
