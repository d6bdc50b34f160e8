# SPDX-License-Identifier: MIT
"""Rules of claims: the verdict on each figure, and their texts."""

from rtrays.documents.undecided import factor_of_agreement, factor_of_all, factor_of_gain
from rtrays.documents.verdicts import WORDS, agreement_verdict, gain_verdict, place


def figure_verdict(figure, rule):
    """Returns the verdict on one figure."""
    if "agrees" in rule:
        return agreement_verdict(figure)
    if "gain" in rule:
        return gain_verdict(figure, rule["gain"])
    where = place(figure, rule["within"])
    if where != "inside" and "partly" in rule and place(figure, rule["partly"]) == "inside":
        return "holds partly"
    return WORDS[where]


def figure_advice(figure, rule):
    """Returns the factor by which the samples must grow to decide an undecided figure, and the word
    for samples."""
    if "agrees" in rule:
        return factor_of_agreement(figure), "samples"
    if "gain" in rule:
        return factor_of_gain(figure, rule["gain"]), "seeds"
    return factor_of_all(figure, rule["within"]), "repetitions"


def combined(verdicts):
    """Combines the verdicts on all figures of a claim.

    A claim holds partly if it holds for some figures and not for others; it is undecided only if
    none fails.
    """
    kinds = set(verdicts)
    if len(kinds) == 1:
        return kinds.pop()
    if kinds & {"holds", "holds partly"}:
        return "undecided" if kinds == {"holds", "undecided"} else "holds partly"
    return "does not hold here"


def bounds_text(low, high):
    """Returns bounds as text; a bound that is None is open."""
    if low is None or high is None:
        return f"at most {high:g}" if low is None else f"at least {low:g}"
    return f"is {low:g}" if low == high else f"from {low:g} to {high:g}"


def rule_text(rule):
    """Returns the text of a rule."""
    if "agrees" in rule:
        return (
            "no block of 16 x 16 pixels differs, 99 % interval of the mean difference within 0.1 %"
        )
    if "gain" in rule:
        return "interval above 1" + (
            f" and reaches {rule['gain']:g}; partly: above 1 alone" if rule["gain"] > 1 else ""
        )
    partly = f"; partly: {bounds_text(*rule['partly'])}" if "partly" in rule else ""
    return f"interval {bounds_text(*rule['within'])}{partly}"
