# SPDX-License-Identifier: MIT
"""Tables of a run of curves."""

import json

from cells import BASELINE, NONE, Table, interval, number
from edges import edge_errors
from efficiency import Cost, base_curve, gain
from run_document import label, seconds, shown_curves, value, write_text
from undecided import factor_of_agreement, with_advice

POINT_METRICS = ("l2", "rmse", "mae", "relmse", "mse", "mse_unbiased")
PILOT_NOTE = (
    "Both times include the pilot that chooses the number of light paths; run.json has no wall time"
    " of it, so that its device time is added to the wall time."
)


def has_pilot(run):
    return any("pilot" in value(curve, "render_report") for curve in run.curves)


def errors_table(run):
    """Median errors and times of every curve and sample count: figure 4.3 in numbers."""
    rows = []
    for curve in run.curves:
        for point in value(curve, "points"):
            rows.append(
                [label(curve), str(value(point, "spp"))]
                + [number(seconds(curve, point, clock), 4) for clock in ("device", "wall")]
                + [number(value(point, key), 4) for key in POINT_METRICS]
                + ["no" if value(point, "noise_dominates") else "yes"]
            )
    columns = [
        "curve",
        "samples per pixel",
        "device time, s",
        "wall time, s",
        "L2",
        "RMSE",
        "MAE",
        "relMSE",
        "MSE",
        "MSE minus reference noise",
        "above the noise floor",
    ]
    return Table(
        "Errors and times, medians over seeds",
        columns,
        rows,
        [PILOT_NOTE if has_pilot(run) else ""],
    )


def slopes_table(run):
    rows = [
        [
            label(curve),
            interval(value(curve, "slope"), form="{:.4f}"),
            interval(value(curve, "slope_unbiased"), form="{:.4f}"),
            "{} to {}".format(*value(curve, "slope.spp")),
        ]
        for curve in run.curves
    ]
    return Table(
        "Slope of log RMSE against log samples per pixel, with 95 % intervals",
        ["curve", "slope", "slope without reference noise", "samples per pixel"],
        rows,
    )


def agreement_table(run):
    rows = []
    for curve in run.curves:
        agreement = value(curve, "agreement")
        rows.append(
            [
                label(curve),
                str(value(curve, "image_spp")),
                f"{value(agreement, 'rejected')} of {value(agreement, 'tests')}",
                str(agreement.get("unconfirmed", 0)),
                number(value(agreement, "largest_z"), 4),
                interval(value(agreement, "relative_difference"), 100, "{:+.4f}"),
                with_advice(
                    value(agreement, "equivalence"), lambda a=agreement: factor_of_agreement(a)
                ),
            ]
        )
    return Table(
        "Agreement with the reference",
        [
            "curve",
            "samples per pixel",
            "block tests that reject",
            "rejections not confirmed",
            "largest |z|",
            "difference of the mean, % [99 %]",
            "mean within 0.1 %",
        ],
        rows,
    )


def cost_table(run):
    """Times that the curves do not include: compilation and BVH construction."""
    rows = [
        [
            label(curve),
            number(value(curve, "compile_seconds"), 4),
            number(value(curve, "bvh_seconds"), 4),
        ]
        for curve in run.curves
    ]
    return Table(
        "Times that the curves do not include",
        ["curve", "kernels compiled or loaded, with the first enqueue, s", "BVH construction, s"],
        rows,
    )


def efficiency_table(run):
    """Every curve against path tracing: samples for the same error, error in the same time."""
    noise = run.get("reference.noise_floor.mse")
    base = base_curve(run)
    rows = []
    for curve in run.curves:
        cost = Cost(curve, noise)
        gains = (
            [BASELINE] * 2
            if curve is base
            else [interval(gain(base, curve, noise, key), digits=4) for key in ("spp", "seconds")]
        )
        rows.append(
            [
                label(curve),
                str(cost.spp),
                number(cost.mse.mean()),
                number(cost.seconds, 4),
                number(cost.pilot_seconds),
                *gains,
            ]
        )
    return Table(
        f"Efficiency over {label(base)}, with 95 % intervals over seeds",
        [
            "curve",
            "samples per pixel",
            "MSE minus reference noise",
            "device time without pilot, s",
            "pilot, s",
            "gain in equal samples, times",
            "gain in equal device time, times",
        ],
        rows,
        [
            f"Gain in equal samples: how many times the samples {label(base)} needs for the same"
            " error. Gain in equal device time: how many times smaller the MSE is in the same"
            " time. Light that an algorithm misses counts as error."
        ],
    )


