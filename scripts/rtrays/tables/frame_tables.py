# SPDX-License-Identifier: MIT
"""Tables and finding of whole frames and their stages."""

from rtrays.documents.document import value
from rtrays.documents.measurements import TRACING, published_rows
from rtrays.tables.cells import interval, number
from rtrays.tables.table import Table
from rtrays.tables.text import mesh_name, mesh_note, name, samples_of, size_of, span


def rays_per_second(row, kind):
    """Returns the Mrays/s of tracing rays of one kind, from the median time."""
    return value(row, f"rays.{kind}") / value(row, f"{kind}_ms.value") * 1e-3


def measured_figures(row):
    """Returns our figures under the names of the thesis' columns."""
    kinds = ("primary", "shadow", "secondary", "frame")
    return {
        **{f"{kind}_ms": number(value(row, f"{kind}_ms.value")) for kind in kinds},
        "primary_Mrays_s": f"{rays_per_second(row, 'primary'):.3g}",
        "secondary_Mrays_s": f"{rays_per_second(row, 'secondary'):.3g}",
        "secondary_rays": f"{value(row, 'rays.secondary'):.0f}",
    }


def thesis_table(run):
    """Returns tables 4.2 and 4.3; our row follows every row of the thesis."""
    columns = run.get("experiment.published.columns")
    keys = [c["key"] for c in columns]
    rows = []
    for row, printed in published_rows(run):
        if printed:
            figures = [f"{value(printed['figures'], key)}" for key in keys]
            rows.append([printed["scene"], "thesis", printed["triangles"], *figures])
        measured = measured_figures(row)
        head = [mesh_name(run, row["mesh"]), "here", f"{value(row, 'triangles')}"]
        rows.append(head + [measured[key] for key in keys])
    hardware = "; ".join(sorted({c["hardware"] for c in columns}))
    return Table(
        "Published frame times, and ours",
        ["scene", "measured", "triangles", *(c["title"] for c in columns)],
        rows,
        [
            f"Published: {run.get('experiment.published.source')}, 1024 x 768 pixels, {hardware}."
            f" Here: {size_of(run)}.",
            mesh_note(run),
        ],
    )


def time_column(kind):
    """Returns the column of the time of rays of one kind, or of frames."""
    return lambda row: interval(value(row, f"{kind}_ms"))


def frames_table(run):
    """Returns the times of frames and their rays."""
    columns = [
        ("scene", lambda row: mesh_name(run, row["mesh"])),
        ("surfaces and lights", lambda row: value(row, "surfaces")),
        ("triangles", lambda row: f"{value(row, 'triangles')}"),
        ("primary rays, ms", time_column("primary")),
        ("shadow rays, ms", time_column("shadow")),
        ("secondary rays, ms", time_column("secondary")),
        ("frame, wall ms", time_column("frame")),
        ("frame, processor ms", time_column("frame_processor")),
        ("rays in a frame", lambda row: f"{value(row, 'rays.frame'):.0f}"),
        ("Mrays/s in a frame", lambda row: f"{rays_per_second(row, 'frame'):.3g}"),
        ("BVH, wall ms", lambda row: number(value(row, "bvh_ms"))),
        ("compilation, ms", lambda row: number(value(row, "compile_ms"))),
        ("repetitions", lambda row: f"{value(row, 'turns')}"),
        ("foreign load, %", lambda row: f"{100 * value(row, 'foreign_load'):.0f}"),
    ]
    note = (
        f"{size_of(run)}, {samples_of(run)}. Primary, shadow and secondary rays: time of the stages"
        " that trace them (intersect nearest, intersect any), reading and writing of streams"
        " included, for explicit paths. Secondary rays follow the first bounce; their time is the"
        " difference between nearest hits with and without that bounce. Frame: wall time of a"
        " sample per pixel by MIS with roulette from the first bounce. Processor time sums all"
        " threads; foreign load hardly changes it. BVH construction and compilation (less with"
        " cached kernels) precede the frame and are not part of it."
    )
    return Table.of(
        "Frames and their rays, medians with 95 % intervals",
        columns,
        run.get("rows"),
        [note, mesh_note(run)],
    )


def shares(row):
    """Returns the percentages of the device's time in a frame, by stage."""
    stages = {stage["name"]: value(stage, "ms.value") for stage in value(row, "stages")}
    together = sum(stages.values())
    return {stage: 100 * ms / together for stage, ms in stages.items()}


def stage_order(run):
    """Returns tracing first, then the other stages by their largest share; stages below one
    percent are left to "others"."""
    largest = {}
    for row in run.get("rows"):
        for stage, share in shares(row).items():
            largest[stage] = max(share, largest.get(stage, 0))
    others = sorted(
        (stage for stage in largest if stage not in TRACING), key=lambda stage: -largest[stage]
    )
    return [*TRACING, *(stage for stage in others if largest[stage] >= 1)]


def traced_share(row):
    """Returns the percentage of tracing in the device's time of a frame."""
    return sum(shares(row).get(stage, 0) for stage in TRACING)


def shares_table(run):
    """Returns the shares of the stages in a frame (figure 4.21)."""
    shown = stage_order(run)
    rows = []
    for row in run.get("rows"):
        cells = [shares(row).get(stage, 0) for stage in shown]
        percentages = [*cells, 100 - sum(cells), traced_share(row)]
        rows.append([mesh_name(run, row["mesh"]), *(f"{cell:.1f}" for cell in percentages)])
    return Table(
        "Share of the device's time in a frame (figure 4.21), %",
        ["scene", *map(name, shown), "others", "tracing in all"],
        rows,
    )


def frame_times(run):
    """Returns the finding and the tables of whole frames."""
    frames = [value(row, "frame_ms.value") for row in run.get("rows")]
    traced = list(map(traced_share, run.get("rows")))
    finding = (
        f"A frame of {size_of(run)} with {samples_of(run)} takes {span(frames, '{:.0f}')} ms on"
        f" {len(frames)} scenes; tracing is {span(traced, '{:.0f}')} % of the device's time."
    )
    return finding, (thesis_table(run), frames_table(run), shares_table(run))
