# SPDX-License-Identifier: MIT
"""Figures of claims from runs of curves and from convergence control."""

import numpy

from rtrays.documents import efficiency

from rtrays.documents.curves import algorithm_name, base_curve, curve_named, label, usable_points
from rtrays.documents.document import RunError, read_json, value
from rtrays.documents.efficiency import DRAWS
from rtrays.documents.intervals import exact, inverse
from rtrays.documents.run_document import Run


def curve_of(run, name):
    """Returns the curve with this id. Raises RunError without one."""
    curve = curve_named(run, name)
    if curve is None:
        raise RunError(f"{run.folder / 'run.json'}: no curve {name}")
    return curve


def slopes(folder):
    """Slope of log RMSE against log spp, every curve."""
    for curve in Run(folder).curves:
        yield label(curve), value(curve, "slope")


def agreements(folder):
    """Agreement with the reference, every curve."""
    for curve in Run(folder).curves:
        yield label(curve), value(curve, "agreement")


def gain(folder, of, curve="truncated_bdpt.mis", over="path_tracing.mis"):
    """How many times the samples ("spp") or the device time ("seconds") of a curve another needs
    for equal error."""
    run = Run(folder)
    noise = run.get("reference.noise_floor.mse")
    yield (
        f"{label(curve_of(run, curve))} over {label(curve_of(run, over))}",
        efficiency.gain(curve_of(run, over), curve_of(run, curve), noise, of),
    )


def sample_cost(folder, curve="truncated_bdpt.mis", over="path_tracing.mis"):
    """Device time of a sample of a curve over that of another, medians over seeds with a
    bootstrap's interval."""
    run, generator = Run(folder), numpy.random.default_rng(1)

    def medians(name):
        point = usable_points(curve_of(run, name))[-1]
        seconds = numpy.array(
            [value(r, "seconds_device") for r in value(point, "repetitions")]
        ) / value(point, "spp")
        draws = seconds[generator.integers(0, len(seconds), (DRAWS, len(seconds)))]
        return numpy.median(seconds), numpy.median(draws, axis=1)

    (own, own_draws), (other, other_draws) = medians(curve), medians(over)
    low, high = numpy.quantile(own_draws / other_draws, [0.025, 0.975])
    yield "a sample of one over one of the other", {"value": own / other, "low": low, "high": high}


def edge_errors(folder, curve="path_tracing.mis"):
    """Mean squared error of the mean image at edges over that elsewhere, from edges.json."""
    path = folder / "edges.json"
    found = read_json(path) if path.exists() else {}
    if curve in found:
        yield "squared error at edges over elsewhere", found[curve]


def memory(folder, curve, form):
    """Bytes per path of a curve: how many "more" than path tracing, or how many "times" as many."""
    run = Run(folder)
    own = value(curve_of(run, curve), "render_report.bytes_per_path")
    base = value(base_curve(run), "render_report.bytes_per_path")
    if form == "more":
        yield "bytes per path beyond path tracing", exact(own - base)
    else:
        yield "bytes per path over path tracing", exact(own / base)


def control_gain(folder, scene):
    """Device time without convergence control over that with it, where it saves most."""
    document = read_json(folder / "run.json")
    rows = [row for row in value(document, "rows") if row["scene"] == scene]
    for algorithm in sorted({row["algorithm"] for row in rows}):
        best = min(
            (row for row in rows if row["algorithm"] == algorithm),
            key=lambda row: value(row, "seconds.value"),
        )
        yield f"{algorithm_name(algorithm)}, error {value(best, 'error'):g}", inverse(
            value(best, "seconds")
        )
