# SPDX-License-Identifier: MIT
"""Rows of a sweep: gains over its last curve while a scene changes."""

import numpy

from rtrays.documents.document import value
from rtrays.documents.efficiency import ratio_of_means

# Gains: key, what the errors are, and whether time counts.
GAINS = {
    "samples": ("mse", False),
    "time": ("mse", True),
    "rest": ("mse_parts.other", False),
}


def sweeps(run):
    """Returns (description of the sweep, its rows) of every sweep of a run."""
    return [
        (sweep, [row for row in run.get("rows") if row["sweep"] == sweep["name"]])
        for sweep in run.get("experiment.sweeps")
    ]


def base_of(row):
    """Returns the curve that the gains of a row are relative to, the last one."""
    return value(row, "curves")[-1]


def errors(curve, key):
    """Returns an error of every seed."""
    return numpy.array([value(each, key) for each in value(curve, "repetitions")])


def seconds(curve):
    """Returns the median device time of a seed."""
    return float(numpy.median(errors(curve, "seconds_device")))


def gain(row, curve, key):
    """Returns the gain of a curve over the last one, by key of GAINS, with the bootstrap's 95 %
    interval over seeds; None if the image has no such pixels."""
    base, (error, counts_time) = base_of(row), GAINS[key]
    scale = seconds(base) / seconds(curve) if counts_time else 1.0
    over, under = errors(base, error), errors(curve, error)
    return ratio_of_means(over, under, scale) if under.min() > 0 else None


def share_of_part(curve, key):
    """Returns the share of a class of pixels in the mean squared error of a curve."""
    return errors(curve, f"mse_parts.{key}").mean() / errors(curve, "mse").mean()


def delta_pixels(row):
    """Returns the share of pixels that show mirrors or glass."""
    return value(row, "pixels.light_behind_delta") + value(row, "pixels.delta")


def position(sweep, row):
    """Returns where a row stands on the axis of its sweep: at its value, or at the percentage of
    pixels that show mirrors or glass."""
    shows = value(sweep, "axis.shows")
    return value(row, "value") if shows == "value" else 100 * delta_pixels(row)
