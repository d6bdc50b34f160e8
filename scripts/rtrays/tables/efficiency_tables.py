# SPDX-License-Identifier: MIT
"""Tables of a run of curves: what its samples cost and where its errors are."""

from rtrays.documents.curves import (
    base_curve,
    base_for,
    clock_of,
    has_several_bases,
    label,
    own_curves,
)
from rtrays.documents.document import value
from rtrays.documents.edges import edges_document
from rtrays.documents.efficiency import Cost, gain
from rtrays.tables.cells import BASELINE, NONE, interval, number
from rtrays.tables.table import Table


def gain_cells(run, base, curve):
    """Returns the gains of a curve over another one in equal samples and in equal time as text."""
    noise = run.get("reference.noise_floor.mse")
    gains = (gain(base, curve, noise, key, clock_of(run)) for key in ("spp", "seconds"))
    return [interval(each, digits=4) for each in gains]


def own_cells(run, curve):
    """Returns the base of a curve under its own settings and the gains over it as text; dashes if
    it is that of the run."""
    own = base_for(run, curve)
    if own is base_curve(run):
        return [NONE] * 3
    return [label(own), *gain_cells(run, own, curve)]


OWN_COLUMNS = (
    "path tracing under the same settings",
    "gain over it in equal samples, times",
    "gain over it in equal {clock} time, times",
)
OWN_NOTE = (
    "The last columns compare with path tracing that has the sampler, light selection and sphere"
    " sampling of the curve. The error of Sobol points falls faster than that of independent"
    " samples, so gains of one over the other grow with the samples."
)


def efficiency_table(run):
    """Every curve against path tracing: samples for the same error, error in the same time. A run
    with several settings of path tracing has both gains over the one with the curve's settings,
    too."""
    noise = run.get("reference.noise_floor.mse")
    base, several = base_curve(run), has_several_bases(run)
    rows = []
    for curve in run.curves:
        cost = Cost(curve, noise, clock=clock_of(run))
        rows.append(
            [
                label(curve),
                str(cost.spp),
                number(cost.mse.mean()),
                number(cost.seconds, 4),
                number(cost.pilot_seconds),
                *([BASELINE] * 2 if curve is base else gain_cells(run, base, curve)),
                *(own_cells(run, curve) if several else []),
            ]
        )
    return Table(
        f"Efficiency over {label(base)}, with 95 % intervals over seeds",
        [
            "curve",
            "samples per pixel",
            "MSE minus reference noise",
            f"{clock_of(run)} time with pilot, s",
            "pilot alone, s",
            "gain in equal samples, times",
            f"gain in equal {clock_of(run)} time, times",
            *(head.format(clock=clock_of(run)) for head in OWN_COLUMNS if several),
        ],
        rows,
        [
            f"Gain in equal samples: how many times the samples {label(base)} needs for the same"
            f" error. Gain in equal {clock_of(run)} time: how many times smaller the MSE is in the"
            " same time. The time of a pilot counts; it is the same for any number of samples, so a"
            " longer render gains more. Light that an algorithm misses counts as error.",
            *([OWN_NOTE] if several else []),
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
    for curve in own_curves(run):
        report = value(curve, "render_report")
        rows.append(
            [
                label(curve),
                str(value(report, "bytes_per_path")),
                str(value(report, "light_vertex_bytes_per_path")),
                THESIS_MEMORY.get(value(curve, "algorithm"), NONE),
            ]
        )
    columns = ["curve", "bytes per path", "bytes of light vertices", "thesis"]
    table = Table("Memory of a path in flight, whatever its length", columns, rows)
    return table if run.source else table.with_columns(columns[:-1])


def throughput_table(run):
    """Renderer against reference, or the reason why the measurement was refused; None if it was not
    measured."""
    if "throughput" not in run.document:
        return None
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
