# SPDX-License-Identifier: MIT
"""Tables of a run of curves."""

from rtrays.documents.curves import (
    clock_of,
    has_pilot,
    label,
    lacks_wall_time_of_pilot,
    own_curves,
    seconds,
)
from rtrays.documents.document import value, write_text
from rtrays.documents.undecided import factor_of_agreement, with_advice
from rtrays.tables.cells import interval, number
from rtrays.tables.efficiency_tables import (
    edges_table,
    efficiency_table,
    memory_table,
    throughput_table,
)
from rtrays.tables.error_tables import gains_table, parts_table, settings_table
from rtrays.tables.table import Table

POINT_METRICS = ("l2", "rmse", "mae", "relmse", "mse", "mse_unbiased")
PILOT_NOTE = "Both times include the pilot that chooses the number of light paths."
PILOT_NOTE_WITHOUT_WALL_TIME = (
    "Both times include the pilot that chooses the number of light paths; run.json has no wall time"
    " of it, so that its device time is added to the wall time."
)

OTHER_NOTE = (
    "The times of another renderer are those that it reports for its render call, or those of its"
    " process; both columns have them."
)


def pilot_note(run):
    """Returns the note on times of curves with a pilot; empty without one."""
    if any(lacks_wall_time_of_pilot(curve) for curve in run.curves):
        return PILOT_NOTE_WITHOUT_WALL_TIME
    return PILOT_NOTE if any(map(has_pilot, run.curves)) else ""


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
        [pilot_note(run), OTHER_NOTE if clock_of(run) == "wall" else ""],
    )


def slopes_table(run):
    """Returns the slopes of all curves, with and without the noise of the reference."""
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
    """Returns the agreement of all curves with the reference."""
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
        for curve in own_curves(run)
    ]
    return Table(
        "Times that the curves do not include",
        ["curve", "kernels compiled or loaded, with the first enqueue, s", "BVH construction, s"],
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
    "error_parts": parts_table,
    "gains_by_part": gains_table,
    "errors": errors_table,
    "slopes": slopes_table,
    "agreement": agreement_table,
    "throughput": throughput_table,
    "memory": memory_table,
    "edges": edges_table,
    "cost": cost_table,
    "settings": settings_table,
}


def write_tables(run):
    """Writes all tables as CSV, Markdown and LaTeX and the raw repetitions as CSV into the run's
    folder "tables"; returns the tables by name."""
    folder = run.folder / "tables"
    folder.mkdir(parents=True, exist_ok=True)
    made = ((name, make(run)) for name, make in TABLES.items())
    tables = {name: table for name, table in made if table is not None}
    for name, table in tables.items():
        table.write(folder, name)
    write_text(folder / "repetitions.csv", repetitions_table(run).csv())
    return tables
