# SPDX-License-Identifier: MIT
"""Points of the curves of a run: chosen curves, metrics, and the spread of the seeds."""

import numpy

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
# Share of the seeds that a band or an interval has.
CENTRE = (0.025, 0.975)


def chosen_curves(run, ids):
    """Returns the curves with these ids, in this order, or all without ids."""
    by_id = {value(curve, "id"): curve for curve in run.curves}
    unknown = [name for name in ids if name not in by_id]
    if unknown:
        raise RunError(
            f"{run.folder / 'run.json'}: unknown curve '{unknown[0]}'; curves are:"
            f" {', '.join(by_id)}"
        )
    return [by_id[name] for name in ids] if ids else run.curves


def spread(point, metric):
    """Returns median and central 95 % of the seeds of a point: (value, low, high)."""
    sample = [value(repetition, metric) for repetition in value(point, "repetitions")]
    return (float(numpy.median(sample)), *map(float, numpy.quantile(sample, CENTRE)))
