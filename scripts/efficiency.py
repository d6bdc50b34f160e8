# SPDX-License-Identifier: MIT
"""Compares the curves of a run with its path tracing, for equal error and in equal time.

The mean squared error of an unbiased estimator falls as 1 / N, so that MSE x samples and MSE x
seconds hardly depend on N. Curves are still compared at equal N: the last paths of a batch are a
smaller share of the cost of many samples.
"""

import numpy

from run_document import RunError, label, pilot_seconds, usable_points, value

DRAWS = 2000


class Cost:
    """MSE and device seconds of a curve at its last point above the reference's noise, or at
    `spp`."""

    def __init__(self, curve, noise, spp=None):
        points = [
            point for point in usable_points(curve) if spp is None or value(point, "spp") <= spp
        ]
        if not points:
            raise RunError(
                f"curve {value(curve, 'id')} has no point above the reference's noise; the"
                " reference needs more samples"
            )
        point = points[-1]
        self.spp = value(point, "spp")
        self.pilot_seconds = pilot_seconds(curve)
        repetitions = value(point, "repetitions")
        self.mse = numpy.array([value(r, "mse") for r in repetitions]) - noise
        self.seconds = (
            float(numpy.median([value(r, "seconds_device") for r in repetitions]))
            - self.pilot_seconds
        )

    def draws(self, generator):
        """Mean MSE of resampled seeds."""
        return self.mse[generator.integers(0, len(self.mse), (DRAWS, len(self.mse)))].mean(axis=1)


def ratio(base, curve, key):
    """MSE x key of `base` over that of `curve`, with the bootstrap's 95 % interval over seeds:
    value, low, high."""
    scale = getattr(base, key) / getattr(curve, key)
    generator = numpy.random.default_rng(1)
    low, high = numpy.quantile(
        scale * base.draws(generator) / curve.draws(generator), [0.025, 0.975]
    )
    return {"value": scale * base.mse.mean() / curve.mse.mean(), "low": low, "high": high}


def costs(base, curve, noise):
    """Returns the costs of two curves at the last sample count that both have."""
    spp = min(Cost(base, noise).spp, Cost(curve, noise).spp)
    return Cost(base, noise, spp), Cost(curve, noise, spp)


def gain(base, curve, noise, key):
    """How many times the samples ("spp") or the device time ("seconds") of `curve` does `base`
    need for its error."""
    return ratio(*costs(base, curve, noise), key)


def base_curve(run):
    """Returns the curve of path tracing with both strategies, or the last curve of a run without
    it."""
    named = [curve for curve in run.curves if value(curve, "id") == "path_tracing.mis"]
    return (named or run.curves)[-1]


def curve_named(run, name):
    return next((curve for curve in run.curves if value(curve, "id") == name), None)


def times(gain):
    return f"{value(gain, 'value'):.2f} [{value(gain, 'low'):.2f}, {value(gain, 'high'):.2f}]"


def share_of_pass(curve, name):
    """Share of a pass ("camera", "light") in the device time of all stages."""
    stages = value(curve, "render_report.stages")
    return sum(stage["seconds"] for stage in stages if stage["pass"] == name) / sum(
        stage["seconds"] for stage in stages
    )


def explanation(run):
    """Explains the gain in equal time: fewer samples, each more expensive, and the savings from
    further strategies.

    Empty for a run without an expected gain.
    """
    expected = run.document["experiment"].get("expected_gain")
    curve = curve_named(run, f"{value(expected, 'algorithm')}.mis") if expected else None
    if curve is None:
        return ""
    noise, base = run.get("reference.noise_floor.mse"), base_curve(run)
    usual, ours = costs(base, curve, noise)
    text = (
        f"For equal error {label(base)} needs {times(ratio(usual, ours, 'spp'))} times as many"
        f" samples as {label(curve)}. A sample of {label(curve)} takes"
        f" {ours.seconds / usual.seconds:.2f} times as much device time; its light pass is"
        f" {100 * share_of_pass(curve, 'light'):.0f} % of that."
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


def finding(run):
    """Returns the sentence that states the gain in equal device time; None for a run without an
    expected gain."""
    expected = run.document["experiment"].get("expected_gain")
    curve = curve_named(run, f"{value(expected, 'algorithm')}.mis") if expected else None
    if curve is None:
        return None
    base = base_curve(run)
    measured = gain(base, curve, run.get("reference.noise_floor.mse"), "seconds")
    return (
        f"In equal device time {label(curve)} has {times(measured)} times the efficiency of"
        f" {label(base)}; the thesis claims {value(expected, 'time'):g}."
    )
