# SPDX-License-Identifier: MIT
"""The blocks of scripts/summary: claims, gains and speeds as small Markdown tables."""

import datetime
import json

from cells import NONE, Link, Table, interval, number
from charts import gain_entries, peer_entries
from claims import all_counts, judge_all, markdown_name, summary
from measurement_tables import KINDS, build_speeds, fastest_layout, our_builders
from measurement_text import geometric_mean, name, span
from run_document import Measurement, experiment_path, value


def claims(results):
    sections = judge_all(results / "chapter4")
    rows = [[word, str(count)] for word, count in all_counts(sections).items()]
    return f"{summary(sections)}\n\n{Table('Claims', ['verdict', 'claims'], rows).markdown()}"


def thesis_text(bounds):
    low, high = bounds
    return f"{low:g}" + (f" to {high:g}" if high > low else "")


def gains(results):
    """Gain of truncated BDPT over path tracing (MIS) by scene."""
    rows = [
        [
            name(run),
            thesis_text(thesis["samples"]),
            interval(ours["samples"], form="{:.2f}"),
            thesis_text(thesis["time"]),
            interval(ours["time"], form="{:.2f}"),
        ]
        for run, thesis, ours in gain_entries(results / "chapter4")
    ]
    return Table(
        "Gains", ["scene", "equal samples: thesis", "ours", "equal time: thesis", "ours"], rows
    ).markdown()


def speed_rows(folder):
    """Samples per second over the peers, a row each; columns are the lengths of path."""
    run = Measurement(folder / "bounces")
    entries = list(peer_entries(run))
    lengths = list(dict.fromkeys(bounces for _, bounces, _, _ in entries))
    rows = [
        [peer, *(f"{mean:.2f}" for other, _, mean, _ in entries if other == peer)]
        for peer in dict.fromkeys(entry[0] for entry in entries)
    ]
    heads = [f"{bounces} bounce{'s' if bounces > 1 else ''}" for bounces in lengths]
    return Table("Samples per second", ["RTRays, samples per second over", *heads], rows)


def ray_means(folder):
    """The layout, and {kind of ray: rays per second over Embree, mean over the meshes}."""
    rates = Measurement(folder / "ray_rates")
    layout, means = fastest_layout(rates), rates.get("summary.geometric_means")
    return layout, {kind: value(means, f"{kind}.{layout}") for kind in KINDS}


def build_ratios(folder):
    """Speed of BVH construction over Embree, {builder: one for each mesh}."""
    build = Measurement(folder / "bvh_build")
    return {
        builder: [value(speed, "value") for _, speed in build_speeds(build, builder)]
        for builder in our_builders(build)
    }


def embree_table(folder):
    """Rays and BVH construction over Embree, geometric means and ranges over the meshes."""
    layout, means = ray_means(folder)
    rows = [
        [f"{name(kind)} rays per second, {name(layout)}", f"{mean:.2f}"]
        for kind, mean in means.items()
    ]
    for builder, speeds in build_ratios(folder).items():
        rows.append(
            [f"BVH construction, {name(builder)}", f"{geometric_mean(speeds):.2f} ({span(speeds)})"]
        )
    return Table("Embree", ["RTRays over Embree", "geometric mean over meshes"], rows)


def gpu_runs(results):
    """The runs of measurements on GPUs: results/gpu/NAME/{ray_rates,bvh_build}."""
    for folder in sorted((results / "gpu").glob("*/ray_rates/run.json")):
        yield folder.parent.parent


def gpu_rows(results):
    """The range of Mrays/s by kind of ray and the fastest build of every GPU."""
    rows = []
    for folder in gpu_runs(results):
        rays = json.loads((folder / "ray_rates/run.json").read_text())
        device = value(rays, "context.device.name")
        for kind in KINDS:
            best = [
                max(value(c, "Mrays_s.value") for c in entry["contestants"] if c["side"] == "ours")
                for row in rays["rows"]
                for entry in row["kinds"]
                if entry["kind"] == kind
            ]
            rows.append(
                [
                    device,
                    f"{name(kind)} rays, Mrays/s",
                    f"{number(min(best))} to {number(max(best))}" if best else NONE,
                ]
            )
        if (folder / "bvh_build/run.json").is_file():
            builds = json.loads((folder / "bvh_build/run.json").read_text())["rows"]
            mtris = [
                1e-3 * row["triangles"] / value(c, "wall_ms.value")
                for row in builds
                for c in row["contestants"]
                if c["side"] == "ours"
            ]
            rows.append(
                [
                    device,
                    "BVH construction, Mtris/s, fastest builder",
                    f"up to {number(max(mtris))}",
                ]
            )
    return rows and Table("GPU", ["device", "measurement", "here"], rows)


