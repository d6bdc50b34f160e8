# SPDX-License-Identifier: MIT
"""Rows of a sweep: gains over its last curve while a scene changes."""

import numpy

from rtrays.documents.document import value
from rtrays.documents.efficiency import ratio_of_means

# Gains: key, what the errors are, and what their images cost.
GAINS = {
    "samples": ("mse", None),
    "rays": ("mse", "rays"),
    "time": ("mse", "seconds_device"),
    "rest": ("mse_parts.other", None),
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


def of_seeds(curve, key):
    """Returns an error or a cost of every seed."""
    return numpy.array([value(each, key) for each in value(curve, "repetitions")])


def gain(row, curve, key):
    """Returns the gain of a curve over the last one, by key of GAINS, with the bootstrap's 95 %
    interval over seeds; None if the image has no such pixels. At equal cost it compares the means
    of error times cost, seed by seed: the pilot of every seed may choose otherwise."""
    error, cost = GAINS[key]

    def inefficiency(of):
        return of_seeds(of, error) * (of_seeds(of, cost) if cost else 1.0)

    over, under = inefficiency(base_of(row)), inefficiency(curve)
    return ratio_of_means(over, under) if under.min() > 0 else None


def share_of_part(curve, key):
    """Returns the share of a class of pixels in the mean squared error of a curve."""
    return of_seeds(curve, f"mse_parts.{key}").mean() / of_seeds(curve, "mse").mean()


def delta_pixels(row):
    """Returns the share of pixels that show mirrors or glass."""
    return value(row, "pixels.light_behind_delta") + value(row, "pixels.delta")


def position(sweep, row):
    """Returns where a row stands on the axis of its sweep: at its value, or at the percentage of
    pixels that show mirrors or glass."""
    shows = value(sweep, "axis.shows")
    return value(row, "value") if shows == "value" else 100 * delta_pixels(row)
