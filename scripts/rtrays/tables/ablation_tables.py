# SPDX-License-Identifier: MIT
"""Tables and finding of frames and builds with one setting changed."""

from rtrays.documents.document import value
from rtrays.documents.intervals import geometric_mean
from rtrays.tables.cells import interval, number, ratio
from rtrays.tables.table import Table
from rtrays.tables.text import mesh_name, mesh_note, samples_of, size_of


def questions_table(run):
    """Returns the question that each changed setting answers."""
    changed = {entry["name"].split("=")[0] for entry in value(run.get("rows")[0], "frames")}
    rows = [list(entry) for entry in run.prose("questions").items() if entry[0] in changed]
    return Table("Settings that are changed, one at a time", ["setting", "question"], rows)


def shared_columns(run):
    """Returns the columns that the tables of frames and builds share; an item is (row, entry)."""
    return [
        ("scene", lambda e: mesh_name(run, e[0]["mesh"])),
        ("triangles", lambda e: f"{value(e[0], 'triangles')}"),
        ("setting", lambda e: e[1]["name"]),
        ("speed over defaults", lambda e: ratio(value(e[1], "speed_over_defaults"))),
    ]


def entries_of(run, what):
    """Returns (row, entry) of all "frames" or "builds"."""
    return [(row, entry) for row in run.get("rows") for entry in value(row, what)]


def frames_table(run):
    """Returns the frames with one setting changed."""
    columns = [
        *shared_columns(run),
        ("frame, wall ms", lambda e: interval(value(e[1], "wall_ms"))),
        ("processor ms", lambda e: number(value(e[1], "processor_ms.value"))),
        ("features", lambda e: f"{value(e[1], 'features')}"),
        ("binaries, KiB", lambda e: f"{value(e[1], 'binary_bytes') / 1024:.0f}"),
        ("bytes per path", lambda e: f"{value(e[1], 'bytes_per_path')}"),
        ("launches", lambda e: f"{value(e[1], 'launches')}"),
        ("compilation, ms", lambda e: number(value(e[1], "compile_ms"))),
    ]
    note = (
        f"{size_of(run)}, {samples_of(run)} and frame, path tracing by MIS with roulette. Speeds by"
        f" {run.clock} time, repetition by repetition, medians with 95 % intervals. A setting that"
        " equals the device's default shows how far equal configurations differ. Every frame has a"
        " session of its own, because a session keeps its memory and the first one is up to 7 %"
        " slower. Compilation takes less with cached kernels."
    )
    return Table.of(
        "Frames with one setting changed",
        columns,
        entries_of(run, "frames"),
        [note, mesh_note(run)],
    )


def sah_over_defaults(entry):
    """Returns the SAH cost of a build over that with the defaults."""
    row, build = entry
    return f"{value(build, 'sah') / value(row, 'builds.0.sah'):.3f}"


def builds_table(run):
    """Returns the builds with one setting changed."""
    columns = [
        *shared_columns(run),
        ("wall ms", lambda e: interval(value(e[1], "wall_ms"))),
        ("SAH cost", lambda e: f"{value(e[1], 'sah'):.2f}"),
        ("SAH cost over defaults", sah_over_defaults),
        ("depth", lambda e: f"{value(e[1], 'depth')}"),
        (
            "peak bytes per triangle",
            lambda e: f"{value(e[1], 'bytes_peak') / value(e[0], 'triangles'):.0f}",
        ),
    ]
    caption = "Building the hierarchy with one setting changed"
    return Table.of(caption, columns, entries_of(run, "builds"))


def ablation_finding(run):
    """Returns the settings of the slowest and fastest frames, by geometric means over scenes."""
    names = [entry["name"] for entry in value(run.get("rows")[0], "frames")][1:]
    speeds = {
        setting: geometric_mean(
            [
                value(entry, "speed_over_defaults.value")
                for _, entry in entries_of(run, "frames")
                if entry["name"] == setting
            ]
        )
        for setting in names
    }
    if not speeds:
        return ""
    slowest, fastest = min(speeds, key=speeds.get), max(speeds, key=speeds.get)
    return (
        f"Of {len(names)} changes of one setting {slowest} is the slowest,"
        f" {speeds[slowest]:.2f} times as fast as the defaults, and {fastest} the fastest,"
        f" {speeds[fastest]:.2f} times (geometric means over {len(run.get('rows'))} scenes)."
    )


def ablations(run):
    """Returns the finding and the tables of settings that are changed, one at a time."""
    return ablation_finding(run), (questions_table(run), frames_table(run), builds_table(run))
