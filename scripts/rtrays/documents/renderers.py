# SPDX-License-Identifier: MIT
"""Rows of a measurement of several renderers: errors and times of images."""

import numpy

from rtrays.documents.curves import label
from rtrays.documents.document import value
from rtrays.documents.efficiency import ratio_of_means


def of_turns(contestant, key):
    """Returns an error or a duration of every turn."""
    return numpy.array([value(turn, key) for turn in value(contestant, "turns")])


def seconds(run, contestant):
    """Returns the median duration of a turn by the clock of the run."""
    return float(numpy.median(of_turns(contestant, f"seconds_{run.clock}")))


def error_times_seconds(run, contestant):
    """Returns the mean MSE times the duration, the inverse of efficiency."""
    return of_turns(contestant, "mse").mean() * seconds(run, contestant)


def contestants_of(row, is_ours):
    """Returns the contestants of this renderer, or the others."""
    return [c for c in value(row, "contestants") if value(c, "is_ours") == is_ours]


def best_of(run, row, is_ours):
    """Returns the contestant with the least MSE times duration; None if there is none."""
    return min(
        contestants_of(row, is_ours), key=lambda c: error_times_seconds(run, c), default=None
    )


def gain_in_time(run, own, other):
    """Returns the MSE of `other` over that of `own` in equal time, with the bootstrap's 95 %
    interval over turns."""
    scale = seconds(run, other) / seconds(run, own)
    return ratio_of_means(of_turns(other, "mse"), of_turns(own, "mse"), scale)


def name_of(contestant):
    """Returns the name of a contestant in tables and legends."""
    return (
        label({"id": contestant["name"]}) if value(contestant, "is_ours") else contestant["name"]
    )
