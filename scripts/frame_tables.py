# SPDX-License-Identifier: MIT
"""Tables and findings of the measurements of whole frames."""

from cells import NONE, Table, interval, number, ratio
from measurement_text import geometric_mean, mesh_name, mesh_note, name, span
from run_document import value

TRACING = ("intersect_nearest", "intersect_any")


def size_of(run):
    width, height = run.get("experiment.settings.size")
    return f"{width} x {height} pixels"


def samples_of(run):
    samples = run.get("experiment.settings").get("spp", 1)
    return f"{samples} sample{'s' if samples > 1 else ''} per pixel"


def rays_per_second(row, kind):
    """Mrays/s of tracing rays of one kind, from the median time."""
    return value(row, f"rays.{kind}") / value(row, f"{kind}_ms.value") * 1e-3


def thesis_table(run):
    """Tables 4.2 and 4.3; our row follows every row of the thesis."""
    columns = run.get("experiment.published.columns")
    published = {row["mesh"]: row for row in run.get("experiment.published.rows")}
    rows = []
    for row in run.get("rows"):
        printed = published.get(run.get("stand_ins").get(row["mesh"], row["mesh"]))
        if printed:
            rows.append(
                [
                    printed["scene"],
                    "thesis",
                    printed["triangles"],
                    *(f"{value(printed['figures'], c['key'])}" for c in columns),
                ]
            )
        ours = {
            f"{kind}_ms": number(value(row, f"{kind}_ms.value"))
            for kind in ("primary", "shadow", "secondary", "frame")
        }
        ours.update(
            {
                f"{kind}_Mrays_s": f"{rays_per_second(row, kind):.3g}"
                for kind in ("primary", "secondary")
            }
        )
        ours["secondary_rays"] = f"{value(row, 'rays.secondary'):.0f}"
        rows.append(
            [
                mesh_name(run, row["mesh"]),
                "here",
                f"{value(row, 'triangles')}",
                *(ours[c["key"]] for c in columns),
            ]
        )
    hardware = "; ".join(sorted({c["hardware"] for c in columns}))
    return Table(
        "Published frame times, and ours",
        ["scene", "measured", "triangles", *(c["title"] for c in columns)],
        rows,
        [
            (
                f"Published: {run.get('experiment.published.source')}, 1024 x 768 pixels,"
                f" {hardware}. Here: {size_of(run)}."
            ),
            mesh_note(run),
        ],
    )


def frame_rows(run):
    for row in run.get("rows"):
        yield [
            mesh_name(run, row["mesh"]),
            value(row, "surfaces"),
            f"{value(row, 'triangles')}",
            *(
                interval(value(row, f"{kind}_ms"))
                for kind in ("primary", "shadow", "secondary", "frame")
            ),
            interval(value(row, "frame_processor_ms")),
            f"{value(row, 'rays.frame'):.0f}",
            f"{value(row, 'rays.frame') / value(row, 'frame_ms.value') * 1e-3:.3g}",
            number(value(row, "bvh_ms")),
            number(value(row, "compile_ms")),
            f"{value(row, 'turns')}",
            f"{100 * value(row, 'foreign_load'):.0f}",
        ]


def shares(row):
    """Percent of the device's time in a frame, by stage."""
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


