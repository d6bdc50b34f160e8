# SPDX-License-Identifier: MIT
"""Tables of the hierarchy's measurements: what was measured, in words, and the tables. A figure that a side does not tell is
a dash."""

import re

from run_document import value
from tables import Table

NONE = "–"
KINDS = ("primary", "shadow", "ambient_occlusion", "diffuse")


def number(x, digits=3):
    return f"{x:.{digits}g}" if abs(x) < 10 ** digits else f"{x:.0f}"


def interval(entry, digits=3):
    return f"{number(value(entry, 'value'), digits)} [{number(value(entry, 'low'), digits)}, {number(value(entry, 'high'), digits)}]"


def builder(entry):
    """Its name, and what made the tree where it gave up (bvh/builder.h)."""
    gave_up = "method" in entry and not entry["name"].startswith(entry["method"])
    return name(entry["name"]) + (f", by {name(entry['method'])}" if gave_up else "")


GIVING_UP = "A tree that clustering makes too deep is built by binned SAH instead: its figures are then that one's."


def told(entry, key, form="{:.3g}", scale=1.0):
    return form.format(scale * entry[key]) if key in entry else NONE


def name(text):
    return text.replace("_", " ")


def mesh_name(run, mesh):
    """The mesh and, of one made of nothing, that it is; and what it stands in for."""
    text = name(mesh) + (" (procedural)" if re.match(r"(scattered|landscape|hall|court|city)_\d+", mesh) else "")
    stands_for = run.get("stand_ins").get(mesh)
    return f"{text}, for {name(stands_for)}, which is not there" if stands_for else text


def heading(run, what):
    context = run.get("context")
    host = f"{value(context, 'host.cpu')}, {value(context, 'host.cores')} cores"
    units = "threads" if run.clock == "processor" else f"compute units, beside {host}"
    load = ", ".join(f"{average:.1f}" for average in value(context, "load_average_start"))
    text = (f"# {run.get('experiment.title')} ({run.get('experiment.thesis')})\n\n{what}\n\n"
            f"{value(context, 'device.name')}, {value(context, 'device.compute_units')} {units}, {value(context, 'host.compiler')}; "
            f"commit {value(context, 'commit')}{', changed' if value(context, 'dirty') else ''}, profile "
            f"{run.get('experiment.profile')}, {value(context, 'finished_at')}; load average at the start {load}, others "
            f"used {100 * value(context, 'cpu_use.foreign'):.0f} % of the processors.")
    if run.get("absent"):
        text += f" Not there and left out: {', '.join(map(name, run.get('absent')))}."
    return text


def page(run, what, tables, figures):
    """The Markdown page of a measurement; `tables` lie beside it as tables/table_N.csv and .tex."""
    parts = [heading(run, what)]
    for index, table in enumerate(tables, 1):
        parts.append(f"## {table.caption}\n\n{table.markdown()}\n[CSV](tables/table_{index}.csv), [LaTeX](tables/table_{index}.tex)")
    parts += [f"![{caption}]({stem}.svg)\n\n{caption}" for stem, caption in figures.items()]
    return "\n\n".join(parts) + "\n"


def published_table(run):
    """Table 4.1 with our columns: the default layout of every builder, and Embree."""
    columns = run.get("experiment.published.columns")
    published = {row["mesh"]: row for row in run.get("experiment.published.rows")}
    stand_ins = run.get("stand_ins")
    shown = [c["name"] for c in value(run.get("rows")[0], "contestants")
             if c["side"] == "embree" or c["name"].endswith("wide8")]
    rows = []
    for row in run.get("rows"):
        printed = published.get(stand_ins.get(row["mesh"], row["mesh"]))
        contestants = {c["name"]: c for c in value(row, "contestants")}
        cells = [printed["scene"], printed["triangles"]] if printed else [NONE, NONE]
        cells += [number(printed["ms"][c["key"]]) if printed and c["key"] in printed["ms"] else NONE for c in columns]
        cells += [mesh_name(run, row["mesh"]), f"{value(row, 'triangles')}"]
        cells += [f"{number(value(contestants[c], 'wall_ms.value'))}; {number(value(contestants[c], 'processor_ms.value'))}"
                  for c in shown]
        rows.append(cells)
    heads = ["scene", "triangles", *(f"{c['title']}, ms" for c in columns), "measured here", "triangles",
             *(f"{name(c)}, wall ms; processor ms" for c in shown)]
    hardware = "; ".join(f"{c['title']}: {c['hardware']}" for c in columns)
    return Table(f"As printed ({run.get('experiment.published.source')}; {hardware}), and here", heads, rows)


