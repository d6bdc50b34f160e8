# SPDX-License-Identifier: MIT
"""Compares the curves of a run with its path tracing, for equal error and in equal time.

The mean squared error of independent samples falls as 1 / N, that of stratified ones faster, as
N^-a. Curves are compared at equal N. Path tracing takes another number of samples in the time of a
curve: there its MSE is multiplied by (seconds of path tracing / seconds of the curve)^a.

Seconds include the pilot of a curve. Its time does not grow with N, so a gain in equal time is that
of a render of N samples: a longer render gains more.
"""

import numpy

from rtrays.documents.curves import is_other, is_stratified, pilot_seconds, seconds, usable_points
from rtrays.documents.document import RunError, value

DRAWS = 2000


def exponent(curve):
    """Returns a of MSE ~ N^-a: 1 for independent samples, and twice the fitted slope of the RMSE
    without the noise of the reference for stratified ones and those of other renderers, which may
    be stratified."""
    is_fitted = is_stratified(curve) or is_other(curve)
    return -2 * value(curve, "slope_unbiased.value") if is_fitted else 1.0


class Cost:
    """MSE and seconds of a curve by a clock, the pilot included, at its last point above the
    reference's noise, or at the last one up to `spp`."""

    def __init__(self, curve, noise, spp=None, clock="device"):
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
        self.pilot_seconds = pilot_seconds(curve, clock)
        self.exponent = exponent(curve)
        repetitions = value(point, "repetitions")
        self.mse = numpy.array([value(r, "mse") for r in repetitions]) - noise
        self.seconds = float(numpy.median([seconds(curve, r, clock) for r in repetitions]))


def draws_of_mean(sample, generator):
    """Returns the means of resampled seeds."""
    return sample[generator.integers(0, len(sample), (DRAWS, len(sample)))].mean(axis=1)


def ratio_of_means(over, under, scale=1.0):
    """Returns the ratio of the means of two samples, with the bootstrap's 95 % interval over
    seeds."""
    generator = numpy.random.default_rng(1)
    low, high = numpy.quantile(
        scale * draws_of_mean(over, generator) / draws_of_mean(under, generator), [0.025, 0.975]
    )
    return {"value": scale * over.mean() / under.mean(), "low": low, "high": high}


def ratio(base, curve, key):
    """Returns the MSE of `base` over that of `curve` for equal samples ("spp") or in equal time
    ("seconds"), with the bootstrap's 95 % interval over seeds."""
    return ratio_of_means(
        base.mse, curve.mse, (getattr(base, key) / getattr(curve, key)) ** base.exponent
    )


def costs(base, curve, noise, clock="device"):
    """Returns the costs of two curves at the last sample count that both have."""
    spp = min(Cost(base, noise).spp, Cost(curve, noise).spp)
    return Cost(base, noise, spp, clock), Cost(curve, noise, spp, clock)


def gain(base, curve, noise, key, clock="device"):
    """Returns how many times smaller the MSE of `curve` is than that of `base`, for equal samples
    ("spp") or in equal time by a clock ("seconds"); see the head of this file. If the samples of
    `base` are independent, it needs as many times the samples or the time for an equal error."""
    return ratio(*costs(base, curve, noise, clock), key)


def share_of_pass(curve, name):
    """Returns the share of a pass ("camera", "light") in the device time of all stages."""
    stages = value(curve, "render_report.stages")
    return sum(stage["seconds"] for stage in stages if stage["pass"] == name) / sum(
        stage["seconds"] for stage in stages
    )
