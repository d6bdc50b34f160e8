# SPDX-License-Identifier: MIT
"""Measures whether the error of an image is at edges or elsewhere."""

import numpy

from rtrays.documents.curves import shown_curves
from rtrays.documents.document import read_json, value, write_json
from rtrays.documents.efficiency import DRAWS

# At an edge the brightest channel of the reference changes to the next pixel by this share of the
# larger value.
EDGE = 0.2


def edge_errors(run, curve):
    """Returns the mean squared error of the mean image at edges over that elsewhere, by bootstrap
    over pixels; None for an image without edges."""
    generator, reference = numpy.random.default_rng(1), run.image(run.get("reference.image"))
    squares = ((run.image(value(curve, "image")) - reference) ** 2).mean(axis=2)
    brightest = reference.max(axis=2)
    edge = numpy.zeros(brightest.shape, dtype=bool)
    for axis in (0, 1):
        ahead = numpy.roll(brightest, -1, axis)
        jump = numpy.abs(ahead - brightest) > EDGE * numpy.maximum(ahead, brightest)
        jump[
            (-1,) if axis == 0 else (slice(None), -1)
        ] = False  # the pixel after the last one is the first
        edge |= jump | numpy.roll(jump, 1, axis)
    if not edge.any() or edge.all():
        return None
    draws = [
        sample[generator.integers(0, len(sample), (DRAWS // 4, len(sample)))].mean(axis=1)
        for sample in (squares[edge], squares[~edge])
    ]
    low, high = numpy.quantile(draws[0] / draws[1], [0.025, 0.975])
    middle = squares[edge].mean() / squares[~edge].mean()
    return {"value": float(middle), "low": float(low), "high": float(high)}


def edges_document(run):
    """Returns where the error is, by curve: measured from the images if they are here, else as
    kept in edges.json.

    The figures outlive the images, which a clone does not have.
    """
    path = run.folder / "edges.json"
    if not run.has_images():
        return read_json(path) if path.is_file() else {}
    found = {value(curve, "id"): edge_errors(run, curve) for curve in shown_curves(run)}
    document = {name: ratio for name, ratio in found.items() if ratio}
    write_json(path, document)
    return document
