# SPDX-License-Identifier: MIT
"""Compares the curves of a run with its path tracing, for equal error and in equal time.

The mean squared error of an unbiased estimator falls as 1 / N, so that MSE x samples and MSE x
seconds hardly depend on N. Curves are still compared at equal N: the last paths of a batch are a
smaller share of the cost of many samples, and the error of stratified samples falls faster.

Seconds include the pilot of a curve. Its time does not grow with N, so a gain in equal time is that
of a render of N samples: a longer render gains more.
"""

import numpy

from rtrays.documents.curves import pilot_seconds, usable_points
from rtrays.documents.document import RunError, value

DRAWS = 2000


class Cost:
    """MSE and device seconds of a curve, the pilot included, at its last point above the
    reference's noise, or at the last one up to `spp`."""

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
        self.seconds = float(numpy.median([value(r, "seconds_device") for r in repetitions]))


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
    """Returns MSE x key of `base` over that of `curve`, with the bootstrap's 95 % interval over
    seeds."""
    return ratio_of_means(base.mse, curve.mse, getattr(base, key) / getattr(curve, key))


def costs(base, curve, noise):
    """Returns the costs of two curves at the last sample count that both have."""
    spp = min(Cost(base, noise).spp, Cost(curve, noise).spp)
    return Cost(base, noise, spp), Cost(curve, noise, spp)


def gain(base, curve, noise, key):
    """Returns how many times the samples ("spp") or the device time ("seconds") of `curve` are
    needed by `base` for an equal error. Device time includes pilots; see the head of this file."""
    return ratio(*costs(base, curve, noise), key)


def share_of_pass(curve, name):
    """Returns the share of a pass ("camera", "light") in the device time of all stages."""
    stages = value(curve, "render_report.stages")
    return sum(stage["seconds"] for stage in stages if stage["pass"] == name) / sum(
        stage["seconds"] for stage in stages
    )
