# SPDX-License-Identifier: MIT
"""Tables and findings of the measurements of the hierarchy. A dash takes the place of a figure
that one side does not report."""

import re

from cells import NONE, Table, interval, number, ratio
from run_document import commit_of, value

KINDS = ("primary", "shadow", "ambient_occlusion", "diffuse")
PROCEDURAL = re.compile(r"(scattered|landscape|hall|court|city)_\d+")
MARK = " †"


def builder(entry):
    """Returns the name of a builder, and the builder that made the tree where the first one gave
    up (bvh/builder.h)."""
    gave_up = "method" in entry and not entry["name"].startswith(entry["method"])
    return name(entry["name"]) + (f", by {name(entry['method'])}" if gave_up else "")


GIVING_UP = (
    "If clustering makes a tree too deep, binned SAH builds it instead; its figures are then those"
    " of binned SAH."
)


def reported(entry, key, form="{:.3g}", scale=1.0):
    return form.format(scale * entry[key]) if key in entry else NONE


def name(text):
    return text.replace("_", " ")


def mesh_name(run, mesh):
    """Returns the name of a mesh; procedural ones have a mark, which mesh_note explains."""
    return name(mesh) + (MARK if PROCEDURAL.match(mesh) else "")


def mesh_note(run):
    """Returns the note below a table that says which meshes are procedural and which models they
    replace."""
    texts = []
    for mesh in dict.fromkeys(
        row["mesh"] for row in run.get("rows") if PROCEDURAL.match(row["mesh"])
    ):
        replaced = run.get("stand_ins").get(mesh)
        texts.append(
            f"{name(mesh)} (procedural)"
            + (f" replaces {name(replaced)}, which is missing" if replaced else "")
        )
    return f"†: {'; '.join(texts)}." if texts else ""


def span(values, form="{:.2f}"):
    """Returns "from A to B", or one number if both read the same."""
    low, high = form.format(min(values)), form.format(max(values))
    return low if low == high else f"{low} to {high}"


def geometric_mean(values):
    import numpy

    return float(numpy.exp(numpy.mean(numpy.log(values))))


def provenance(run):
    """Device, host, commit and load of a measurement, a line each."""
    context = run.get("context")
    units = "threads" if run.clock == "processor" else "compute units"
    load = ", ".join(f"{average:.1f}" for average in value(context, "load_average_start"))
    lines = [
        (
            f"commit {commit_of(context)},"
            f" profile {run.get('experiment.profile')}, {value(context, 'finished_at')}"
        ),
        (
            f"device: {value(context, 'device.name')},"
            f" {value(context, 'device.compute_units')} {units}"
        ),
        (
            f"host: {value(context, 'host.cpu')}, {value(context, 'host.cores')} cores;"
            f" {value(context, 'host.compiler')}"
        ),
        (
            f"load average at the start {load}; foreign processes used"
            f" {100 * value(context, 'cpu_use.foreign'):.0f} % of the processors"
        ),
    ]
    if run.get("absent"):
        lines.append(f"omitted because they are missing: {', '.join(map(name, run.get('absent')))}")
    return lines


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


def large(count):
    return f"{1e-6 * count:.0f} million" if count >= 1e6 else f"{count:.0f}"