def frame_times(run):
    shown = stage_order(run)
    table, traced = [], []
    for row in run.get("rows"):
        of_row = shares(row)
        cells = [of_row.get(stage, 0) for stage in shown]
        traced.append(sum(of_row.get(stage, 0) for stage in TRACING))
        table.append(
            [
                mesh_name(run, row["mesh"]),
                *(f"{cell:.1f}" for cell in cells),
                f"{100 - sum(cells):.1f}",
                f"{traced[-1]:.1f}",
            ]
        )
    tables = (
        thesis_table(run),
        Table(
            "Frames and their rays, medians with 95 % intervals",
            [
                "scene",
                "surfaces and lights",
                "triangles",
                "primary rays, ms",
                "shadow rays, ms",
                "secondary rays, ms",
                "frame, wall ms",
                "frame, processor ms",
                "rays in a frame",
                "Mrays/s in a frame",
                "BVH, wall ms",
                "compilation, ms",
                "repetitions",
                "foreign load, %",
            ],
            list(frame_rows(run)),
            [
                (
                    f"{size_of(run)}, {samples_of(run)}. Primary, shadow and secondary rays: time"
                    " of the stages that trace them (intersect nearest, intersect any), reading"
                    " and writing of streams included, for explicit paths. Secondary rays follow"
                    " the first bounce; their time is the difference between nearest hits with and"
                    " without that bounce. Frame: wall time of a sample per pixel by MIS with"
                    " roulette from the first bounce. Processor time sums all threads; foreign"
                    " load hardly changes it. BVH construction and compilation (less with cached"
                    " kernels) precede the frame and are not part of it."
                ),
                mesh_note(run),
            ],
        ),
        Table(
            "Share of the device's time in a frame (figure 4.21), %",
            ["scene", *map(name, shown), "others", "tracing in all"],
            table,
        ),
    )
    frames = [value(row, "frame_ms.value") for row in run.get("rows")]
    finding = (
        f"A frame of {size_of(run)} with {samples_of(run)} takes {span(frames, '{:.0f}')} ms on"
        f" {len(frames)} scenes; tracing is {span(traced, '{:.0f}')} % of the device's time."
    )
    return finding, tables


def rivals_of(run):
    """The names of the programs that the wavefront is compared with."""
    return [c["name"] for c in value(run.get("rows")[0], "depths.0.contestants")][1:]


def bounces(run):
    """Figure 4.22, a row for each scene and length of path."""
    published = {row["mesh"]: row for row in run.get("experiment.published.rows")}
    rivals = rivals_of(run)
    names = ["wavefront", *rivals]
    rates, ratios, absent = [], [], set()
    for row in run.get("rows"):
        printed = published.get(run.get("stand_ins").get(row["mesh"], row["mesh"]))
        absent.update(value(row, "absent_peers"))
        for depth in value(row, "depths"):
            scene = [mesh_name(run, row["mesh"]), f"{value(depth, 'bounces')}"]
            rate = {c["name"]: c["Msamples_s"] for c in value(depth, "contestants")}
            rates.append(
                [
                    *scene,
                    *(interval(rate[c]) for c in names),
                    f"{printed['scene']}, {printed['triangles']}" if printed else NONE,
                ]
            )
            ratios.append(
                [
                    *scene,
                    f"{value(row, 'triangles')}",
                    *(interval(value(depth, "wavefront_over")[rival]) for rival in rivals),
                    f"{2 * value(depth, 'bounces') + 2}",
                    f"{value(depth, 'rays_per_sample'):.2f}",
                    f"{value(depth, 'reference_rays_per_sample'):.2f}",
                    f"{value(depth, 'turns')}",
                    f"{100 * value(depth, 'foreign_load'):.0f}",
                ]
            )
    summary = run.get("summary.wavefront_over")
    means = [
        [f"{value(mean, 'max_depth') - 1}", *(f"{mean[rival]:.2f}" for rival in rivals)]
        for mean in summary
    ]
    missing = (
        f"Omitted because they are not installed: {', '.join(sorted(absent))}." if absent else ""
    )
    tables = (
        Table(
            "Speed of the wavefront over each program, geometric means over the scenes",
            ["bounces", *rivals],
            means,
            [missing],
        ),
        Table(
            f"Speed of the wavefront over each program, by {run.clock} time",
            [
                "scene",
                "bounces",
                "triangles",
                *rivals,
                "rays per sample, at most",
                "wavefront, rays per sample",
                "Embree, rays per sample",
                "repetitions",
                "foreign load, %",
            ],
            ratios,
            [
                (
                    f"{size_of(run)}, {samples_of(run)} and repetition; every repetition measures"
                    " all programs. All surfaces are diffuse, without roulette; every hit has one"
                    " explicit connection, and light that paths hit is not counted. That makes 2"
                    " (b + 1) rays for b bounces, fewer where paths leave the scene or a light is"
                    " behind a surface. The megakernel replaces OptiX, which needs its maker's"
                    " GPUs: it is the same path tracer in one kernel, on the same device. The"
                    " Embree reference computes in double precision except for rays. Mitsuba 3 and"
                    " Cycles also count light that paths hit, and trace a last ray for it. A frame"
                    " of Cycles is a quarter of one render call for four frames. The processes of"
                    " Mitsuba and Cycles count as foreign load."
                ),
                mesh_note(run),
            ],
        ),
        Table(
            "Samples per second on the wall, Msamples/s",
            ["scene", "bounces", *names, "published scene"],
            rates,
            [f"Published: {run.get('experiment.published.source')}."],
        ),
    )
    rival = "Embree reference" if "Embree reference" in rivals else rivals[0]
    speeds_text = ", ".join(f"{mean[rival]:.2f}" for mean in summary)
    lengths = ", ".join(f"{value(mean, 'max_depth') - 1}" for mean in summary)
    finding = (
        f"The wavefront is {speeds_text} times as fast as the {rival} at {lengths} bounces"
        f" (geometric means over {len(run.get('rows'))} scenes)."
    )
    return finding, tables


