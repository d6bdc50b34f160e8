# SPDX-License-Identifier: MIT
"""Curves of a run against its path tracing: equal error, equal time.

The mean squared error of an unbiased estimator falls as 1 / N, so that MSE x samples and MSE x seconds compare curves
whatever sample counts they were stopped at.
"""

import numpy

from run_document import RunError, pilot_seconds, usable_points, value

DRAWS = 2000


class Cost:
    """MSE x samples and MSE x device seconds of a curve, at its last point above the reference's noise."""

    def __init__(self, curve, noise):
        points = usable_points(curve)
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


def base_curve(run):
    """The curve of path tracing with both its strategies; the last one where there is none."""
    named = [curve for curve in run.curves if value(curve, "id") == "path_tracing.mis"]
    return (named or run.curves)[-1]
