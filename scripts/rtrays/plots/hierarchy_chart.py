# SPDX-License-Identifier: MIT
"""Chart of the hierarchy: builds and rays over Embree."""

from matplotlib import pyplot

from rtrays.documents.document import value
from rtrays.documents.intervals import geometric_mean, reach_of
from rtrays.documents.measurements import (
    KINDS,
    build_speeds,
    fastest_layout,
    our_builders,
    ray_mean,
    ray_speeds,
)
from rtrays.documents.run_document import Run
from rtrays.plots.chart import Chart
from rtrays.plots.style import COLOURS, MARKERS, save, series_style, set_ticks
from rtrays.tables.text import name, span


def draw_builds(axes, build):
    """Draws the speed of our builders over Embree by size of the mesh."""
    by_size = sorted({(value(row, "triangles"), row["mesh"]) for row in build.get("rows")})
    sizes = [size for size, _ in by_size]
    for i, builder in enumerate(our_builders(build)):
        found = {row["mesh"]: speed for row, speed in build_speeds(build, builder)}
        middle, reach = reach_of([found[mesh] for _, mesh in by_size])
        axes.errorbar(sizes, middle, yerr=reach, **series_style(i), label=name(builder))
    axes.set(
        xscale="log",
        xlabel="triangles of the mesh",
        title="build, over Embree medium quality",
        ylabel="speed over Embree",
        yscale="log",
    )


def draw_rays(axes, rates, layout):
    """Draws the speed of rays through a layout over Embree, a row for each mesh."""
    meshes = [row["mesh"] for row in rates.get("rows")]
    for i, kind in enumerate(KINDS):
        axes.plot(
            [value(speed, "value") for _, speed in ray_speeds(rates, kind, layout)],
            range(len(meshes)),
            MARKERS[i],
            color=COLOURS[i],
            markersize=4,
            label=name(kind),
            linestyle="none",
        )
    axes.set_yticks(range(len(meshes)), map(name, meshes), fontsize=7)
    axes.invert_yaxis()
    axes.set(
        xscale="log",
        title=f"rays through {name(layout)}, over Embree ray by ray",
        xlabel="speed over Embree",
    )


def hierarchy_figure(build, rates, layout):
    """Draws builds on the left and rays on the right."""
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(9, 4), layout="constrained")
    draw_builds(left, build)
    draw_rays(right, rates, layout)
    for axes, axis, line in ((left, left.yaxis, left.axhline), (right, right.xaxis, right.axvline)):
        line(1, color="black", linewidth=0.9, linestyle=":")
        set_ticks(axis.set_ticks, [0.3, 0.5, 0.7, 1, 1.5, 2])
        axis.set_ticks([], minor=True)
        axes.legend(fontsize=7, loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=2)
    return figure


def hierarchy_chart(folder):
    """Writes the chart of the hierarchy; returns it."""
    runs = ("bvh_build", "ray_rates")
    absent = [run for run in runs if not (folder / run / "run.json").is_file()]
    if absent:
        missing = f"The comparison of the BVH with Embree needs: {', '.join(absent)}."
        return Chart("hierarchy", "", missing=missing)
    build, rates = (Run(folder / run) for run in runs)
    layout = fastest_layout(rates)
    save(hierarchy_figure(build, rates, layout), folder / "hierarchy", ".svg", ".png")
    speeds = {
        builder: [value(speed, "value") for _, speed in build_speeds(build, builder)]
        for builder in our_builders(build)
    }
    best = max(speeds, key=lambda builder: geometric_mean(speeds[builder]))
    traced = [ray_mean(rates, kind, layout) for kind in KINDS]
    return Chart(
        "hierarchy",
        f"The device builds the BVH ({name(best)}) {geometric_mean(speeds[best]):.2f} times as fast"
        f" as Embree ({span(speeds[best])} by mesh), and traces rays {span(traced)} times as fast"
        " as Embree ray by ray, by kind of ray.",
        f"Ratios of {build.clock} times on one device; finding: geometric means over"
        f" {len(speeds[best])} and {len(rates.get('rows'))} meshes.",
    )
