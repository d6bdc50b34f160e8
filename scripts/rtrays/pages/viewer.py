# SPDX-License-Identifier: MIT
"""Writes the image comparison of a page; images are in a script file, since pages opened from disk
may not fetch."""

import base64
import json
import pathlib

import numpy

from rtrays.documents.curves import label, shown_curves
from rtrays.documents.document import value, write_text

SCRIPT = pathlib.Path(__file__).with_name("viewer.js")


def to_rgbe(linear):
    """Ward's shared exponent, "Real pixels" (Graphics Gems II, 1991): (height, width, 3) floats to
    (height, width, 4) bytes.

    Values below 2^-127 and negative ones are black. The error of a channel is at most 2^-8 of the
    pixel's largest.
    """
    largest = numpy.max(linear, axis=-1)
    _, exponent = numpy.frexp(largest)
    visible = (largest > 0) & (exponent > -127)
    scale = numpy.where(visible, numpy.ldexp(1.0, 8 - exponent), 0.0)
    mantissa = numpy.clip(linear * scale[..., None], 0, 255).astype(numpy.uint8)
    return numpy.concatenate(
        [mantissa, numpy.where(visible, exponent + 128, 0)[..., None].astype(numpy.uint8)], axis=-1
    )


def pictures(run):
    """Yields (name, linear image): the reference, then every curve; passes and early images of the
    curves with figures."""
    yield f"reference, {run.get('reference.spp')} spp", run.image(run.get("reference.image"))
    for curve in reversed(run.curves):
        image, spp = value(curve, "image"), value(curve, "image_spp")
        yield f"{label(curve)}, {spp} spp", run.image(image)
        if curve not in shown_curves(run):
            continue
        for layer in value(curve, "layers"):
            yield f"{label(curve)}, {layer} paths alone", run.layer(image, layer)
        for early in value(curve, "early_images"):
            yield f"{label(curve)}, {value(early, 'spp')} spp", run.image(value(early, "image"))


def write_viewer(run):
    """Writes viewer.js and images.js into the run's folder."""
    images = [
        {
            "name": name,
            "width": picture.shape[1],
            "height": picture.shape[0],
            "data": base64.b64encode(to_rgbe(picture).tobytes()).decode(),
        }
        for name, picture in pictures(run)
    ]
    write_text(run.folder / "images.js", f"const images = {json.dumps(images)};\n")
    write_text(run.folder / "viewer.js", SCRIPT.read_text())
