# SPDX-License-Identifier: MIT
"""Tables and finding of a moving mesh: rebuilding its hierarchy, or refitting it."""

from cells import Table, interval, number
from measurement_text import mesh_name, mesh_note, name, span
from run_document import value


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