def questions(run):
    """The question that each changed setting answers."""
    changed = {entry["name"].split("=")[0] for entry in value(run.get("rows")[0], "frames")}
    return [
        [setting, question]
        for setting, question in run.prose("questions").items()
        if setting in changed
    ]


def ablations(run):
    frames, builds = [], []
    for row in run.get("rows"):
        head = [mesh_name(run, row["mesh"]), f"{value(row, 'triangles')}"]
        for entry in value(row, "frames"):
            frames.append(
                head
                + [
                    entry["name"],
                    ratio(value(entry, "speed_over_defaults")),
                    interval(value(entry, "wall_ms")),
                    number(value(entry, "processor_ms.value")),
                    f"{value(entry, 'features')}",
                    f"{value(entry, 'binary_bytes') / 1024:.0f}",
                    f"{value(entry, 'bytes_per_path')}",
                    f"{value(entry, 'launches')}",
                    number(value(entry, "compile_ms")),
                ]
            )
        usual = value(row, "builds")[0]
        for entry in value(row, "builds"):
            builds.append(
                head
                + [
                    entry["name"],
                    ratio(value(entry, "speed_over_defaults")),
                    interval(value(entry, "wall_ms")),
                    f"{value(entry, 'sah'):.2f}",
                    f"{value(entry, 'sah') / value(usual, 'sah'):.3f}",
                    f"{value(entry, 'depth')}",
                    f"{value(entry, 'bytes_peak') / value(row, 'triangles'):.0f}",
                ]
            )
    tables = (
        Table("Settings that are changed, one at a time", ["setting", "question"], questions(run)),
        Table(
            "Frames with one setting changed",
            [
                "scene",
                "triangles",
                "setting",
                "speed over defaults",
                "frame, wall ms",
                "processor ms",
                "features",
                "binaries, KiB",
                "bytes per path",
                "launches",
                "compilation, ms",
            ],
            frames,
            [
                (
                    f"{size_of(run)}, {samples_of(run)} and frame, path tracing by MIS with"
                    f" roulette. Speeds by {run.clock} time, repetition by repetition, medians with"
                    " 95 % intervals. A setting that equals the device's default shows how far"
                    " equal configurations differ. Every frame has a session of its own, because a"
                    " session keeps its memory and the first one is up to 7 % slower. Compilation"
                    " takes less with cached kernels."
                ),
                mesh_note(run),
            ],
        ),
        Table(
            "Building the hierarchy with one setting changed",
            [
                "scene",
                "triangles",
                "setting",
                "speed over defaults",
                "wall ms",
                "SAH cost",
                "SAH cost over defaults",
                "depth",
                "peak bytes per triangle",
            ],
            builds,
        ),
    )
    return ablation_finding(run), tables


def ablation_finding(run):
    """The settings that make frames slowest and fastest, geometric means over the scenes."""
    names = [entry["name"] for entry in value(run.get("rows")[0], "frames")][1:]
    speeds = {
        setting: geometric_mean(
            [
                value(entry, "speed_over_defaults.value")
                for row in run.get("rows")
                for entry in value(row, "frames")
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


FRAME_TABLES = {"ablations": ablations, "bounces": bounces, "frame_times": frame_times}
