# SPDX-License-Identifier: MIT
"""Where in the image the error lies: at edges or elsewhere."""

import numpy

from efficiency import DRAWS
from run_document import value

# An edge: where the brightest channel of the reference changes by this share of the larger value to the next pixel.
EDGE = 0.2


def edge_errors(run, curve):
    """Mean squared error at edges over that elsewhere, of the mean image; bootstrap over pixels. None without edges."""
    generator, reference = numpy.random.default_rng(1), run.image(run.get("reference.image"))
    squares = ((run.image(value(curve, "image")) - reference) ** 2).mean(axis=2)
    brightest = reference.max(axis=2)
    edge = numpy.zeros(brightest.shape, dtype=bool)
    for axis in (0, 1):
        ahead = numpy.roll(brightest, -1, axis)
        jump = numpy.abs(ahead - brightest) > EDGE * numpy.maximum(ahead, brightest)
        jump[(-1,) if axis == 0 else (slice(None), -1)] = False  # the last row's next is the first
        edge |= jump | numpy.roll(jump, 1, axis)
    if not edge.any() or edge.all():
        return None
    draws = [sample[generator.integers(0, len(sample), (DRAWS // 4, len(sample)))].mean(axis=1) for sample in (squares[edge], squares[~edge])]
    low, high = numpy.quantile(draws[0] / draws[1], [0.025, 0.975])
    return {"value": squares[edge].mean() / squares[~edge].mean(), "low": low, "high": high}
