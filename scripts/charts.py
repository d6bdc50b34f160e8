# SPDX-License-Identifier: MIT
"""The three charts of the overview, each with a sentence that its numbers write, and the numbers
themselves."""

import dataclasses
import json
import re

import numpy
from matplotlib import pyplot

from claims import CLAIMS
from efficiency import base_curve, curve_named, gain
from frame_tables import rivals_of
from measurement_plots import reach_of
from measurement_tables import KINDS, build_speeds, fastest_layout, our_builders, ray_speeds
from measurement_text import geometric_mean, name, span
from plots import COLOURS, MARKERS, save, series_style
from run_document import EXPERIMENTS, Measurement, Run, value


@dataclasses.dataclass
class Chart:
    """STEM.svg and STEM.png of the overview; `missing` replaces them if a run is not there."""

    stem: str
    finding: str
    note: str = ""
    missing: str = ""


# --- gains of truncated BDPT over path tracing


def expected_gains():
    """{experiment: its expected_gain}, of every experiment of the repository that has one, in the
    thesis' order."""
    found = {}
    for path in EXPERIMENTS.rglob("*.json"):
        document = json.loads(path.read_text())
        if "expected_gain" in document and "name" in document:
            found[document["name"]] = (document.get("thesis", ""), document["expected_gain"])
    return {
        run: expected for run, (_, expected) in sorted(found.items(), key=lambda entry: entry[1][0])
    }


KEYS = {"time": "seconds", "samples": "spp"}


def thesis_range(run, key):
    """The thesis' gain as (low, high): the numbers of the claim's text, such as "3 to 4 times
    less", or the expected gain."""
    expected = expected_gains()[run][key]
    for section in json.loads(CLAIMS.read_text())["sections"]:
        for claim in section["claims"]:
            source = claim["figures"][0]
            if (source["run"], source["read"], source.get("of"), "curve" in source) == (
                run,
                "gain",
                KEYS[key],
                False,
            ):
                stated = re.search(r"([\d.]+) to ([\d.]+)", claim["thesis"])
                if stated and float(stated[1]) == expected:
                    return float(stated[1]), float(stated[2])
    return expected, expected


def gain_entries(folder):
    """For every run there is: (name, thesis' ranges and our gains by "time" and "samples")."""
    entries = []
    for name_of_run, expected in expected_gains().items():
        if not (folder / name_of_run / "run.json").is_file():
            continue
        run = Run(folder / name_of_run)
        curve = curve_named(run, f"{expected['algorithm']}.mis")
        if curve is None:
            continue
        noise, base = run.get("reference.noise_floor.mse"), base_curve(run)
        entries.append(
            (
                name_of_run,
                {key: thesis_range(name_of_run, key) for key in KEYS},
                {key: gain(base, curve, noise, KEYS[key]) for key in KEYS},
            )
        )
    return entries


def gains_chart(folder):
    entries = gain_entries(folder)
    if not entries:
        return Chart(
            "gains",
            "",
            missing=(
                "The gains of truncated BDPT need one of these runs:"
                f" {', '.join(expected_gains())}."
            ),
        )
    figure, axes = pyplot.subplots(figsize=(8, 0.62 * len(entries) + 1.5), layout="constrained")
    lines = numpy.arange(len(entries))
    for i, (key, words) in enumerate((("time", "equal device time"), ("samples", "equal samples"))):
        middle, reach = reach_of([ours[key] for _, _, ours in entries])
        offset = 0.16 * (2 * i - 1)
        ranges = [thesis[key] for _, thesis, _ in entries]
        axes.hlines(
            lines + offset,
            [low / 1.02 for low, _ in ranges],
            [high * 1.02 for _, high in ranges],
            color=COLOURS[i],
            alpha=0.35,
            linewidth=7,
            label=f"thesis, {words}",
        )
        axes.errorbar(
            middle,
            lines + offset,
            xerr=reach,
            linestyle="none",
            marker=MARKERS[i],
            color=COLOURS[i],
            markersize=5,
            linewidth=1.4,
            capsize=3,
            label=f"measured, {words}",
        )
    axes.axvline(1, color="black", linewidth=0.9, linestyle=":")
    ends = [
        end
        for _, thesis, ours in entries
        for key in KEYS
        for end in (*thesis[key], value(ours[key], "low"), value(ours[key], "high"), 1)
    ]
    limits = min(ends) / 1.15, max(ends) * 1.15
    ticks = [
        tick for tick in (0.25, 0.5, 1, 2, 3, 4, 6, 8, 12, 16) if limits[0] <= tick <= limits[1]
    ]
    axes.set_xscale("log")
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.minorticks_off()
    axes.set_yticks(lines, [name(run) for run, _, _ in entries])
    axes.set(
        xlabel="gain of truncated BDPT over path tracing (MIS), times",
        xlim=limits,
        ylim=(len(entries) - 0.5, -0.5),
    )
    figure.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, 0), ncols=4)
    save(figure, folder / "gains", ".svg", ".png")
    gaining = [ours["time"] for _, _, ours in entries if value(ours["time"], "low") > 1]
    reached = sum(value(ours["time"], "high") >= thesis["time"][0] for _, thesis, ours in entries)
    measured = [value(ours["time"], "value") for _, _, ours in entries]
    finding = (
        f"In equal device time truncated BDPT has {span(measured)} times the efficiency of path"
        f" tracing (MIS): a gain in {len(gaining)} of {len(entries)} scenes, as large as the thesis"
        f" claims in {reached or 'none'}."
    )
    return Chart("gains", finding, "Markers: measured, with 95 % intervals; bars: the thesis.")


# --- samples per second


