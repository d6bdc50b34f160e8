# SPDX-License-Identifier: MIT
"""Verdicts on measured intervals."""

import math

from rtrays.documents.document import value

VERDICTS = ("holds", "holds partly", "does not hold here", "undecided", "not measured")


def place(figure, bounds):
    """Returns whether an interval lies "inside", "outside" or "across" bounds; a bound that is None
    is open."""
    lowest = -math.inf if bounds[0] is None else bounds[0]
    highest = math.inf if bounds[1] is None else bounds[1]
    low, high = value(figure, "low"), value(figure, "high")
    if lowest <= low and high <= highest:
        return "inside"
    return "outside" if high < lowest or low > highest else "across"


WORDS = {"inside": "holds", "outside": "does not hold here", "across": "undecided"}


def slope_verdict(slope, expected, tolerance):
    """Judges whether an interval lies within, outside of, or across expected +/- tolerance."""
    return WORDS[place(slope, (expected - tolerance, expected + tolerance))]


def gain_verdict(gain, claimed):
    """Judges whether an interval reaches the claimed factor, is a gain at all, or a loss."""
    if value(gain, "low") > 1:
        return "holds" if value(gain, "high") >= claimed else "holds partly"
    return "does not hold here" if value(gain, "high") < claimed else "undecided"


def agreement_verdict(agreement):
    """Judges whether the image equals the reference up to noise."""
    if not value(agreement, "agrees") or value(agreement, "equivalence") == "different":
        return "does not hold here"
    return "holds" if value(agreement, "equivalence") == "equivalent" else "undecided"
