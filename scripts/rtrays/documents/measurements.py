# SPDX-License-Identifier: MIT
"""Contestants of measurements, and their speeds over each other."""

from rtrays.documents.document import entry_named, value
from rtrays.documents.intervals import geometric_mean

TRACING = ("intersect_nearest", "intersect_any")
KINDS = ("primary", "shadow", "ambient_occlusion", "diffuse")


def ours(contestants):
    """Returns the contestants of RTRays."""
    return [c for c in contestants if c["side"] == "ours"]


def theirs(entry):
    """Returns the contestants of Embree."""
    return [c for c in value(entry, "contestants") if c["side"] == "embree"]


def contestant_of(entry, name):
    """Returns the contestant with this name. Raises RunError without one."""
    return entry_named(value(entry, "contestants"), name)


def build_speeds(run, contestant):
    """Returns (row, speed over Embree's medium quality) of every mesh that has the contestant."""
    return [
        (row, value(c, "speed_over_embree"))
        for row in run.get("rows")
        for c in value(row, "contestants")
        if c["name"] == contestant
    ]


def our_builders(run):
    """Returns the builders of the default layout, or all of ours where none has it."""
    names = [c["name"] for c in ours(value(run.get("rows")[0], "contestants"))]
    return [c for c in names if c.endswith("wide8")] or names


def ray_speeds(run, kind, contestant):
    """Returns (row, speed over Embree, ray by ray) of every mesh for a kind of ray."""
    return [
        (row, value(c, "speed_over_embree"))
        for row in run.get("rows")
        for entry in value(row, "kinds")
        if entry["kind"] == kind
        for c in value(entry, "contestants")
        if c["name"] == contestant
    ]


def ray_mean(run, kind, contestant):
    """Returns the geometric mean over the meshes of the speed of a kind of ray over Embree."""
    return value(run.get("summary.geometric_means"), f"{kind}.{contestant}")


def our_layouts(run):
    """Returns the names of our layouts in a measurement of rays."""
    return [c["name"] for c in ours(value(run.get("rows")[0], "kinds.0.contestants"))]


def fastest_layout(run):
    """Returns our layout with the largest geometric mean of speeds over all kinds of rays."""
    return max(
        our_layouts(run),
        key=lambda layout: geometric_mean([ray_mean(run, kind, layout) for kind in KINDS]),
    )


def rivals_of(run):
    """Returns the names of the programs that the wavefront is compared with."""
    return [c["name"] for c in value(run.get("rows")[0], "depths.0.contestants")][1:]


def peer_entries(run):
    """Yields (peer, bounces, geometric mean, speeds by scene) of every peer and length of path; the
    megakernel is ours."""
    for rival in rivals_of(run):
        for mean in run.get("summary.wavefront_over"):
            bounces = value(mean, "max_depth") - 1
            scenes = [
                value(depth["wavefront_over"][rival], "value")
                for row in run.get("rows")
                for depth in value(row, "depths")
                if value(depth, "bounces") == bounces
            ]
            yield rival, bounces, mean[rival], scenes


def published_rows(run):
    """Yields the rows of a measurement, each with the row of the thesis that it is compared with,
    or None."""
    published = {row["mesh"]: row for row in run.get("experiment.published.rows")}
    for row in run.get("rows"):
        yield row, published.get(run.get("stand_ins").get(row["mesh"], row["mesh"]))
