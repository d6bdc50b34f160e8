# SPDX-License-Identifier: MIT
"""Arithmetic of intervals {"value", "low", "high"}, and statistics of several numbers."""

import numpy

from rtrays.documents.document import entry_named, value


def exact(number):
    """Returns the interval of a number without uncertainty."""
    return {"value": number, "low": number, "high": number}


def quotient(over, under):
    """Returns the quotient of two intervals; its ends are the extreme quotients."""
    return {
        "value": value(over, "value") / value(under, "value"),
        "low": value(over, "low") / value(under, "high"),
        "high": value(over, "high") / value(under, "low"),
    }


def inverse(interval):
    """Returns one over an interval."""
    return quotient(exact(1), interval)


def scaled(factor, interval):
    """Returns an interval times a factor above zero."""
    return {end: factor * value(interval, end) for end in ("value", "low", "high")}


def reach_of(intervals):
    """Returns the middles of intervals and the distances of their ends, as errorbar takes them."""
    middle = numpy.array([value(entry, "value") for entry in intervals])
    return middle, [
        middle - [value(entry, "low") for entry in intervals],
        [value(entry, "high") for entry in intervals] - middle,
    ]


def named_reach(lists, name, key):
    """Returns the middles and reaches of the intervals under `key` of the entry with a name in each
    of several lists."""
    return reach_of([value(entry_named(entries, name), key) for entries in lists])


def geometric_mean(values):
    """Returns the geometric mean of numbers above zero."""
    return float(numpy.exp(numpy.mean(numpy.log(values))))
