# SPDX-License-Identifier: MIT
"""Sentences that state the findings of a run of curves."""

from rtrays.documents.curves import (
    base_curve,
    base_for,
    clock_of,
    curve_named,
    has_several_bases,
    is_stratified,
    label,
    own_curves,
)
from rtrays.documents.document import value
from rtrays.documents.efficiency import costs, gain, ratio, share_of_pass
from rtrays.tables.cells import interval, verdict_of
from rtrays.tables.verdict_table import agreement_row, slope_rows


def expected_curve(run):
    """Returns the curve whose gain over path tracing the thesis states, or None."""
    expected = run.document["experiment"].get("expected_gain")
    return curve_named(run, f"{value(expected, 'algorithm')}.mis") if expected else None


def times(gain):
    """Returns a gain with its interval as text."""
    return interval(gain, form="{:.2f}")


def explanation(run):
    """Explains the gain in equal time: fewer samples, each more expensive, and the savings from
    further strategies.

    Empty for a run without an expected gain.
    """
    curve = expected_curve(run)
    if curve is None:
        return ""
    noise, base = run.get("reference.noise_floor.mse"), base_curve(run)
    usual, ours = costs(base, curve, noise, clock_of(run))
    text = (
        f"For equal error {label(base)} needs {times(ratio(usual, ours, 'spp'))} times as many"
        f" samples as {label(curve)}. A sample of {label(curve)} takes"
        f" {ours.seconds / usual.seconds:.2f} times as much {clock_of(run)} time; its light pass is"
        f" {100 * share_of_pass(curve, 'light'):.0f} % of"
        f" {'that' if clock_of(run) == 'device' else 'its device time'}."
    )
    full = curve_named(run, "bdpt.mis")
    if full is not None:
        saved = gain(curve, full, noise, "spp")
        text += (
            f" For equal error {label(curve)} needs {times(saved)} times as many samples as full"
            " BDPT, which has all other connections. "
        )
        text += (
            "Missing connections explain little of the remaining error."
            if value(saved, "low") <= 1
            else "Missing connections explain that part of the remaining error."
        )
    return text


def gain_over_base(run, curve):
    """Returns the gain of a curve in equal time over path tracing under its own settings, as
    words."""
    base = base_for(run, curve)
    measured = gain(base, curve, run.get("reference.noise_floor.mse"), "seconds", clock_of(run))
    return f"{label(curve)} has {times(measured)} times the efficiency of {label(base)}"


def gain_finding(run, curve):
    """Returns the sentences that state the gain of a curve in equal time, that of the same
    algorithm with Sobol points on both sides, and that of the best setting."""
    claimed = run.get("experiment.expected_gain.time")
    sentences = [
        f"In equal {clock_of(run)} time {gain_over_base(run, curve)}; the thesis claims"
        f" {claimed:g}."
    ]
    sentences += [
        f"With the same sampler on both sides, {gain_over_base(run, other)}."
        for other in own_curves(run)
        if value(other, "algorithm") == value(curve, "algorithm")
        and is_stratified(other)
        and is_stratified(base_for(run, other))
    ]
    if has_several_bases(run):
        sentences.append(most_efficient(run))
    return " ".join(sentences)


def counted(rows, what):
    """Returns how many of the rows with a verdict hold, and how many are undecided."""
    words = [word for word in map(verdict_of, (row[-1] for row in rows)) if word]
    undecided = words.count("undecided")
    return f"{words.count('holds')} of {len(words)} {what}" + (
        f" ({undecided} undecided)" if undecided else ""
    )


def most_efficient(run):
    """Returns the sentence that names the curve of the largest gain in equal time, if the
    interval is above 1."""
    noise, base = run.get("reference.noise_floor.mse"), base_curve(run)
    gains = [
        (curve, gain(base, curve, noise, "seconds", clock_of(run)))
        for curve in run.curves
        if curve is not base
    ]
    if not gains:
        return ""
    best, measured = max(gains, key=lambda entry: value(entry[1], "value"))
    name = label(base)
    if any(map(is_stratified, run.curves)) and not is_stratified(base):
        name += " with independent samples"
    if value(measured, "low") <= 1:
        return f"No curve has a higher efficiency than {name} in equal {clock_of(run)} time."
    return (
        f"In equal {clock_of(run)} time {label(best)} has the highest efficiency,"
        f" {times(measured)} times that of {name}."
    )


def finding(run):
    """Returns the gain in equal time; without an expected gain, how many slopes and images are as
    claimed, and which curve is the most efficient."""
    curve = expected_curve(run)
    if curve is not None:
        return gain_finding(run, curve)
    expected, tolerance = (
        run.get(f"experiment.expected_slope.{key}") for key in ("value", "tolerance")
    )
    slopes = counted(slope_rows(run), f"curves fall with a slope of {expected:g} ± {tolerance:g}")
    images = counted(
        [agreement_row(curve) for curve in run.curves], "images agree with the reference"
    )
    sentences = [f"{slopes}; {images}.", most_efficient(run)]
    if not run.source:  # a question of one's own asks for the best curve
        sentences.reverse()
    return " ".join(filter(None, sentences))
