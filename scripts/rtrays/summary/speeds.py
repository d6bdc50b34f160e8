# SPDX-License-Identifier: MIT
"""Blocks of speeds over other renderers, over Embree, and on GPUs."""

from rtrays.documents.document import read_json, value
from rtrays.documents.intervals import geometric_mean
from rtrays.documents.curves import algorithm_name
from rtrays.documents.measurements import (
    KINDS,
    build_speeds,
    fastest_layout,
    our_builders,
    ours,
    peer_entries,
    ray_mean,
)
from rtrays.documents.renderers import (
    best_of,
    contestants_of,
    gain_in_time,
    name_of,
    seconds,
)
from rtrays.documents.run_document import Run
from rtrays.paths import RESULTS
from rtrays.tables.cells import NONE, interval, number
from rtrays.tables.table import Table
from rtrays.tables.text import bounces_text, name, span

CHAPTER4 = RESULTS / "chapter4"


def speed_rows():
    """Returns samples per second over the peers, a row each; columns are the lengths of path."""
    entries = list(peer_entries(Run(CHAPTER4 / "bounces")))
    lengths = dict.fromkeys(bounces for _, bounces, _, _ in entries)
    rows = [
        [peer, *(f"{mean:.2f}" for other, _, mean, _ in entries if other == peer)]
        for peer in dict.fromkeys(entry[0] for entry in entries)
    ]
    heads = ["RTRays, samples per second over", *map(bounces_text, lengths)]
    return Table("Samples per second", heads, rows)


def ray_means():
    """Returns the fastest layout, and {kind of ray: its mean speed over Embree}."""
    rates = Run(CHAPTER4 / "ray_rates")
    layout = fastest_layout(rates)
    return layout, {kind: ray_mean(rates, kind, layout) for kind in KINDS}


def build_ratios():
    """Returns {builder: its speeds over Embree, one for each mesh}."""
    build = Run(CHAPTER4 / "bvh_build")
    return {
        builder: [value(speed, "value") for _, speed in build_speeds(build, builder)]
        for builder in our_builders(build)
    }


def embree_table():
    """Returns rays and BVH construction over Embree, geometric means and ranges over the meshes."""
    layout, means = ray_means()
    rows = [
        [f"{name(kind)} rays per second, {name(layout)}", f"{mean:.2f}"]
        for kind, mean in means.items()
    ]
    for builder, ratios in build_ratios().items():
        mean = f"{geometric_mean(ratios):.2f} ({span(ratios)})"
        rows.append([f"BVH construction, {name(builder)}", mean])
    return Table("Embree", ["RTRays over Embree", "geometric mean over meshes"], rows)


def best_rates(rays, kind):
    """Returns the Mrays/s of the fastest layout by mesh, for a kind of ray."""
    return [
        max(value(c, "Mrays_s.value") for c in ours(entry["contestants"]))
        for row in rays["rows"]
        for entry in row["kinds"]
        if entry["kind"] == kind
    ]


def gpu_rows():
    """Returns the range of Mrays/s by kind of ray and the fastest build of every GPU."""
    rows = []
    for path in sorted((RESULTS / "gpu").glob("*/ray_rates/run.json")):
        rays, build = read_json(path), path.parents[1] / "bvh_build/run.json"
        device = value(rays, "context.device.name")
        for kind in KINDS:
            best = best_rates(rays, kind)
            rates = f"{number(min(best))} to {number(max(best))}" if best else NONE
            rows.append([device, f"{name(kind)} rays, Mrays/s", rates])
        if build.is_file():
            fastest = max(
                1e-3 * row["triangles"] / value(c, "wall_ms.value")
                for row in read_json(build)["rows"]
                for c in ours(row["contestants"])
            )
            label = "BVH construction, Mtris/s, fastest builder"
            rows.append([device, label, f"up to {number(fastest)}"])
    return rows and Table("GPU", ["device", "measurement", "here"], rows)


def renderers():
    """Returns error and speed beside the other renderers by scene."""
    run = Run(CHAPTER4 / "renderers")
    rows = []
    for row in run.get("rows"):
        own, other = best_of(run, row, True), best_of(run, row, False)
        plain = contestants_of(row, True)[0]  # path tracing with independent samples
        fastest = min(contestants_of(row, False), key=lambda c: seconds(run, c))
        rows.append(
            [
                name(row["scene"]),
                interval(gain_in_time(run, own, other), form="{:.2f}"),
                algorithm_name(own["algorithm"]),
                name_of(other).partition(",")[0],
                f"{seconds(run, fastest) / seconds(run, plain):.2f}",
            ]
        )
    heads = ["scene", "error at equal time", "our best", "their best", "samples per second"]
    return Table("Other renderers", heads, rows).markdown()


def speeds():
    """Returns all tables of speeds."""
    tables = [speed_rows(), embree_table(), gpu_rows()]
    device = Run(CHAPTER4 / "bounces").get("context.device.name")
    return f"On {device} (above 1: RTRays is faster):\n\n" + "\n".join(
        table.markdown() for table in tables if table
    )


def speeds_at_a_glance():
    """Returns the speeds for README: peers on large scenes, parts over Embree, GPUs."""
    others = [
        f"{min(row[1:])} to {max(row[1:])} ({row[0]})"
        for row in speed_rows().rows
        if "scalar" not in row[0] and row[0] != "megakernel"
    ]
    rays = span(ray_means()[1].values())
    builds = span([geometric_mean(ratios) for ratios in build_ratios().values()])
    text = (
        f"On six large diffuse scenes, 1 to 8 bounces, samples per second over others:"
        f" {', '.join(others)}. Over Embree: {rays} of its rays per second, {builds} of its speed"
        " of BVH construction."
    )
    for row in (gpu_rows() or Table("", [], [])).rows:
        if row[1].startswith("diffuse"):
            text += f" On an {row[0]}: {row[2]} million diffuse rays per second."
    return text + "\n"
