# SPDX-License-Identifier: MIT
"""Tables and findings of the hierarchy: building it, and rays through it."""

from cells import NONE, Table, interval, number, ratio
from measurement_text import (
    GIVING_UP,
    builder,
    geometric_mean,
    mesh_name,
    mesh_note,
    name,
    reported,
    span,
)
from run_document import value

KINDS = ("primary", "shadow", "ambient_occlusion", "diffuse")


def published_table(run):
    """Table 4.1 with our columns: the default layout of every builder, and Embree."""
    columns = run.get("experiment.published.columns")
    published = {row["mesh"]: row for row in run.get("experiment.published.rows")}
    stand_ins = run.get("stand_ins")
    shown = [
        c["name"]
        for c in value(run.get("rows")[0], "contestants")
        if c["side"] == "embree" or c["name"].endswith("wide8")
    ]
    rows = []
    for row in run.get("rows"):
        printed = published.get(stand_ins.get(row["mesh"], row["mesh"]))
        contestants = {c["name"]: c for c in value(row, "contestants")}
        cells = [printed["scene"], printed["triangles"]] if printed else [NONE, NONE]
        cells += [
            number(printed["ms"][c["key"]]) if printed and c["key"] in printed["ms"] else NONE
            for c in columns
        ]
        cells += [mesh_name(run, row["mesh"]), f"{value(row, 'triangles')}"]
        cells += [
            number(value(contestants[c], f"{clock}_ms.value"))
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


def build_rows(run):
    for row in run.get("rows"):
        triangles, sweep = value(row, "triangles"), value(row, "full_sweep_sah")
        for c in value(row, "contestants"):
            wall = value(c, "wall_ms.value")
            yield [
                mesh_name(run, row["mesh"]),
                f"{triangles}",
                builder(c),
                ratio(value(c, "speed_over_embree")),
                interval(value(c, "wall_ms")),
                number(value(c, "processor_ms.value")),
                f"{1e-3 * triangles / wall:.2f}",
                f"{1e-3 * triangles / value(c, 'processor_ms.value'):.2f}",
                reported(c, "sah", "{:.2f}"),
                f"{c['sah'] / sweep:.3f}" if "sah" in c else NONE,
                reported(c, "nodes_per_ray", "{:.1f}"),
                reported(c, "triangles_per_ray", "{:.1f}"),
                f"{value(c, 'bytes') / triangles:.0f}",
                f"{value(c, 'bytes_peak') / triangles:.0f}",
                f"{1e-6 * value(c, 'bytes_peak'):.1f}",
                f"{value(row, 'turns')}",
                f"{100 * value(row, 'foreign_load'):.0f}",
            ]


def build_speeds(run, contestant):
    """(row, speed over Embree's medium quality) of every mesh that has the contestant."""
    return [
        (row, value(c, "speed_over_embree"))
        for row in run.get("rows")
        for c in value(row, "contestants")
        if c["name"] == contestant
    ]


def our_builders(run):
    """The builders of the default layout, or all of ours where none has it."""
    ours = [c["name"] for c in value(run.get("rows")[0], "contestants") if c["side"] == "ours"]
    return [c for c in ours if c.endswith("wide8")] or ours


def bvh_build(run):
    full = Table(
        "Every builder and layout",
        [
            "mesh",
            "triangles",
            "builder",
            "speed over Embree medium",
            "wall time, ms",
            "processor time, ms",
            "Mtris per wall second",
            "Mtris per processor second",
            "SAH cost",
            "SAH cost over full sweep",
            "nodes per ray",
            "triangles per ray",
            "bytes per triangle",
            "peak bytes per triangle",
            "peak, MB",
            "repetitions",
            "foreign load, %",
        ],
        list(build_rows(run)),
        [
            (
                f"Speed is the ratio of {run.clock} times, repetition by repetition. Processor time"
                " sums all threads of the host. Embree builds with low, medium and high quality,"
                " without ROBUST. SAH cost has K_T = K_I = 1 and is that of the two-wide tree"
                " below every layout. Nodes and triangles per ray are those of diffuse rays. Peak"
                f" memory includes vertices, indices and the result. {GIVING_UP}"
            ),
            mesh_note(run),
        ],
    )
    exponents = Table(
        f"Growth: {run.clock} time = c · triangles^k",
        ["builder", "exponent k"],
        [[name(c), interval(k)] for c, k in run.get("summary.exponents").items()],
        ["Least squares on logarithms; 95 % intervals over the meshes."],
    )
    texts = [
        f"{name(c)} {geometric_mean([value(s, 'value') for _, s in build_speeds(run, c)]):.2f} "
        f"({span([value(s, 'value') for _, s in build_speeds(run, c)])})"
        for c in our_builders(run)
    ]
    finding = (
        "Speed of building over Embree's medium quality, geometric means over"
        f" {len(run.get('rows'))} meshes (and range): {', '.join(texts)}."
    )
    return finding, (full, published_table(run), exponents, stages(run))


def stages(run):
    """Device time of one build of the largest mesh, by stage."""
    row = max(run.get("rows"), key=lambda row: value(row, "triangles"))
    rows = []
    for c in value(row, "contestants"):
        if c["side"] == "ours":
            together = sum(stage["ms"] for stage in value(c, "stages").values())
            rows += [
                [
                    name(c["name"]),
                    name(stage),
                    f"{100 * entry['ms'] / together:.1f}",
                    number(entry["ms"]),
                    f"{entry['launches']}",
                ]
                for stage, entry in sorted(
                    value(c, "stages").items(), key=lambda item: -item[1]["ms"]
                )
                if entry["ms"] > 0.01 * together
            ]
    return Table(
        f"Stages of one build of {name(row['mesh'])}",
        ["builder", "stage", "share of device time, %", "ms", "launches"],
        rows,
        ["Stages of more than 1 % of the device time."],
    )


CACHED = 4e6  # bytes that fit the second-level caches of two or more cores
FEWEST_FOR_COSTS = 8  # meshes x kinds; three coefficients are fitted


def costs(run, ours):
    """Cost of a node and of a triangle: processor ns per ray = a + b nodes + c triangles, by
    relative least squares."""
    import numpy

    rows = []
    for layout, cached in [(layout, cached) for layout in ours for cached in (True, False)]:
        entries = [
            next(c for c in value(kind, "contestants") if c["name"] == layout)
            for row in run.get("rows")
            for kind in value(row, "kinds")
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


def ray_speeds(run, kind, contestant):
    """(row, speed over Embree, ray by ray) of every mesh for a kind of ray."""
    return [
        (row, value(c, "speed_over_embree"))
        for row in run.get("rows")
        for entry in value(row, "kinds")
        if entry["kind"] == kind
        for c in value(entry, "contestants")
        if c["name"] == contestant
    ]


def fastest_layout(run):
    """Our layout with the largest geometric mean of speeds over all kinds of rays."""
    means = run.get("summary.geometric_means")
    ours = [
        c["name"] for c in value(run.get("rows")[0], "kinds.0.contestants") if c["side"] == "ours"
    ]
    return max(
        ours,
        key=lambda layout: geometric_mean([value(means, f"{kind}.{layout}") for kind in KINDS]),
    )


def ray_rates(run):
    first = value(run.get("rows")[0], "kinds")[0]
    ours = [c["name"] for c in value(first, "contestants") if c["side"] == "ours"]
    rates, speeds, work = [], [], []
    for row in run.get("rows"):
        for kind in value(row, "kinds"):
            contestants = {c["name"]: c for c in value(kind, "contestants")}
            theirs = [c for c in value(kind, "contestants") if c["side"] == "embree"]
            head = [mesh_name(run, row["mesh"]), name(kind["kind"])]
            speeds.append(
                head
                + [ratio(value(contestants[c], "speed_over_embree")) for c in ours]
                + [
                    ratio(value(theirs[1], "speed_over_embree")),
                    interval(value(kind, "stackless_over_stack")),
                    f"{100 * value(kind, 'foreign_load'):.0f}",
                ]
            )
            rates.append(
                head
                + [number(value(contestants[c], "Mrays_s.value")) for c in ours]
                + [cell for c in theirs for cell in (number(value(c, "Mrays_s.value")), c["isa"])]
            )
            work.append(
                head
                + [
                    cell
                    for c in ours
                    for cell in (
                        f"{value(contestants[c], 'nodes_per_ray'):.1f}",
                        f"{value(contestants[c], 'triangles_per_ray'):.1f}",
                        number(value(contestants[c], "processor_ns.value")),
                        f"{1e-6 * value(contestants[c], 'bytes'):.3g}",
                    )
                ]
            )
    means = [
        [name(kind)]
        + [
            f"{value(run.get('summary.geometric_means'), f'{kind}.{c}'):.2f}"
            for c in [*ours, "stackless_over_stack"]
        ]
        for kind in KINDS
    ]
    embree = (
        "Embree traces with ROBUST and the instruction set that is fastest on these rays. Embree 1"
        " is rtcIntersect1, or rtcOccluded1 for shadow and ambient occlusion rays. Embree 16 is"
        " rtcIntersect16 or rtcOccluded16, which knows which rays are coherent."
    )
    tables = (
        Table(
            "Geometric means of the speeds over Embree, ray by ray",
            ["rays", *map(name, ours), "stackless over stack"],
            means,
        ),
        Table(
            "Speed over Embree, ray by ray, by mesh",
            [
                "mesh",
                "rays",
                *map(name, ours),
                "Embree 16",
                "stackless over stack",
                "foreign load, %",
            ],
            speeds,
            [
                (
                    f"Ratios of {run.clock} times. All trace the same rays in the same order, with"
                    f" as many threads as the device has compute units. {embree} {GIVING_UP}"
                ),
                mesh_note(run),
            ],
        ),
        Table(
            "Rays per second on the wall, Mrays/s",
            [
                "mesh",
                "rays",
                *map(name, ours),
                "Embree 1",
                "Embree 1 uses",
                "Embree 16",
                "Embree 16 uses",
            ],
            rates,
        ),
        Table(
            "Work of a ray",
            [
                "mesh",
                "rays",
                *(
                    f"{name(c)}: {what}"
                    for c in ours
                    for what in ("nodes per ray", "triangles per ray", "processor ns per ray", "MB")
                ),
            ],
            work,
        ),
        *filter(None, [costs(run, ours)]),
    )
    best = fastest_layout(run)
    figures = [
        f"{value(run.get('summary.geometric_means'), f'{kind}.{best}'):.2f} ({name(kind)})"
        for kind in KINDS
    ]
    finding = (
        f"The layout {name(best)} traces rays {', '.join(figures)} times as fast as Embree ray by"
        f" ray, geometric means over {len(run.get('rows'))} meshes."
    )
    return finding, tables


HIERARCHY_TABLES = {"bvh_build": bvh_build, "ray_rates": ray_rates}
