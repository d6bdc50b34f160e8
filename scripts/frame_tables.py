# SPDX-License-Identifier: MIT
"""Tables of what frames take, in Markdown."""

from measurement_tables import NONE, interval, mesh_name, name, number
from run_document import value
from tables import Table

TRACING = ("intersect_nearest", "intersect_any")


def size_of(run):
    width, height = run.get("experiment.settings.size")
    return f"{width} x {height} pixels"


def rays_per_second(row, kind):
    """Mrays/s of tracing rays of one kind, by the median."""
    return value(row, f"rays.{kind}") / value(row, f"{kind}_ms.value") * 1e-3


def thesis_table(run):
    """Tables 4.2 and 4.3, and below every row of the thesis ours."""
    columns = run.get("experiment.published.columns")
    published = {row["mesh"]: row for row in run.get("experiment.published.rows")}
    rows = []
    for row in run.get("rows"):
        printed = published.get(run.get("stand_ins").get(row["mesh"], row["mesh"]))
        if printed:
            rows.append([printed["scene"], "thesis", printed["triangles"],
                         *(f"{value(printed['figures'], c['key'])}" for c in columns)])
        ours = {f"{kind}_ms": number(value(row, f"{kind}_ms.value")) for kind in ("primary", "shadow", "secondary", "frame")}
        ours.update({f"{kind}_Mrays_s": f"{rays_per_second(row, kind):.3g}" for kind in ("primary", "secondary")})
        ours["secondary_rays"] = f"{value(row, 'rays.secondary'):.0f}"
        rows.append([mesh_name(run, row["mesh"]), "here", f"{value(row, 'triangles')}", *(ours[c["key"]] for c in columns)])
    hardware = "; ".join(sorted({c["hardware"] for c in columns}))
    return Table(f"As printed ({run.get('experiment.published.source')}; 1024 x 768, {hardware}), and here ({size_of(run)})",
                 ["scene", "", "triangles", *(c["title"] for c in columns)], rows)


def frame_rows(run):
    for row in run.get("rows"):
        yield [mesh_name(run, row["mesh"]), value(row, "surfaces"), f"{value(row, 'triangles')}",
               *(interval(value(row, f"{kind}_ms")) for kind in ("primary", "shadow", "secondary", "frame")),
               interval(value(row, "frame_processor_ms")), f"{value(row, 'rays.frame'):.0f}",
               f"{value(row, 'rays.frame') / value(row, 'frame_ms.value') * 1e-3:.3g}", number(value(row, "bvh_ms")),
               number(value(row, "compile_ms")), f"{value(row, 'turns')}", f"{100 * value(row, 'foreign_load'):.0f}"]


def shares(row):
    """Percent of the device's time in a frame, by stage."""
    stages = {stage["name"]: value(stage, "ms.value") for stage in value(row, "stages")}
    together = sum(stages.values())
    return {stage: 100 * ms / together for stage, ms in stages.items()}


def stage_order(run):
    """Tracing first, then the others by their largest share; those that never reach one percent together."""
    largest = {}
    for row in run.get("rows"):
        for stage, share in shares(row).items():
            largest[stage] = max(share, largest.get(stage, 0))
    others = sorted((stage for stage in largest if stage not in TRACING), key=lambda stage: -largest[stage])
    return [*TRACING, *(stage for stage in others if largest[stage] >= 1)]


def frame_times(run):
    shown = stage_order(run)
    table = []
    for row in run.get("rows"):
        of_row = shares(row)
        cells = [of_row.get(stage, 0) for stage in shown]
        table.append([mesh_name(run, row["mesh"]), *(f"{cell:.1f}" for cell in cells), f"{100 - sum(cells):.1f}",
                      f"{sum(of_row.get(stage, 0) for stage in TRACING):.1f}"])
    tables = (
        thesis_table(run),
        Table("Medians with 95 % intervals", [
            "scene", "surfaces and lights", "triangles", "primary, ms", "shadow, ms", "secondary, ms", "frame, ms",
            "frame, processor ms", "rays in a frame", "Mrays/s in a frame", "hierarchy, ms", "compiling, ms", "turns",
            "others' load, %"], list(frame_rows(run))),
        Table("Figure 4.21: share of the device's time in a frame, %",
              ["scene", *map(name, shown), "others", "tracing, in all"], table),
    )
    what = (f"{size_of(run)}, {run.get('experiment.settings').get('spp', 1)} sample per pixel. Primary, shadow and secondary: time "
            "of the stages that trace these rays (intersect nearest, intersect any), streams read and written, of explicit "
            "paths; secondary are the rays after the first bounce: what nearest hits take with it more than without, turn by "
            "turn. Frame: wall time of a sample per pixel by MIS, roulette from the first bounce; processor ms: of all "
            "threads together, which other load hardly changes. Hierarchy (wall time) and compiling, first enqueue "
            "included (less where kernels are in a cache), come before and are not in it.")
    return what, tables


