# SPDX-License-Identifier: MIT
"""Tables and finding of the wavefront against other programs, by length of path."""

from rtrays.documents.document import value
from rtrays.documents.measurements import contestant_of, published_rows, rivals_of
from rtrays.tables.cells import NONE, interval
from rtrays.tables.table import Table
from rtrays.tables.text import absent_note, mesh_name, mesh_note, samples_of, size_of


def depth_rows(run):
    """Yields the cells that begin a row, the measurement, its scene, and the thesis' row, for every
    scene and length of path."""
    for row, printed in published_rows(run):
        for depth in value(row, "depths"):
            head = [mesh_name(run, row["mesh"]), f"{value(depth, 'bounces')}"]
            yield head, depth, row, printed


def means_table(run, rivals):
    """Returns the geometric means of the speeds over all programs."""
    rows = [
        [f"{value(mean, 'max_depth') - 1}", *(f"{mean[rival]:.2f}" for rival in rivals)]
        for mean in run.get("summary.wavefront_over")
    ]
    return Table(
        "Speed of the wavefront over each program, geometric means over the scenes",
        ["bounces", *rivals],
        rows,
        [absent_note(run)],
    )


def speeds_table(run, rivals):
    """Returns the speeds over all programs by scene and length of path."""
    rows = [
        [
            *head,
            f"{value(row, 'triangles')}",
            *(interval(value(depth, "wavefront_over")[rival]) for rival in rivals),
            f"{2 * value(depth, 'bounces') + 2}",
            f"{value(depth, 'rays_per_sample'):.2f}",
            f"{value(depth, 'reference_rays_per_sample'):.2f}",
            f"{value(depth, 'turns')}",
            f"{100 * value(depth, 'foreign_load'):.0f}",
        ]
        for head, depth, row, _ in depth_rows(run)
    ]
    heads = [
        "rays per sample, at most",
        "wavefront, rays per sample",
        "Embree, rays per sample",
        "repetitions",
        "foreign load, %",
    ]
    note = (
        f"{size_of(run)}, {samples_of(run)} and repetition; every repetition measures all programs."
        " All surfaces are diffuse, without roulette; every hit has one explicit connection, and"
        " light that paths hit is not counted. That makes 2 (b + 1) rays for b bounces, fewer where"
        " paths leave the scene or a light is behind a surface. The megakernel replaces OptiX,"
        " which needs its maker's GPUs: it is the same path tracer in one kernel, on the same"
        " device. The Embree reference computes in double precision except for rays. Mitsuba 3 and"
        " Cycles also count light that paths hit, and trace a last ray for it. A frame of Cycles is"
        " a quarter of one render call for four frames. The processes of Mitsuba and Cycles count"
        " as foreign load."
    )
    return Table(
        f"Speed of the wavefront over each program, by {run.clock} time",
        ["scene", "bounces", "triangles", *rivals, *heads],
        rows,
        [note, mesh_note(run)],
    )


def rates_table(run, rivals):
    """Returns the samples per second of all programs by scene and length of path (figure 4.22)."""
    names = ["wavefront", *rivals]
    rows = [
        [
            *head,
            *(interval(value(contestant_of(depth, c), "Msamples_s")) for c in names),
            f"{printed['scene']}, {printed['triangles']}" if printed else NONE,
        ]
        for head, depth, _, printed in depth_rows(run)
    ]
    return Table(
        "Samples per second on the wall, Msamples/s",
        ["scene", "bounces", *names, "published scene"],
        rows,
        [f"Published: {run.get('experiment.published.source')}."],
    )


def bounces(run):
    """Returns the finding and the tables of speeds by length of path."""
    rivals, summary = rivals_of(run), run.get("summary.wavefront_over")
    rival = "Embree reference" if "Embree reference" in rivals else rivals[0]
    speeds = ", ".join(f"{mean[rival]:.2f}" for mean in summary)
    lengths = ", ".join(f"{value(mean, 'max_depth') - 1}" for mean in summary)
    finding = (
        f"The wavefront is {speeds} times as fast as the {rival} at {lengths} bounces"
        f" (geometric means over {len(run.get('rows'))} scenes)."
    )
    return finding, [make(run, rivals) for make in (means_table, speeds_table, rates_table)]
