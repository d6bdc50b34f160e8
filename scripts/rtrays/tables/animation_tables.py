# SPDX-License-Identifier: MIT
"""Tables and finding of a moving mesh: rebuilding its hierarchy, or refitting it."""

from rtrays.documents.document import value
from rtrays.tables.cells import interval, number
from rtrays.tables.table import Table
from rtrays.tables.text import mesh_name, mesh_note, name, span


def frames_of(run):
    """Yields the cells that begin a row, and the frame, for every mesh and frame."""
    for row in run.get("rows"):
        for frame in value(row, "frames"):
            yield [mesh_name(run, row["mesh"]), f"{value(frame, 'frame')}"], frame


def updates_table(run):
    """Returns the times of all updates of the hierarchy."""
    rows = []
    for row, frame in frames_of(run):
        for update in value(frame, "updates"):
            row.append(interval(value(update, "wall_ms")))
            row.append(number(value(update, "processor_ms.value")))
        rows.append([*row, f"{100 * value(frame, 'foreign_load'):.0f}"])
    updates = value(run.get("rows")[0], "frames.0.updates")
    heads = [f"{name(u['name'])}, {clock} ms" for u in updates for clock in ("wall", "processor")]
    columns = ["mesh", "frame", *heads, "foreign load, %"]
    return Table("Time of an update", columns, rows, [mesh_note(run)])


def rays_table(run):
    """Returns the speed and the work of diffuse rays after every update."""
    rows = []
    for row, frame in frames_of(run):
        rays = value(frame, "rays")
        row += [interval(value(ray, "speed_over_build")) for ray in rays[1:]]
        for ray in rays:
            row += [f"{value(ray, key):.1f}" for key in ("nodes_per_ray", "triangles_per_ray")]
        rows.append(row)
    traced = [name(ray["name"]) for ray in value(run.get("rows")[0], "frames.0.rays")]
    heads = [f"{trees}: {what} per ray" for trees in traced for what in ("nodes", "triangles")]
    motions = "; ".join(
        f"{name(row['mesh'])} ({value(row, 'triangles')} triangles): {value(row, 'motion')}"
        for row in run.get("rows")
    )
    return Table(
        f"Diffuse rays: speed over '{traced[0]}', and work",
        ["mesh", "frame", *traced[1:], *heads],
        rows,
        [f"Speeds by {run.clock} time. Motions: {motions}."],
    )


def animation_finding(run):
    """Returns the savings from refitting over rebuilding, and the cost of its tree for the rays of
    the last frame."""
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


def bvh_animation(run):
    """Returns the finding and the tables of a moving mesh."""
    return animation_finding(run), (updates_table(run), rays_table(run))