def bounces(run):
    """Figure 4.22, a row for each scene and length of path."""
    published = {row["mesh"]: row for row in run.get("experiment.published.rows")}
    names = [c["name"] for c in value(run.get("rows")[0], "depths.0.contestants")]
    rivals = names[1:]
    rates, ratios, absent = [], [], set()
    for row in run.get("rows"):
        printed = published.get(run.get("stand_ins").get(row["mesh"], row["mesh"]))
        absent.update(value(row, "absent_peers"))
        for depth in value(row, "depths"):
            scene = [mesh_name(run, row["mesh"]), f"{value(depth, 'bounces')}"]
            rate = {c["name"]: c["Msamples_s"] for c in value(depth, "contestants")}
            rates.append([f"{printed['scene']}, {printed['triangles']}" if printed else NONE, *scene,
                          *(interval(rate[c]) for c in names)])
            ratios.append([*scene, f"{value(row, 'triangles')}", *(interval(value(depth, "wavefront_over")[rival]) for rival in rivals),
                           f"{2 * value(depth, 'bounces') + 2}", f"{value(depth, 'rays_per_sample'):.2f}",
                           f"{value(depth, 'reference_rays_per_sample'):.2f}", f"{value(depth, 'turns')}",
                           f"{100 * value(depth, 'foreign_load'):.0f}"])
    means = [[f"{value(mean, 'max_depth') - 1}", *(f"{mean[rival]:.2f}" for rival in rivals)]
             for mean in run.get("summary.wavefront_over")]
    tables = (
        Table("How many times faster the wavefront is: geometric means over the scenes", ["bounces", *rivals], means),
        Table("Msamples/s, wall", ["thesis", "measured here", "bounces", *names], rates),
        Table(f"How many times faster the wavefront is, {run.clock} time", [
            "scene", "bounces", "triangles", *rivals, "rays per sample, at most", "wavefront, rays per sample",
            "Embree, rays per sample", "turns", "others' load, %"], ratios),
    )
    what = (f"{size_of(run)}, {run.get('experiment.settings').get('spp', 1)} sample(s) per pixel and turn. All surfaces are "
            "diffuse, no roulette, one explicit connection at every hit, light not counted where paths hit it: 2 (b + 1) rays "
            "for b bounces, fewer where paths leave the scene or a light lies behind a surface. Medians of turns with 95 % "
            f"intervals, all of them in every turn. As printed: {run.get('experiment.published.source')}. {run.get('experiment.claim')} "
            "OptiX needs its maker's GPUs: what stands in for it is the same path tracer as one kernel, on the same device, and "
            "the Embree reference, which computes in double precision but for the rays. Mitsuba 3 and Cycles also count light that "
            "paths hit, and send a last ray for it; of Cycles a frame is a quarter of one of Blender's render calls for four. Their processes count as others' "
            "load.")
    if absent:
        what += f" Not installed and left out: {', '.join(sorted(absent))}."
    return what, tables


def questions(run):
    """What each setting that this profile changes is about."""
    changed = {entry["name"].split("=")[0] for entry in value(run.get("rows")[0], "frames")}
    return [[setting, question] for setting, question in run.get("experiment.questions").items() if setting in changed]


def ablations(run):
    frames, builds = [], []
    for row in run.get("rows"):
        head = [mesh_name(run, row["mesh"]), f"{value(row, 'triangles')}"]
        for entry in value(row, "frames"):
            frames.append(head + [entry["name"], interval(value(entry, "speed_over_defaults")),
                                  interval(value(entry, "wall_ms")), number(value(entry, "processor_ms.value")),
                                  f"{value(entry, 'features')}", f"{value(entry, 'binary_bytes') / 1024:.0f}",
                                  f"{value(entry, 'bytes_per_path')}", f"{value(entry, 'launches')}",
                                  number(value(entry, "compile_ms"))])
        usual = value(row, "builds")[0]
        for entry in value(row, "builds"):
            builds.append(head + [entry["name"], interval(value(entry, "speed_over_defaults")),
                                  interval(value(entry, "wall_ms")), f"{value(entry, 'sah'):.2f}",
                                  f"{value(entry, 'sah') / value(usual, 'sah'):.3f}", f"{value(entry, 'depth')}",
                                  f"{value(entry, 'bytes_peak') / value(row, 'triangles'):.0f}"])
    tables = (
        Table("What is changed", ["setting", "question"], questions(run)),
        Table("Frames with one setting changed", [
            "scene", "triangles", "setting", "speed / defaults", "frame, ms", "processor ms", "features", "binaries, KiB",
            "bytes per path", "launches", "compiling, ms"], frames),
        Table("Building the hierarchy with one setting changed", [
            "scene", "triangles", "setting", "speed / defaults", "ms", "SAH", "/ defaults", "depth", "peak bytes per triangle"],
            builds),
    )
    what = (f"{size_of(run)}, {run.get('experiment.settings').get('spp', 1)} sample(s) per pixel and frame, path tracing by MIS "
            f"with roulette. Speeds by {run.clock} time, turn by turn, medians with 95 % intervals; a setting that is this "
            "device's default says how far apart equal things are measured. Every frame is of a session made for its turn: a session "
            "keeps its memory, and what was made first is up to 7 % slower. Compiling takes less where kernels are in a cache.")
    return what, tables


FRAME_TABLES = {"ablations": ablations, "bounces": bounces, "frame_times": frame_times}
