# SPDX-License-Identifier: MIT
"""Points of the curves of a run: chosen curves, metrics, and the spread of the seeds."""

import numpy

from rtrays.documents.curves import is_other, label, seconds
from rtrays.documents.document import RunError, value

METRICS = {
    "rmse": "RMSE",
    "mse": "MSE",
    "relmse": "relMSE",
    "mae": "MAE",
    "l2": "L2",
    "mse_clipped": "MSE of values clipped at 1",
}
CLOCKS = ("device", "wall")
# Quantiles of the seeds between which a band or an interval is.
CENTRE = (0.025, 0.975)


def require_metric(name, metrics):
    """Raises RunError unless a metric is one of some."""
    if name not in metrics:
        raise RunError(f"unknown metric '{name}'; metrics are: {', '.join(metrics)}")


def chosen_curves(run, names):
    """Returns the curves with these ids or labels, in this order, or all without names."""
    known = {value(curve, "id"): curve for curve in run.curves}
    known.update((label(curve), curve) for curve in run.curves)
    unknown = [name for name in names if name not in known]
    if unknown:
        raise RunError(
            f"{run.folder / 'run.json'}: unknown curve '{unknown[0]}'; curves are:"
            f" {'; '.join(label(curve) for curve in run.curves)}"
        )
    return [known[name] for name in names] if names else run.curves


def spread(sample):
    """Returns median and central 95 % of the values of the seeds: (value, low, high)."""
    return (float(numpy.median(sample)), *map(float, numpy.quantile(sample, CENTRE)))


def of_seeds(curve, point, quantity):
    """Returns a metric, or the seconds by a clock ("device" or "wall"), of every seed of a point;
    empty if the document does not have it."""
    repetitions = value(point, "repetitions")
    if quantity not in CLOCKS:
        return [repetition[quantity] for repetition in repetitions if quantity in repetition]
    if quantity == "device" and is_other(curve):
        return []
    return [seconds(curve, repetition, quantity) for repetition in repetitions]