def traversal(run):
    hits, closed = [], []
    for row in run.get("rows"):
        for layout in value(row, "layouts"):
            head = [
                name(row["mesh"]),
                f"{value(row, 'triangles')}",
                name(layout["name"]),
                f"{value(row, 'rays'):.3g}",
            ]
            verdict = "passed" if value(layout, "passed") else "FAILED"
            if row["check"] == "hits":
                hits.append(
                    head
                    + [
                        f"{value(row, 'hits')}",
                        *(
                            f"{value(layout, key)}"
                            for key in ("random", "grazing", "tied", "wrong")
                        ),
                        verdict,
                    ]
                )
            else:
                closed.append(
                    head + [f"{value(layout, 'misses')}", f"{value(layout, 'limit'):g}", verdict]
                )
    tables = (
        Table(
            "Rays from inside closed shapes that hit nothing",
            ["shape", "triangles", "layout", "rays", "misses", "allowed share", "check"],
            closed,
        ),
        Table(
            "Fuzzed rays: differences from Embree, and wrong hits",
            [
                "mesh",
                "triangles",
                "layout",
                "rays",
                "hits",
                "random",
                "grazing",
                "tied",
                "wrong",
                "check",
            ],
            hits,
            [
                "Rays are in equal parts random, grazing a triangle (1e-1 to 1e-5 of its plane),"
                " and along an axis through a vertex or the middle of an edge (tied: either side"
                " may answer). A difference is a hit against a miss, or more than 1e-5 of the"
                " scene's diagonal in distance from Embree (ROBUST). Brute force in double"
                " precision judges the differences; at most 1e-6 of the rays may be wrong."
            ],
        ),
    )
    checked = [row for row in run.get("rows") if row["check"] == "hits"]
    wrong = sum(value(layout, "wrong") for row in checked for layout in row["layouts"])
    rays = sum(value(row, "rays") * len(row["layouts"]) for row in checked)
    shapes = [row for row in run.get("rows") if row["check"] != "hits"]
    leaving = sum(value(layout, "misses") for row in shapes for layout in row["layouts"])
    from_inside = sum(value(row, "rays") * len(row["layouts"]) for row in shapes)
    finding = (
        f"Of {large(rays)} fuzzed rays on {len(checked)} meshes {wrong or 'none'} have a wrong hit"
    )
    if shapes:
        finding += (
            f"; of {large(from_inside)} rays from inside {len(shapes)} closed shapes"
            f" {leaving or 'none'} hit nothing"
        )
    finding += "."
    return finding, tables


def bvh_animation(run):
    updates, rays = [], []
    for row in run.get("rows"):
        frames = value(row, "frames")
        for frame in frames:
            head = [mesh_name(run, row["mesh"]), f"{value(frame, 'frame')}"]
            updates.append(
                head
                + [
                    cell
                    for u in value(frame, "updates")
                    for cell in (
                        interval(value(u, "wall_ms")),
                        number(value(u, "processor_ms.value")),
                    )
                ]
                + [f"{100 * value(frame, 'foreign_load'):.0f}"]
            )
            rays.append(
                head
                + [interval(value(r, "speed_over_build")) for r in value(frame, "rays")[1:]]
                + [
                    cell
                    for r in value(frame, "rays")
                    for cell in (
                        f"{value(r, 'nodes_per_ray'):.1f}",
                        f"{value(r, 'triangles_per_ray'):.1f}",
                    )
                ]
            )
    first = value(run.get("rows")[0], "frames")[0]
    traced = [name(r["name"]) for r in value(first, "rays")]
    motions = "; ".join(
        f"{name(row['mesh'])} ({value(row, 'triangles')} triangles): {value(row, 'motion')}"
        for row in run.get("rows")
    )
    tables = (
        Table(
            "Time of an update",
            [
                "mesh",
                "frame",
                *(
                    f"{name(u['name'])}, {clock} ms"
                    for u in value(first, "updates")
                    for clock in ("wall", "processor")
                ),
                "foreign load, %",
            ],
            updates,
            [mesh_note(run)],
        ),
        Table(
            f"Diffuse rays: speed over '{traced[0]}', and work",
            [
                "mesh",
                "frame",
                *traced[1:],
                *(f"{t}: {what} per ray" for t in traced for what in ("nodes", "triangles")),
            ],
            rays,
            [f"Speeds by {run.clock} time. Motions: {motions}."],
        ),
    )
    return animation_finding(run), tables


def animation_finding(run):
    """What refitting saves over rebuilding, and what its tree costs the rays of the last frame."""
    saved, speeds = [], []
    for row in run.get("rows"):
        for frame in value(row, "frames"):
            times = {u["name"]: value(u, f"{run.clock}_ms.value") for u in value(frame, "updates")}
            saved += [
                times[u] / times[f"fit{u.removeprefix('build')}"]
                for u in times
                if u.startswith("build") and f"fit{u.removeprefix('build')}" in times
            ]
        speeds += [
            value(r, "speed_over_build.value")
            for r in value(row, "frames")[-1]["rays"]
            if r["name"].startswith("fit")
        ]
    if not saved or not speeds:
        return ""
    return (
        f"Refitting is {span(saved, '{:.1f}')} times as fast as rebuilding; after"
        f" {len(value(row, 'frames')) - 1} frames of motion diffuse rays are {span(speeds)} times"
        " as fast through the refitted tree as through a rebuilt one."
    )


TABLES = {
    "bvh_animation": bvh_animation,
    "bvh_build": bvh_build,
    "ray_rates": ray_rates,
    "traversal": traversal,
}