def peer_entries(run):
    """(peer, bounces, geometric mean, speeds by scene) of every peer and length of path; the
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


def is_peer(rival):
    return rival != "megakernel"


def speeds_chart(folder):
    if not (folder / "bounces/run.json").is_file():
        return Chart(
            "speeds", "", missing="The speed against other renderers needs the run bounces."
        )
    run = Measurement(folder / "bounces")
    entries = [entry for entry in peer_entries(run) if is_peer(entry[0])]
    lengths = list(dict.fromkeys(bounces for _, bounces, _, _ in entries))
    peers = list(dict.fromkeys(peer for peer, *_ in entries))
    figure, axes = pyplot.subplots(figsize=(8, 3.4), layout="constrained")
    for i, peer in enumerate(peers):
        own = [entry for entry in entries if entry[0] == peer]
        x = numpy.arange(len(own)) + 0.16 * (i - (len(peers) - 1) / 2)
        axes.vlines(
            x,
            [min(scenes) for *_, scenes in own],
            [max(scenes) for *_, scenes in own],
            color=COLOURS[i],
            linewidth=1,
        )
        axes.plot(
            numpy.repeat(x, [len(scenes) for *_, scenes in own]),
            [s for *_, scenes in own for s in scenes],
            ".",
            color=COLOURS[i],
            markersize=4,
            alpha=0.6,
        )
        axes.plot(
            x,
            [mean for _, _, mean, _ in own],
            MARKERS[i],
            color=COLOURS[i],
            markersize=7,
            label=peer,
        )
    axes.axhline(1, color="black", linewidth=0.9, linestyle=":")
    axes.set_yscale("log")
    ticks = [0.5, 0.7, 1, 1.5, 2, 3]
    axes.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.minorticks_off()
    axes.set_xticks(
        range(len(lengths)),
        [f"{bounces} bounce{'s' if bounces > 1 else ''}" for bounces in lengths],
    )
    axes.set(ylabel="speed of RTRays over the peer")
    axes.grid(axis="x", visible=False)
    figure.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, 0), ncols=2)
    save(figure, folder / "speeds", ".svg", ".png")
    texts = [
        f"{span([mean for p, _, mean, _ in entries if p == peer])} times as fast as {peer}"
        for peer in peers
    ]
    finding = (
        f"At {lengths[0]} to {lengths[-1]} bounces the wavefront is"
        f" {', '.join(texts[:-1])}{' and ' if texts[:-1] else ''}{texts[-1]}."
    )
    return Chart(
        "speeds",
        finding,
        (
            f"Samples per second by {run.clock} time, all programs on one device. Large markers:"
            f" geometric means over {len(run.get('rows'))} scenes; dots and lines: the scenes."
        ),
    )


# --- the hierarchy


def hierarchy_chart(folder):
    missing = [
        run for run in ("bvh_build", "ray_rates") if not (folder / run / "run.json").is_file()
    ]
    if missing:
        return Chart(
            "hierarchy",
            "",
            missing=f"The comparison of the BVH with Embree needs: {', '.join(missing)}.",
        )
    build, rates = (Measurement(folder / run) for run in ("bvh_build", "ray_rates"))
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(9, 4), layout="constrained")
    builders, layout = our_builders(build), fastest_layout(rates)
    by_size = sorted({(value(row, "triangles"), row["mesh"]) for row in build.get("rows")})
    for i, builder in enumerate(builders):
        found = {row["mesh"]: speed for row, speed in build_speeds(build, builder)}
        middle, reach = reach_of([found[mesh] for _, mesh in by_size])
        left.errorbar(
            [size for size, _ in by_size],
            middle,
            yerr=reach,
            **series_style(i),
            label=name(builder),
        )
    left.set(
        xscale="log",
        xlabel="triangles of the mesh",
        title="build, over Embree medium quality",
        ylabel="speed over Embree",
        yscale="log",
    )
    meshes = [row["mesh"] for row in rates.get("rows")]
    for i, kind in enumerate(KINDS):
        speeds = [value(speed, "value") for _, speed in ray_speeds(rates, kind, layout)]
        right.plot(
            speeds,
            range(len(meshes)),
            MARKERS[i],
            color=COLOURS[i],
            markersize=4,
            label=name(kind),
            linestyle="none",
        )
    right.set_yticks(range(len(meshes)), map(name, meshes), fontsize=7)
    right.invert_yaxis()
    right.set(
        xscale="log",
        title=f"rays through {name(layout)}, over Embree ray by ray",
        xlabel="speed over Embree",
    )
    for axes, axis, line in ((left, left.yaxis, left.axhline), (right, right.xaxis, right.axvline)):
        line(1, color="black", linewidth=0.9, linestyle=":")
        ticks = [0.3, 0.5, 0.7, 1, 1.5, 2]
        axis.set_ticks(ticks, [f"{tick:g}" for tick in ticks])
        axis.set_ticks([], minor=True)
        axes.legend(fontsize=7, loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=2)
    save(figure, folder / "hierarchy", ".svg", ".png")
    best = max(
        builders,
        key=lambda b: geometric_mean([value(s, "value") for _, s in build_speeds(build, b)]),
    )
    built = [value(speed, "value") for _, speed in build_speeds(build, best)]
    traced = [value(rates.get("summary.geometric_means"), f"{kind}.{layout}") for kind in KINDS]
    finding = (
        f"The device builds the BVH ({name(best)}) {geometric_mean(built):.2f} times as fast as"
        f" Embree ({span(built)} by mesh), and traces rays {span(traced)} times as fast as Embree"
        " ray by ray, by kind of ray."
    )
    return Chart(
        "hierarchy",
        finding,
        (
            f"Ratios of {build.clock} times on one device; finding: geometric means over"
            f" {len(built)} and {len(meshes)} meshes."
        ),
    )


CHARTS = (gains_chart, speeds_chart, hierarchy_chart)