def build_rows(run):
    for row in run.get("rows"):
        triangles, sweep = value(row, "triangles"), value(row, "full_sweep_sah")
        for c in value(row, "contestants"):
            wall = value(c, "wall_ms.value")
            yield [mesh_name(run, row["mesh"]), f"{triangles}", builder(c), interval(value(c, "wall_ms")),
                   number(value(c, "processor_ms.value")), f"{1e-3 * triangles / wall:.2f}",
                   f"{1e-3 * triangles / value(c, 'processor_ms.value'):.2f}",
                   interval(value(c, "speed_over_embree")), told(c, "sah", "{:.2f}"),
                   f"{c['sah'] / sweep:.3f}" if "sah" in c else NONE, told(c, "nodes_per_ray", "{:.1f}"),
                   told(c, "triangles_per_ray", "{:.1f}"), f"{value(c, 'bytes') / triangles:.0f}",
                   f"{value(c, 'bytes_peak') / triangles:.0f}", f"{1e-6 * value(c, 'bytes_peak'):.1f}", f"{value(row, 'turns')}",
                   f"{100 * value(row, 'foreign_load'):.0f}"]


def bvh_build(run):
    full = Table("Each builder and layout", [
        "mesh", "triangles", "builder", "ms", "processor ms", "Mtris/s (wall)", "Mtris per processor s", "speed / Embree medium", "SAH", "/ full sweep",
        "nodes per ray", "triangles per ray", "bytes per triangle", "peak", "peak, MB", "turns", "others' load, %"],
        list(build_rows(run)))
    exponents = Table(f"Time = c · triangles^k ({run.clock} time; least squares on logarithms, 95 % intervals over the meshes)",
                      ["builder", "k"],
                      [[name(c), interval(k)] for c, k in run.get("summary.exponents").items()])
    what = ("Medians of turns with 95 % intervals. ms: on the wall, all threads of the device; processor ms: of all threads "
            f"of the host together; *speed* is the ratio of {run.clock} times, turn by turn. Embree's low, medium "
            "and high quality, not ROBUST. SAH: K_T = K_I = 1, of the two-wide tree below every layout, also over that of a "
            "full sweep on the host; nodes and triangles: of diffuse rays. Peak: all that a build holds, vertices, indices and "
            f"the result included. {GIVING_UP}")
    return what, (published_table(run), full, exponents, stages(run))


def stages(run):
    """Where the device's time of one build of the largest mesh goes."""
    row = max(run.get("rows"), key=lambda row: value(row, "triangles"))
    rows = []
    for c in value(row, "contestants"):
        if c["side"] == "ours":
            together = sum(stage["ms"] for stage in value(c, "stages").values())
            rows += [[name(c["name"]), name(stage), f"{100 * entry['ms'] / together:.1f}", number(entry["ms"]), f"{entry['launches']}"]
                     for stage, entry in sorted(value(c, "stages").items(), key=lambda item: -item[1]["ms"])
                     if entry["ms"] > 0.01 * together]
    return Table(f"Stages of one build of {name(row['mesh'])}: those of more than 1 % of the device's time",
                 ["builder", "stage", "%", "ms", "launches"], rows)


CACHED = 4e6  # bytes: what fits the second-level caches of two or more cores
FEWEST_FOR_COSTS = 8  # meshes x kinds: three numbers are fitted


def costs(run, ours):
    """What a node and a triangle cost: processor ns per ray = a + b nodes + c triangles, by relative least squares."""
    import numpy

    rows = []
    for layout, cached in [(layout, cached) for layout in ours for cached in (True, False)]:
        entries = [next(c for c in value(kind, "contestants") if c["name"] == layout)
                   for row in run.get("rows") for kind in value(row, "kinds")]
        entries = [entry for entry in entries if (value(entry, "bytes") <= CACHED) == cached]
        if len(entries) < FEWEST_FOR_COSTS:
            continue
        ns = numpy.array([value(c, "processor_ns.value") for c in entries])
        work = numpy.array([[1, value(c, "nodes_per_ray"), value(c, "triangles_per_ray")] for c in entries])
        fit, *_ = numpy.linalg.lstsq(work / ns[:, None], numpy.ones(len(ns)), rcond=None)
        off = numpy.abs(work @ fit / ns - 1)
        rows.append([name(layout), f"{'up to' if cached else 'above'} {1e-6 * CACHED:g} MB", f"{len(entries)}", *(f"{x:.1f}" for x in fit), f"{100 * numpy.median(off):.0f}", f"{100 * off.max():.0f}"])
    return rows and Table("What limits it: processor ns per ray = a + b · nodes + c · triangles, by size of the hierarchy",
                 ["layout", "hierarchy", "meshes × kinds", "a, ns", "b, ns per node", "c, ns per triangle", "median residual, %", "largest, %"], rows)


