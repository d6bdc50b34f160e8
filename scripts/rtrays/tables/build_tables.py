# SPDX-License-Identifier: MIT
"""Tables and finding of building the hierarchy."""

from rtrays.documents.document import value
from rtrays.documents.intervals import geometric_mean
from rtrays.documents.measurements import (
    build_speeds,
    contestant_of,
    our_builders,
    ours,
    published_rows,
)
from rtrays.tables.cells import NONE, interval, number, ratio
from rtrays.tables.table import Table
from rtrays.tables.text import GIVING_UP, builder, mesh_name, mesh_note, name, reported, span


def published_table(run):
    """Returns table 4.1 with our columns: the default layout of every builder, and Embree."""
    columns = run.get("experiment.published.columns")
    shown = [
        c["name"]
        for c in value(run.get("rows")[0], "contestants")
        if c["side"] == "embree" or c["name"].endswith("wide8")
    ]
    rows = []
    for row, printed in published_rows(run):
        cells = [printed["scene"], printed["triangles"]] if printed else [NONE, NONE]
        cells += [
            number(printed["ms"][c["key"]]) if printed and c["key"] in printed["ms"] else NONE
            for c in columns
        ]
        cells += [mesh_name(run, row["mesh"]), f"{value(row, 'triangles')}"]
        cells += [
            number(value(contestant_of(row, c), f"{clock}_ms.value"))
            for c in shown
            for clock in ("wall", "processor")
        ]
        rows.append(cells)
    heads = [
        "published scene",
        "triangles",
        *(f"{c['title']}, ms" for c in columns),
        "measured here",
        "triangles",
        *(f"{name(c)}, {clock} ms" for c in shown for clock in ("wall", "processor")),
    ]
    hardware = "; ".join(f"{c['title']}: {c['hardware']}" for c in columns)
    return Table(
        "Published build times, and ours",
        heads,
        rows,
        [f"Published: {run.get('experiment.published.source')}; {hardware}.", mesh_note(run)],
    )


def mtris(entry, clock):
    """Returns the million triangles per second of a builder on a mesh."""
    row, c = entry
    return f"{1e-3 * value(row, 'triangles') / value(c, f'{clock}_ms.value'):.2f}"


def per_triangle(entry, key):
    """Returns the bytes per triangle of a builder on a mesh."""
    row, c = entry
    return f"{value(c, key) / value(row, 'triangles'):.0f}"


def sah_over_sweep(entry):
    """Returns the SAH cost of a builder over that of a full sweep."""
    row, c = entry
    return f"{c['sah'] / value(row, 'full_sweep_sah'):.3f}" if "sah" in c else NONE


def builders_table(run):
    """Returns every builder on every mesh."""
    columns = [
        ("mesh", lambda e: mesh_name(run, e[0]["mesh"])),
        ("triangles", lambda e: f"{value(e[0], 'triangles')}"),
        ("builder", lambda e: builder(e[1])),
        ("speed over Embree medium", lambda e: ratio(value(e[1], "speed_over_embree"))),
        ("wall time, ms", lambda e: interval(value(e[1], "wall_ms"))),
        ("processor time, ms", lambda e: number(value(e[1], "processor_ms.value"))),
        ("Mtris per wall second", lambda e: mtris(e, "wall")),
        ("Mtris per processor second", lambda e: mtris(e, "processor")),
        ("SAH cost", lambda e: reported(e[1], "sah", "{:.2f}")),
        ("SAH cost over full sweep", sah_over_sweep),
        ("nodes per ray", lambda e: reported(e[1], "nodes_per_ray", "{:.1f}")),
        ("triangles per ray", lambda e: reported(e[1], "triangles_per_ray", "{:.1f}")),
        ("bytes per triangle", lambda e: per_triangle(e, "bytes")),
        ("peak bytes per triangle", lambda e: per_triangle(e, "bytes_peak")),
        ("peak, MB", lambda e: f"{1e-6 * value(e[1], 'bytes_peak'):.1f}"),
        ("repetitions", lambda e: f"{value(e[0], 'turns')}"),
        ("foreign load, %", lambda e: f"{100 * value(e[0], 'foreign_load'):.0f}"),
    ]
    note = (
        f"Speed is the ratio of {run.clock} times, repetition by repetition. Processor time sums"
        " all threads of the host. Embree builds with low, medium and high quality, without ROBUST."
        " SAH cost has K_T = K_I = 1 and is that of the two-wide tree below every layout. Nodes and"
        " triangles per ray are those of diffuse rays. Peak memory includes vertices, indices and"
        f" the result. {GIVING_UP}"
    )
    entries = [(row, c) for row in run.get("rows") for c in value(row, "contestants")]
    return Table.of("Every builder and layout", columns, entries, [note, mesh_note(run)])


def exponents_table(run):
    """Returns the exponents of the power laws of build times."""
    return Table(
        f"Growth: {run.clock} time = c · triangles^k",
        ["builder", "exponent k"],
        [[name(c), interval(k)] for c, k in run.get("summary.exponents").items()],
        ["Least squares on logarithms; 95 % intervals over the meshes."],
    )


def stages_table(run):
    """Returns the device time of one build of the largest mesh, by stage."""
    row = max(run.get("rows"), key=lambda row: value(row, "triangles"))
    rows = []
    for c in ours(value(row, "contestants")):
        stages = value(c, "stages")
        together = sum(stage["ms"] for stage in stages.values())
        rows += [
            [
                name(c["name"]),
                name(stage),
                f"{100 * entry['ms'] / together:.1f}",
                number(entry["ms"]),
                f"{entry['launches']}",
            ]
            for stage, entry in sorted(stages.items(), key=lambda item: -item[1]["ms"])
            if entry["ms"] > 0.01 * together
        ]
    return Table(
        f"Stages of one build of {name(row['mesh'])}",
        ["builder", "stage", "share of device time, %", "ms", "launches"],
        rows,
        ["Stages of more than 1 % of the device time."],
    )


def bvh_build(run):
    """Returns the finding and the tables of building the hierarchy."""
    texts = []
    for c in our_builders(run):
        speeds = [value(speed, "value") for _, speed in build_speeds(run, c)]
        texts.append(f"{name(c)} {geometric_mean(speeds):.2f} ({span(speeds)})")
    finding = (
        "Speed of building over Embree's medium quality, geometric means over"
        f" {len(run.get('rows'))} meshes (and range): {', '.join(texts)}."
    )
    makers = (builders_table, published_table, exponents_table, stages_table)
    return finding, [make(run) for make in makers]
