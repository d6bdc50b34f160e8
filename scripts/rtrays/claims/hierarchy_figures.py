# SPDX-License-Identifier: MIT
"""Figures of claims from measurements of the hierarchy."""

import numpy

from rtrays.documents.document import value
from rtrays.documents.intervals import exact, inverse, scaled
from rtrays.documents.measurements import contestant_of
from rtrays.documents.run_document import Run
from rtrays.tables.text import name


def published_order(folder, contestant):
    """Spearman's correlation of our build times with those of the thesis, over the meshes that
    replace its scenes."""
    run = Run(folder)
    published = {row["mesh"]: row["ms"]["thesis"] for row in run.get("experiment.published.rows")}
    named = run.get("stand_ins")
    pairs = [
        (
            published[named.get(row["mesh"], row["mesh"])],
            value(contestant_of(row, contestant), "processor_ms.value"),
        )
        for row in run.get("rows")
        if named.get(row["mesh"], row["mesh"]) in published
    ]
    if len(pairs) > 2:
        ranks = numpy.argsort(numpy.argsort(numpy.array(pairs), axis=0), axis=0)
        yield f"rank correlation over {len(pairs)} meshes", exact(
            float(numpy.corrcoef(ranks.T)[0, 1])
        )


def build_rate(folder, contestant):
    """Million triangles per second of wall time, the largest of all meshes."""
    rows = [
        (
            row["mesh"],
            1e-3 * value(row, "triangles"),
            inverse(value(contestant_of(row, contestant), "wall_ms")),
        )
        for row in Run(folder).get("rows")
    ]
    mesh, scale, rate = max(rows, key=lambda row: row[1] * row[2]["value"])
    yield f"{name(mesh)}, Mtris/s", scaled(scale, rate)


def build_gain(folder, contestant):
    """Speed over Embree's builder of medium quality, the largest of all meshes."""
    mesh, speed = max(
        (
            (row["mesh"], value(contestant_of(row, contestant), "speed_over_embree"))
            for row in Run(folder).get("rows")
        ),
        key=lambda entry: value(entry[1], "value"),
    )
    yield f"{name(mesh)}, over Embree", speed


def leaks(folder):
    """Number of rays from inside closed shapes that hit nothing, worst layout, for shapes that
    must be closed exactly."""
    for row in Run(folder).get("rows"):
        if row["check"] != "hits" and all(
            value(layout, "limit") == 0 for layout in value(row, "layouts")
        ):
            yield f"{row['mesh']}, {value(row, 'rays'):.3g} rays", exact(
                max(value(layout, "misses") for layout in row["layouts"])
            )
