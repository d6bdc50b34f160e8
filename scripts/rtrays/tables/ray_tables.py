# SPDX-License-Identifier: MIT
"""Tables and finding of rays through the hierarchy."""

import numpy

from rtrays.documents.document import value
from rtrays.documents.measurements import (
    KINDS,
    contestant_of,
    fastest_layout,
    our_layouts,
    ray_mean,
    theirs,
)
from rtrays.tables.cells import interval, number, ratio
from rtrays.tables.table import Table
from rtrays.tables.text import GIVING_UP, mesh_name, mesh_note, name

CACHED = 4e6  # bytes that fit the second-level caches of two or more cores
FEWEST_FOR_COSTS = 8  # meshes x kinds; three coefficients are fitted


def costs_table(run, layouts):
    """Returns the cost of a node and of a triangle: processor ns per ray = a + b nodes + c
    triangles, by relative least squares. Without enough measurements there is no table."""
    rows = []
    for layout, cached in [(layout, cached) for layout in layouts for cached in (True, False)]:
        entries = [
            contestant_of(kind, layout) for row in run.get("rows") for kind in value(row, "kinds")
        ]
        entries = [entry for entry in entries if (value(entry, "bytes") <= CACHED) == cached]
        if len(entries) < FEWEST_FOR_COSTS:
            continue
        ns = numpy.array([value(c, "processor_ns.value") for c in entries])
        work = numpy.array(
            [[1, value(c, "nodes_per_ray"), value(c, "triangles_per_ray")] for c in entries]
        )
        fit, *_ = numpy.linalg.lstsq(work / ns[:, None], numpy.ones(len(ns)), rcond=None)
        off = numpy.abs(work @ fit / ns - 1)
        rows.append(
            [
                name(layout),
                f"{'up to' if cached else 'above'} {1e-6 * CACHED:g} MB",
                f"{len(entries)}",
                *(f"{x:.1f}" for x in fit),
                f"{100 * numpy.median(off):.0f}",
                f"{100 * off.max():.0f}",
            ]
        )
    return rows and Table(
        "Cost model: processor ns per ray = a + b · nodes + c · triangles",
        [
            "layout",
            "size of the hierarchy",
            "meshes × kinds",
            "a, ns",
            "b, ns per node",
            "c, ns per triangle",
            "median residual, %",
            "largest residual, %",
        ],
        rows,
    )


def ray_groups(run):
    """Yields the cells that begin a row, the measurement, and {name: contestant} of every mesh and
    kind of ray."""
    for row in run.get("rows"):
        for kind in value(row, "kinds"):
            head = [mesh_name(run, row["mesh"]), name(kind["kind"])]
            yield head, kind, {c["name"]: c for c in value(kind, "contestants")}


def means_table(run, layouts):
    """Returns the geometric means of the speeds over Embree by kind of ray."""
    columns = [*layouts, "stackless_over_stack"]
    rows = [[name(kind), *(f"{ray_mean(run, kind, c):.2f}" for c in columns)] for kind in KINDS]
    return Table(
        "Geometric means of the speeds over Embree, ray by ray", ["rays", *map(name, columns)], rows
    )


EMBREE = (
    "Embree traces with ROBUST and the instruction set that is fastest on these rays. Embree 1 is"
    " rtcIntersect1, or rtcOccluded1 for shadow and ambient occlusion rays. Embree 16 is"
    " rtcIntersect16 or rtcOccluded16, which knows which rays are coherent."
)


def speeds_table(run, layouts):
    """Returns the speeds over Embree by mesh and kind of ray."""
    rows = [
        head
        + [ratio(value(contestants[c], "speed_over_embree")) for c in layouts]
        + [
            ratio(value(theirs(kind)[1], "speed_over_embree")),
            interval(value(kind, "stackless_over_stack")),
            f"{100 * value(kind, 'foreign_load'):.0f}",
        ]
        for head, kind, contestants in ray_groups(run)
    ]
    heads = [*map(name, layouts), "Embree 16", "stackless over stack", "foreign load, %"]
    return Table(
        "Speed over Embree, ray by ray, by mesh",
        ["mesh", "rays", *heads],
        rows,
        [
            f"Ratios of {run.clock} times. All trace the same rays in the same order, with as many"
            f" threads as the device has compute units. {EMBREE} {GIVING_UP}",
            mesh_note(run),
        ],
    )


def rates_table(run, layouts):
    """Returns the rays per second by mesh and kind of ray."""
    rows = []
    for head, kind, contestants in ray_groups(run):
        row = head + [number(value(contestants[c], "Mrays_s.value")) for c in layouts]
        for c in theirs(kind):
            row += [number(value(c, "Mrays_s.value")), c["isa"]]
        rows.append(row)
    heads = [*map(name, layouts), "Embree 1", "Embree 1 uses", "Embree 16", "Embree 16 uses"]
    return Table("Rays per second on the wall, Mrays/s", ["mesh", "rays", *heads], rows)


def work_table(run, layouts):
    """Returns the work and the time of a ray by mesh and kind of ray."""
    rows = []
    for head, _, contestants in ray_groups(run):
        row = list(head)
        for c in map(contestants.get, layouts):
            row += [
                f"{value(c, 'nodes_per_ray'):.1f}",
                f"{value(c, 'triangles_per_ray'):.1f}",
                number(value(c, "processor_ns.value")),
                f"{1e-6 * value(c, 'bytes'):.3g}",
            ]
        rows.append(row)
    figures = ("nodes per ray", "triangles per ray", "processor ns per ray", "MB")
    heads = [f"{name(c)}: {figure}" for c in layouts for figure in figures]
    return Table("Work of a ray", ["mesh", "rays", *heads], rows)


def ray_rates(run):
    """Returns the finding and the tables of rays per second."""
    layouts, best = our_layouts(run), fastest_layout(run)
    makers = (means_table, speeds_table, rates_table, work_table, costs_table)
    tables = [make(run, layouts) for make in makers]
    speeds = ", ".join(f"{ray_mean(run, kind, best):.2f} ({name(kind)})" for kind in KINDS)
    finding = (
        f"The layout {name(best)} traces rays {speeds} times as fast as Embree ray by ray,"
        f" geometric means over {len(run.get('rows'))} meshes."
    )
    return finding, [table for table in tables if table]
