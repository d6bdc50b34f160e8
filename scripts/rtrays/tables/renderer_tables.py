# SPDX-License-Identifier: MIT
"""Tables and finding of this renderer beside others: errors and times of images."""

from rtrays.documents.document import value
from rtrays.documents.renderers import (
    best_of,
    contestants_of,
    error_times_seconds,
    gain_in_time,
    name_of,
    of_turns,
    seconds,
)
from rtrays.tables.cells import NONE, interval
from rtrays.tables.table import Table
from rtrays.tables.text import absent_note, name, samples_of, size_of


def best_table(run):
    """Returns the best contestants of both sides by scene, and the gain of ours."""
    rows = []
    for row in run.get("rows"):
        own, other = best_of(run, row, True), best_of(run, row, False)
        gain = interval(gain_in_time(run, own, other), form="{:.2f}") if other else NONE
        rows.append([name(row["scene"]), name_of(own), name_of(other) if other else NONE, gain])
    note = (
        f"{size_of(run)}, {samples_of(run)}. The best contestant has the least MSE times duration."
        " Durations include pilots, and exclude compilation and the construction of hierarchies."
    )
    return Table(
        f"MSE of the best of the other renderers over ours, in equal {run.clock} time",
        ["scene", "our best", "best of the others", "gain"],
        rows,
        [note, absent_note(run)],
    )


def speeds_table(run):
    """Returns the samples per second of path tracing over those of every other renderer."""
    others = [c["name"] for c in contestants_of(run.get("rows")[0], False)]
    rows = []
    for row in run.get("rows"):
        own = contestants_of(row, True)[0]
        by_name = {c["name"]: c for c in contestants_of(row, False)}
        ratios = [seconds(run, by_name[other]) / seconds(run, own) for other in others]
        rows.append([name(row["scene"]), *(f"{ratio:.2f}" for ratio in ratios)])
    return Table(
        f"Samples per second of our path tracing over the others, by {run.clock} time",
        ["scene", *others],
        rows,
        [
            "Ours has independent samples, MIS, and roulette from the first event. Roulette from"
            " event 1 makes paths of about the same length."
        ],
    )


def contestants_table(run):
    """Returns errors and speeds of all contestants."""
    rows = [
        [
            name(row["scene"]),
            name_of(contestant),
            interval(value(contestant, "Msamples_s")),
            f"{of_turns(contestant, 'mse').mean():.3g}",
            f"{error_times_seconds(run, contestant):.3g}",
            f"{100 * value(row, 'foreign_load'):.0f}",
        ]
        for row in run.get("rows")
        for contestant in value(row, "contestants")
    ]
    heads = ["Msamples/s on the wall", "MSE", f"MSE x {run.clock} seconds", "foreign load, %"]
    return Table(
        "All contestants",
        ["scene", "contestant", *heads],
        rows,
        [
            "The MSE is that against the stored Embree reference, less its noise. Other renderers"
            " are processes of their own, which count as foreign load."
        ],
    )


def renderers(run):
    """Returns the finding and the tables of this renderer beside others."""
    tables = [contestants_table(run)]
    pairs = [(best_of(run, row, True), best_of(run, row, False)) for row in run.get("rows")]
    if any(other is None for _, other in pairs):
        return "No other renderer is installed.", tables
    gains = [gain_in_time(run, own, other) for own, other in pairs]
    ahead, behind = (sum(test(gain) for gain in gains) for test in (
        lambda gain: gain["low"] > 1, lambda gain: gain["high"] < 1))
    values = ", ".join(
        f"{gain['value']:.2f} ({name(row['scene'])})" for gain, row in zip(gains, run.get("rows"))
    )
    finding = (
        f"In equal time our best settings have less error than the best of the other renderers on"
        f" {ahead} of {len(gains)} scenes, and more on {behind}; the MSE of the others over ours"
        f" is {values}."
    )
    return finding, [best_table(run), speeds_table(run), *tables]
