# SPDX-License-Identifier: MIT
"""How many more samples would decide what an interval leaves undecided.

The width of an interval falls as 1 / sqrt(n). If the value stays where it is, an interval that
reaches beyond a bound at distance d of the value by its half-width w needs (w / d)^2 times the
samples.
"""

import math

from rtrays.documents.document import value

# Beyond this factor the value lies on the bound, as far as one can see.
HOPELESS = 1000


def factor(figure, bound):
    """Returns by how much the number of samples must grow until the interval leaves the bound; 1
    if it has."""
    middle, low, high = (value(figure, key) for key in ("value", "low", "high"))
    if not low <= bound <= high:
        return 1.0
    distance = abs(middle - bound)
    half = middle - low if middle > bound else high - middle
    return (half / distance) ** 2 if distance > 0 else math.inf


def factor_of_all(figure, bounds):
    """Returns the factor until the interval leaves every bound; bounds that are None are open."""
    return max((factor(figure, bound) for bound in bounds if bound is not None), default=1.0)


def factor_of_gain(gain, claimed):
    """A gain is decided if its interval lies above 1 or below the claim, whichever comes first."""
    middle = value(gain, "value")
    reached = [factor(gain, 1)] if middle > 1 else []
    failed = [factor(gain, claimed)] if middle < claimed else []
    return min(reached + failed, default=math.inf)


def factor_of_agreement(agreement):
    """Returns the factor until the interval of the mean's difference leaves the limits of
    equivalence."""
    difference = value(agreement, "relative_difference")
    limit = value(difference, "limit")
    return factor_of_all(difference, (-limit, limit))


def advice(times, unit="samples"):
    """Returns the words for a factor, such as "about 4 times as many samples would decide it"."""
    if not math.isfinite(times) or times > HOPELESS:
        return f"the value lies so near the bound that more {unit} hardly decide it"
    if times < 3:
        text = f"{math.ceil(10 * times) / 10:g}"
    elif times < 100:
        text = f"{math.ceil(times)}"
    else:
        text = f"{math.ceil(times / 10) * 10}"
    return f"about {text} times as many {unit} would decide it"


def with_advice(verdict, times, unit="samples"):
    """Returns the verdict, and after "undecided" what would decide it."""
    return f"{verdict}: {advice(times(), unit)}" if verdict == "undecided" else verdict