def ray_rates(run):
    first = value(run.get("rows")[0], "kinds")[0]
    ours = [c["name"] for c in value(first, "contestants") if c["side"] == "ours"]
    rates, work = [], []
    for row in run.get("rows"):
        for kind in value(row, "kinds"):
            contestants = {c["name"]: c for c in value(kind, "contestants")}
            theirs = [c for c in value(kind, "contestants") if c["side"] == "embree"]
            head = [name(row["mesh"]), name(kind["kind"])]
            rates.append(head + [number(value(contestants[c], "Mrays_s.value")) for c in ours]
                         + [f"{number(value(c, 'Mrays_s.value'))} ({c['isa']})" for c in theirs]
                         + [interval(value(contestants[c], "speed_over_embree")) for c in ours]
                         + [interval(value(theirs[1], "speed_over_embree")),
                            interval(value(kind, "stackless_over_stack")), f"{100 * value(kind, 'foreign_load'):.0f}"])
            work.append(head + [f"{value(contestants[c], 'nodes_per_ray'):.1f}, {value(contestants[c], 'triangles_per_ray'):.1f}"
                                for c in ours] + [number(value(contestants[c], "processor_ns.value")) for c in ours]
                        + [f"{1e-6 * value(contestants[c], 'bytes'):.3g}" for c in ours])
    means = [[name(kind)] + [f"{value(run.get('summary.geometric_means'), f'{kind}.{c}'):.2f}"
                             for c in [*ours, "stackless_over_stack"]] for kind in KINDS]
    tables = (
        Table("Geometric means of the speeds over Embree, ray by ray",
              ["rays", *map(name, ours), "stackless / stack"], means),
        Table(f"Mrays/s (wall), and speeds over Embree ray by ray ({run.clock} time)",
              ["mesh", "rays", *(f"{name(c)}, Mrays/s" for c in ours), "Embree 1", "Embree 16",
               *(f"{name(c)} / Embree 1" for c in ours), "Embree 16 / Embree 1", "stackless / stack", "others' load, %"], rates),
        Table("Work", ["mesh", "rays", *(f"nodes, triangles per ray: {name(c)}" for c in ours),
                       *(f"processor ns per ray: {name(c)}" for c in ours), *(f"MB: {name(c)}" for c in ours)], work),
        *filter(None, [costs(run, ours)]),
    )
    what = ("Medians of turns with 95 % intervals, the same rays in the same order by all, on as many threads as the device "
            "has compute units. Embree: ROBUST, the instruction set that is fastest on these rays (in brackets); 1: "
            "rtcIntersect1 or, for shadow and ambient occlusion rays, rtcOccluded1; 16: rtcIntersect16, rtcOccluded16, told "
            f"which rays are coherent. {GIVING_UP}")
    return what, tables


def traversal(run):
    hits, closed = [], []
    for row in run.get("rows"):
        for layout in value(row, "layouts"):
            head = [name(row["mesh"]), f"{value(row, 'triangles')}", name(layout["name"]), f"{value(row, 'rays'):.3g}"]
            verdict = "passed" if value(layout, "passed") else "FAILED"
            if row["check"] == "hits":
                hits.append(head + [f"{value(row, 'hits')}", *(f"{value(layout, key)}" for key in ("random", "grazing", "tied", "wrong")),
                                    verdict])
            else:
                closed.append(head + [f"{value(layout, 'misses')}", f"{value(layout, 'limit'):g}", verdict])
    tables = (
        Table("Fuzzed rays: differences from Embree, and how many of them are wrong",
              ["mesh", "triangles", "layout", "rays", "hits", "random", "grazing", "tied", "wrong", ""], hits),
        Table("Rays from inside closed shapes that hit nothing",
              ["shape", "triangles", "layout", "rays", "misses", "at most (of all)", ""], closed),
    )
    what = ("Rays are in equal parts random, grazing a triangle (1e-1 to 1e-5 of its plane), and along an axis through a vertex "
            "or the middle of an edge (tied: either side may answer). A difference: hit against miss, or more than 1e-5 of the "
            "scene's diagonal in distance from Embree (ROBUST). Brute force in double precision, which differences are judged "
            "by, finds wrong at most 1e-6 of the rays.")
    return what, tables


def bvh_animation(run):
    updates, rays = [], []
    for row in run.get("rows"):
        frames = value(row, "frames")
        for frame in frames:
            head = [name(row["mesh"]), f"{value(frame, 'frame')}"]
            updates.append(head + [f"{interval(value(u, 'wall_ms'))}; {number(value(u, 'processor_ms.value'))}"
                                   for u in value(frame, "updates")] + [f"{100 * value(frame, 'foreign_load'):.0f}"])
            rays.append(head + [f"{interval(value(r, 'speed_over_build'))}" for r in value(frame, "rays")[1:]]
                        + [f"{value(r, 'nodes_per_ray'):.1f}, {value(r, 'triangles_per_ray'):.1f}" for r in value(frame, "rays")])
    first = value(run.get("rows")[0], "frames")[0]
    traced = [name(r["name"]) for r in value(first, "rays")]
    tables = (
        Table("An update: wall ms [95 % interval]; processor ms",
              ["mesh", "frame", *(name(u["name"]) for u in value(first, "updates")), "others' load, %"], updates),
        Table(f"Diffuse rays: speed over '{traced[0]}' ({run.clock} time), and work",
              ["mesh", "frame", *traced[1:], *(f"nodes, triangles per ray: {t}" for t in traced)], rays),
    )
    motions = "; ".join(f"{name(row['mesh'])} ({value(row, 'triangles')} triangles): {value(row, 'motion')}" for row in run.get("rows"))
    what = (f"Every frame the hierarchy is built anew, and that of frame 0 is fitted to where its triangles are now (its links stay). "
            f"{motions}. Medians of turns with 95 % intervals.")
    return what, tables


TABLES = {"bvh_animation": bvh_animation, "bvh_build": bvh_build, "ray_rates": ray_rates, "traversal": traversal}