def speeds(results):
    folder = results / "chapter4"
    tables = [speed_rows(folder), embree_table(folder), gpu_rows(results)]
    device = Measurement(folder / "bounces").get("context.device.name")
    return f"On {device} (above 1: RTRays is faster):\n\n" + "\n".join(
        table.markdown() for table in tables if table
    )


def speeds_at_a_glance(results):
    """The speeds for README: peers by path length, rays and hierarchy over Embree, GPUs."""
    folder = results / "chapter4"
    peers = speed_rows(folder)
    peers.rows = [row for row in peers.rows if "scalar" not in row[0] and row[0] != "megakernel"]
    rays = span(ray_means(folder)[1].values())
    builds = span([geometric_mean(speeds) for speeds in build_ratios(folder).values()])
    text = f"Over Embree: {rays} of its rays per second, {builds} of its speed of BVH construction."
    for row in (gpu_rows(results) or Table("", [], [])).rows:
        if row[1].startswith("diffuse"):
            text += f" On an {row[0]}: {row[2]} million diffuse rays per second."
    return f"{peers.markdown()}\n{text}\n"


def claims_sentence(results):
    return summary(judge_all(results / "chapter4")) + "\n"


def durations(results):
    """Minutes of every stored run of chapter 4, from start to end."""
    rows = []
    for path in sorted((results / "chapter4").glob("*/run.json")):
        run = json.loads(path.read_text())
        start, end = (
            datetime.datetime.fromisoformat(value(run, f"context.{key}").rstrip("Z"))
            for key in ("started_at", "finished_at")
        )
        minutes = f"{(end - start).total_seconds() / 60:.0f}"
        profile, cores = value(run, "experiment.profile"), value(run, "context.host.cores")
        rows.append([name(path.parent.name), profile, str(cores), minutes])
    return Table("Durations", ["experiment", "profile", "cores", "minutes"], rows).markdown()


def minutes(context):
    """Minutes from the start to the finish of a run, or a dash if its document has no times."""
    if "started_at" not in context:
        return NONE
    start, end = (
        datetime.datetime.fromisoformat(context[key].rstrip("Z"))
        for key in ("started_at", "finished_at")
    )
    return number((end - start).total_seconds() / 60, 2)


def run_rows(results):
    """A row for every folder of chapter 4 and every measurement of a GPU."""
    for folder in sorted([*results.glob("chapter4/*/"), *results.glob("gpu/*/*/")]):
        document = next((path for path in folder.glob("*.json") if path.name != "edges.json"), None)
        if document is None:
            continue
        run = json.loads(document.read_text())
        context = run.get("context", run)
        command = "control" if folder.name == "convergence_control" else "run"
        profile = run.get("experiment", run)["profile"]
        place = folder.relative_to(results).as_posix()
        page = markdown_name(folder)
        cell = Link(place, place, page) if (folder / page).exists() else place
        command = (
            f"`rtrays-experiment {command} {experiment_path(folder.name)} --profile {profile}`"
        )
        yield [cell, command, minutes(context), value(context, "commit")[:12]]


def reference_rows(results):
    """A row for every engine of the references, by their manifest."""
    references = json.loads((results / "references/manifest.json").read_text())["references"]
    for engine in sorted({entry["engine"] for entry in references.values()}):
        seconds = [entry["seconds"] for entry in references.values() if entry["engine"] == engine]
        command = f"`scripts/references --engine {engine}`"
        yield [f"references, {len(seconds)} images", command, f"{sum(seconds) / 60:.0f}", NONE]


def runs(results):
    """Every stored run: its page, command, minutes and commit."""
    rows = [*run_rows(results), *reference_rows(results)]
    return Table("Runs", ["folder and page", "command", "minutes", "commit"], rows).markdown()


BLOCKS = {
    "claims": claims,
    "claims_sentence": claims_sentence,
    "gains": gains,
    "runs": runs,
    "speeds": speeds,
    "speeds_at_a_glance": speeds_at_a_glance,
    "durations": durations,
}