# Statements of the thesis about memory (section 2.8); full BDPT: its figure from the literature.
THESIS_MEMORY = {
    "truncated_bdpt": "path tracing and one scalar",
    "bdpt": "3.5 KB, 16 vertices from either end",
}


def memory_table(run):
    """Bytes for every path in flight, queues included."""
    rows = []
    for curve in run.curves:
        report = value(curve, "render_report")
        rows.append(
            [
                label(curve),
                str(value(report, "bytes_per_path")),
                str(value(report, "light_vertex_bytes_per_path")),
                THESIS_MEMORY.get(value(curve, "algorithm"), NONE),
            ]
        )
    return Table(
        "Memory of a path in flight, whatever its length",
        ["curve", "bytes per path", "bytes of light vertices", "thesis"],
        rows,
    )


def throughput_table(run):
    """Renderer against reference, or the reason why the measurement was refused."""
    throughput = run.get("throughput")
    columns = ["curve", "renderer, Msamples/s", "reference, Msamples/s", "renderer / reference"]
    named = next(
        (label(curve) for curve in run.curves if value(curve, "id") == value(throughput, "curve")),
        value(throughput, "curve"),
    )
    if not value(throughput, "accepted"):
        return Table(
            "Samples per second of renderer and reference, interleaved repetitions",
            columns,
            [[named, *[NONE] * 3]],
            [f"Refused: {value(throughput, 'reason')}."],
        )
    cells = [
        interval(value(throughput, f"{side}_samples_per_second"), 1e-6, digits=4)
        for side in ("renderer", "reference")
    ]
    return Table(
        "Samples per second of renderer and reference, interleaved repetitions",
        columns,
        [[named, *cells, interval(value(throughput, "ratio"), digits=4)]],
    )


def edges_document(run):
    """Returns where the error is, by curve: measured from the images if they are here, else as
    kept in edges.json.

    The figures outlive the images, which a clone does not have.
    """
    path = run.folder / "edges.json"
    if not run.has_images():
        return json.loads(path.read_text()) if path.is_file() else {}
    found = {value(curve, "id"): edge_errors(run, curve) for curve in shown_curves(run)}
    document = {name: ratio for name, ratio in found.items() if ratio}
    write_text(path, json.dumps(document, indent=1) + "\n")
    return document


def edges_table(run):
    """Where the error is: at edges of the image or elsewhere."""
    document = edges_document(run)
    rows = [
        [label(curve), interval(document[value(curve, "id")], digits=4)]
        for curve in run.curves
        if value(curve, "id") in document
    ]
    return Table(
        "Mean squared error at edges of the image over that elsewhere, 95 % interval",
        ["curve", "ratio"],
        rows,
    )


def repetitions_table(run):
    """Every raw measurement, one row each, with all digits; times include the pilot."""
    keys = ("l2", "rmse", "mae", "relmse", "mse")
    rows = []
    for curve in run.curves:
        for point in value(curve, "points"):
            for repetition in value(point, "repetitions"):
                rows.append(
                    [value(curve, "id"), str(value(point, "spp")), str(value(repetition, "seed"))]
                    + [repr(seconds(curve, repetition, clock)) for clock in ("device", "wall")]
                    + [repr(value(repetition, key)) for key in keys]
                )
    return Table(
        "All repetitions", ["curve", "spp", "seed", "seconds_device", "seconds_wall", *keys], rows
    )


TABLES = {
    "efficiency": efficiency_table,
    "errors": errors_table,
    "slopes": slopes_table,
    "agreement": agreement_table,
    "throughput": throughput_table,
    "memory": memory_table,
    "edges": edges_table,
    "cost": cost_table,
}


def write_tables(run, folder):
    """Writes all tables as CSV, Markdown and LaTeX and the raw repetitions as CSV; returns the
    tables by name."""
    folder.mkdir(parents=True, exist_ok=True)
    tables = {name: make(run) for name, make in TABLES.items()}
    for name, table in tables.items():
        table.write(folder, name)
    write_text(folder / "repetitions.csv", repetitions_table(run).csv())
    return tables
