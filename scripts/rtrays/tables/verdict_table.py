# SPDX-License-Identifier: MIT
"""Table of verdicts on the curves of a run."""

from rtrays.documents.curves import (
    base_for,
    clock_of,
    is_blind,
    is_other,
    is_stratified,
    label,
    own_curves,
)
from rtrays.documents.document import value
from rtrays.documents.efficiency import gain
from rtrays.documents.undecided import (
    factor_of_agreement,
    factor_of_all,
    factor_of_gain,
    with_advice,
)
from rtrays.documents.verdicts import agreement_verdict, gain_verdict, slope_verdict
from rtrays.tables.cells import interval
from rtrays.tables.table import Table

BLIND = "not expected: light tracing does not see into mirrors and glass"
STRATIFIED = "not expected: stratified samples"
OTHER = "not expected: samples of another renderer"


def gain_rows(run):
    """Returns the rows of the thesis' gain over path tracing, in time and in samples."""
    expected = run.document["experiment"].get("expected_gain")
    if expected is None:
        return []
    noise = run.get("reference.noise_floor.mse")
    rows = []
    for key, of_run, words in (
        ("time", "seconds", f"equal {clock_of(run)} time"),
        ("samples", "spp", "equal samples"),
    ):
        for curve in own_curves(run):
            if value(curve, "algorithm") == value(expected, "algorithm"):
                base = base_for(run, curve)
                claimed = value(expected, key)
                measured = gain(base, curve, noise, of_run, clock_of(run))
                verdict = with_advice(
                    gain_verdict(measured, claimed),
                    lambda: factor_of_gain(measured, claimed),
                    "seeds",
                )
                rows.append(
                    [
                        label(curve),
                        f"gain over {label(base)} in {words}",
                        f"{claimed:g} times",
                        interval(measured, form="{:.2f}"),
                        verdict,
                    ]
                )
    return rows


def slope_row(curve, expected, tolerance):
    """Returns the row of the slope of one curve."""
    slope = value(curve, "slope")
    if is_other(curve) or is_blind(curve) or is_stratified(curve):
        verdict = OTHER if is_other(curve) else BLIND if is_blind(curve) else STRATIFIED
    else:
        verdict = with_advice(
            slope_verdict(slope, expected, tolerance),
            lambda: factor_of_all(slope, (expected - tolerance, expected + tolerance)),
            "seeds",
        )
    return [
        label(curve),
        "slope of log RMSE against log samples",
        f"{expected:g} ± {tolerance:g}",
        interval(slope, form="{:.4f}"),
        verdict,
    ]


def slope_rows(run):
    """Returns the row of the slope of every curve."""
    expected = run.get("experiment.expected_slope.value")
    tolerance = run.get("experiment.expected_slope.tolerance")
    return [slope_row(curve, expected, tolerance) for curve in run.curves]


def agreement_row(curve):
    """Returns the row of a curve's agreement with the reference."""
    agreement = value(curve, "agreement")
    verdict = (
        BLIND
        if is_blind(curve)
        else with_advice(agreement_verdict(agreement), lambda: factor_of_agreement(agreement))
    )
    return [
        label(curve),
        f"mean over the reference, %; {value(agreement, 'rejected')} of"
        f" {value(agreement, 'tests')} blocks reject",
        "same image",
        interval(value(agreement, "relative_difference"), 100, "{:+.3f}"),
        verdict,
    ]


def verdict_table(run):
    """Returns quantity, claim, measurement and verdict by curve; gains, which decide, come
    first."""
    rows = gain_rows(run) + slope_rows(run)
    rows += [agreement_row(curve) for curve in run.curves]
    return Table(
        "Claims and measurements",
        ["curve", "quantity", "claimed", "measured", "verdict"],
        rows,
        [
            "Intervals of slopes and gains are of 95 %, those of the mean of 99 %. The image is the"
            " reference's if no block of 16 x 16 pixels rejects and the interval of the mean is"
            " within 0.1 %."
        ],
    )
