# SPDX-License-Identifier: MIT
"""Parts of the mean squared error by what the camera sees first in a pixel.

Documents of version 0.1.0 have no parts.
"""

import numpy

from rtrays.documents.document import value
from rtrays.documents.efficiency import costs, ratio_of_means

# Keys of run.json, and their names on pages.
CLASSES = {
    "light_behind_delta": "lights behind mirrors or glass",
    "delta": "other mirrors and glass",
    "other": "the rest",
}
# Errors of the full image that stand beside those of the classes.
FULL = {"mse": "all pixels", "mse_clipped": "values clipped at 1", "relmse": "relMSE"}


def has_parts(run):
    """Whether the run has the parts of its errors."""
    return "first_hits" in run.document


def pixel_shares(run):
    """Returns the share of pixels of each class, by key."""
    return {key: run.get(f"first_hits.pixels.{key}") for key in CLASSES}


def present_classes(run):
    """Returns the keys of the classes that the image has."""
    return [key for key, share in pixel_shares(run).items() if share > 0]


def point_at(curve, spp):
    """Returns the point of a curve at a sample count."""
    return next(point for point in value(curve, "points") if value(point, "spp") == spp)


def errors(run, curve, spp, key):
    """Returns an error of every seed: the part of a class, without the noise of the reference, or
    an error of the full image.

    Noise is subtracted from squared differences. The other two errors are as measured.
    """
    repetitions = value(point_at(curve, spp), "repetitions")
    if key in CLASSES:
        noise = run.get(f"first_hits.noise_mse.{key}")
        return numpy.array([value(r, f"mse_parts.{key}") for r in repetitions]) - noise
    noise = run.get("reference.noise_floor.mse") if key == "mse" else 0
    return numpy.array([value(r, key) for r in repetitions]) - noise


def shares_of_error(run, curve, spp):
    """Returns the share of each class in the mean squared error, by key."""
    parts = {key: errors(run, curve, spp, key).mean() for key in CLASSES}
    return {key: part / sum(parts.values()) for key, part in parts.items()}


def common_spp(run, base, curve):
    """Returns the last sample count that two curves have above the noise of the reference."""
    return costs(base, curve, run.get("reference.noise_floor.mse"))[0].spp


def gain_in(run, base, curve, key):
    """Returns how many times the samples of `curve` are needed by `base` for an equal error in one
    class or by one metric, with its interval; None if the noise of the reference hides an error."""
    spp = common_spp(run, base, curve)
    over, under = errors(run, base, spp, key), errors(run, curve, spp, key)
    if over.min() <= 0 or under.min() <= 0:
        return None
    return ratio_of_means(over, under)
