# SPDX-License-Identifier: MIT
"""One sheet of the renderer's images of a finished experiment of agreement."""

import numpy
from matplotlib import pyplot

from rtrays.documents.document import RunError
from rtrays.plots.image_plots import to_display

COLUMNS = 8


def sheet_figure(images):
    """Draws images, files of arrays, in rows with their names above them."""
    rows = -(-len(images) // COLUMNS)
    size = 1.6 * COLUMNS, 1.78 * rows
    figure, axes = pyplot.subplots(rows, COLUMNS, figsize=size, squeeze=False)
    for axis in axes.flat:
        axis.axis("off")
    for axis, image in zip(axes.flat, images):
        axis.imshow(to_display(numpy.load(image)))
        axis.set_title(image.name.partition(".")[0], fontsize=7, pad=2)
    figure.tight_layout(pad=0.2)
    return figure


def write_contact_sheet(folder, path):
    """Writes the images of path tracing in a folder "images" as one PNG file."""
    images = sorted((folder / "images").glob("*.path_tracing.npy"))
    if not images:
        raise RunError(f"{folder}/images has no arrays; run the experiment first")
    with pyplot.rc_context({"font.size": 10}):  # the unit of paddings
        sheet_figure(images).savefig(path, dpi=100)
