# SPDX-License-Identifier: MIT
"""Measurements of a GPU as Markdown: rays per second and times of BVH builds.

Embree ran with one thread per compute unit of the GPU, more threads than the host has cores.
Therefore its figures are omitted.
"""

from rtrays.documents.document import read_json, value
from rtrays.documents.measurements import ours
from rtrays.tables.cells import number
from rtrays.tables.table import Table
from rtrays.tables.text import name


def rates_of(kind):
    """Returns the Mrays/s of our layouts for one mesh and kind of ray."""
    return [value(c, "Mrays_s.value") for c in ours(kind["contestants"])]


def ray_groups(run):
    """Yields ((mesh, kind of ray), measurement)."""
    for row in run["rows"]:
        for kind in row["kinds"]:
            yield (row["mesh"], kind["kind"]), kind


def rays_table(gpu, cpu):
    """Returns the rays per second of the GPU, and of the CPU device's fastest layout."""
    fastest = {key: max(rates_of(kind)) for key, kind in ray_groups(cpu)}
    rows = []
    for key, kind in ray_groups(gpu):
        rates, usual = rates_of(kind), fastest.get(key)
        compared = [number(usual), number(max(rates) / usual)] if usual else ["", ""]
        rows.append([*map(name, key), f"{kind['rays']}", *map(number, rates), *compared])
    layouts = [name(c["name"]) for c in ours(gpu["rows"][0]["kinds"][0]["contestants"])]
    return Table(
        "Rays per second on the wall by layout, Mrays/s, and the fastest layout of the CPU device",
        ["mesh", "rays", "rays in a launch", *layouts, "CPU device", "fastest over CPU device"],
        rows,
    )


def builds_table(gpu):
    """Returns the times of BVH builds by mesh and builder."""
    rows = []
    for row in gpu["rows"]:
        cells = [name(row["mesh"]), f"{row['triangles']}"]
        for c in ours(row["contestants"]):
            ms = value(c, "wall_ms.value")
            cells += [number(ms), f"{1e-3 * row['triangles'] / ms:.1f}"]
        rows.append(cells)
    builders = [name(c["name"]) for c in ours(gpu["rows"][0]["contestants"])]
    heads = [f"{builder}, {unit}" for builder in builders for unit in ("wall ms", "Mtris/s")]
    return Table("Building the hierarchy", ["mesh", "triangles", *heads], rows)


def gpu_markdown(folder, chapter4):
    """Returns the tables of the runs ray_rates and bvh_build in a folder; `chapter4` has the full
    run of a CPU device to compare with."""
    gpu, builds = (read_json(folder / run / "run.json") for run in ("ray_rates", "bvh_build"))
    cpu = read_json(chapter4 / "ray_rates/run.json")
    device, host = value(gpu, "context.device"), value(gpu, "context.host")
    processor = value(cpu, "context.device")
    text = (
        f"# {device['name']}\n\n{device['platform']}, driver {device['driver']},"
        f" {device['compute_units']} compute units, in a host of {host['cores']} cores"
        f" ({host['cpu']}); commit {value(gpu, 'context.commit')}. CPU device: {processor['name']},"
        f" {processor['compute_units']} threads, of `results/chapter4/ray_rates/`.\n"
    )
    for table in (rays_table(gpu, cpu), builds_table(builds)):
        text += f"\n## {table.caption}\n\n{table.markdown()}"
    return text
