# SPDX-License-Identifier: MIT
"""Curves of a run against its path tracing: equal error, equal time.

The mean squared error of an unbiased estimator falls as 1 / N, so that MSE x samples and MSE x seconds hardly depend on N.
They are compared at one N all the same: the paths that are left at a batch's end cost less of many samples than of few.
"""

import numpy

from run_document import RunError, label, pilot_seconds, usable_points, value

DRAWS = 2000


class Cost:
    """MSE x samples and MSE x device seconds of a curve, at its last point above the reference's noise, or at `spp`."""

    def __init__(self, curve, noise, spp=None):
        points = [point for point in usable_points(curve) if spp is None or value(point, "spp") <= spp]
        if not points:
            raise RunError(f"curve {value(curve, 'id')} has no point above the reference's noise: it needs more samples")
        point = points[-1]
        self.spp = value(point, "spp")
        self.pilot_seconds = pilot_seconds(curve)
        repetitions = value(point, "repetitions")
        self.mse = numpy.array([value(r, "mse") for r in repetitions]) - noise
        self.seconds = float(numpy.median([value(r, "seconds_device") for r in repetitions])) - self.pilot_seconds

    def draws(self, generator):
        """The mean MSE of resampled seeds."""
        return self.mse[generator.integers(0, len(self.mse), (DRAWS, len(self.mse)))].mean(axis=1)


def ratio(base, curve, key):
    """MSE x key of `base` over that of `curve`, with the bootstrap's 95 % interval over seeds: value, low, high."""
    scale = getattr(base, key) / getattr(curve, key)
    generator = numpy.random.default_rng(1)
    low, high = numpy.quantile(scale * base.draws(generator) / curve.draws(generator), [0.025, 0.975])
    return {"value": scale * base.mse.mean() / curve.mse.mean(), "low": low, "high": high}


def costs(base, curve, noise):
    """Of two curves, where the one that ends first ends."""
    spp = min(Cost(base, noise).spp, Cost(curve, noise).spp)
    return Cost(base, noise, spp), Cost(curve, noise, spp)


def gain(base, curve, noise, key):
    """How many times fewer samples ("spp") or less device time ("seconds") `curve` needs for the error of `base`."""
    return ratio(*costs(base, curve, noise), key)


def base_curve(run):
    """The curve of path tracing with both its strategies; the last one where there is none."""
    named = [curve for curve in run.curves if value(curve, "id") == "path_tracing.mis"]
    return (named or run.curves)[-1]


def curve_named(run, name):
    return next((curve for curve in run.curves if value(curve, "id") == name), None)


def times(gain):
    return f"{value(gain, 'value'):.2f} [{value(gain, 'low'):.2f}, {value(gain, 'high'):.2f}]"


def share_of_pass(curve, name):
    """Of a pass ("camera", "light") in the device time of all stages."""
    stages = value(curve, "render_report.stages")
    return sum(stage["seconds"] for stage in stages if stage["pass"] == name) / sum(stage["seconds"] for stage in stages)


def explanation(run):
    """Why an algorithm gains in equal time what it gains: fewer samples, each dearer, and what further strategies would save.
    Empty for a run of which the thesis states no gain."""
    expected = run.document["experiment"].get("expected_gain")
    curve = curve_named(run, f"{value(expected, 'algorithm')}.mis") if expected else None
    if curve is None:
        return ""
    noise, base = run.get("reference.noise_floor.mse"), base_curve(run)
    usual, ours = costs(base, curve, noise)
    price = ours.seconds / usual.seconds
    text = (f"For the error of {label(base)}, {label(curve)} needs {times(ratio(usual, ours, 'spp'))} times fewer samples, each of "
            f"which takes {price:.2f} times the device time (its light pass {100 * share_of_pass(curve, 'light'):.0f} % of that): "
            f"{times(ratio(usual, ours, 'seconds'))} in equal time, where the thesis has {value(expected, 'time'):g}.")
    full = curve_named(run, "bdpt.mis")
    if full is not None:
        saved = gain(curve, full, noise, "spp")
        text += (f" Full BDPT, which has all other connections, needs {times(saved)} times fewer samples than that: ")
        if value(saved, "low") <= 1:
            text += "no gain that this run can tell, so that little of what is left of the error is for want of connections."
        else:
            text += "so much of what is left of the error is for want of connections."
    return text
