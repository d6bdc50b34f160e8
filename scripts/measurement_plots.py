# SPDX-License-Identifier: MIT
"""Plots of the measurements of the hierarchy, and of references against each other."""

import numpy
from matplotlib import pyplot

from measurement_tables import KINDS
from measurement_text import name
from plots import COLOURS, MARKERS, series_style
from reference_tables import scene_rows
from run_document import value


def save(figure, run, stem):
    """Writes STEM.svg into the run's folder; equal input gives equal files (plots.py)."""
    path = run.folder / f"{stem}.svg"
    temporary = path.with_name(path.name + ".tmp.svg")
    figure.savefig(temporary, metadata={"Date": None}, bbox_inches="tight")
    pyplot.close(figure)
    temporary.replace(path)


def reach_of(intervals):
    """Returns the middles of intervals and how far their ends are from them, as errorbar takes
    them."""
    middle = numpy.array([value(entry, "value") for entry in intervals])
    return middle, [
        middle - [value(entry, "low") for entry in intervals],
        [value(entry, "high") for entry in intervals] - middle,
    ]


def build_time(run):
    figure, axes = pyplot.subplots(figsize=(6.4, 5.2), layout="constrained")
    rows = sorted(run.get("rows"), key=lambda row: value(row, "triangles"))
    triangles = numpy.array([value(row, "triangles") for row in rows], dtype=float)
    for i, contestant in enumerate(value(rows[0], "contestants")):
        middle, reach = reach_of(
            [
                next(c for c in value(row, "contestants") if c["name"] == contestant["name"])[
                    f"{run.clock}_ms"
                ]
                for row in rows
            ]
        )
        exponent = run.get("summary.exponents").get(contestant["name"])
        label = name(contestant["name"])
        if exponent:
            label += (
                f", k = {value(exponent, 'value'):.3f} [{value(exponent, 'low'):.3f},"
                f" {value(exponent, 'high'):.3f}]"
            )
        axes.errorbar(
            triangles,
            middle,
            yerr=reach,
            **series_style(i),
            linestyle="-" if contestant["side"] == "ours" else "--",
            label=label,
        )
    axes.set(
        xscale="log",
        yscale="log",
        xlabel="triangles",
        ylabel=f"{run.clock} time of a build, ms (all threads)",
        title="medians with 95 % intervals, time = c · triangles$^k$",
    )
    axes.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=2)
    save(figure, run, "build_time")
    return {
        "build_time": (
            f"{run.clock.capitalize()} time of a build against triangles, with the exponents of"
            " power laws and their 95 % intervals over the meshes; dashed: Embree."
        )
    }


def speeds(run):
    """A panel for each kind of ray: speeds over Embree, a row for each mesh."""
    figure, panels = pyplot.subplots(
        1,
        len(KINDS),
        figsize=(11, 0.26 * len(run.get("rows")) + 1.8),
        sharey=True,
        layout="constrained",
    )
    meshes = [name(row["mesh"]) for row in run.get("rows")]
    for panel, kind in zip(panels, KINDS):
        entries = [
            next(k for k in value(row, "kinds") if k["kind"] == kind) for row in run.get("rows")
        ]
        for i, contestant in enumerate(value(entries[0], "contestants")):
            if value(contestant, "speed_over_embree.low") == value(
                contestant, "speed_over_embree.high"
            ):
                continue  # Embree ray by ray, the denominator of all speeds
            middle, reach = reach_of(
                [
                    next(c for c in value(entry, "contestants") if c["name"] == contestant["name"])[
                        "speed_over_embree"
                    ]
                    for entry in entries
                ]
            )
            label = (
                name(contestant["name"])
                if contestant["side"] == "ours"
                else "Embree, 16 rays at a time"
            )
            panel.errorbar(
                middle,
                range(len(meshes)),
                xerr=reach,
                linestyle="none",
                **series_style(i),
                label=label,
            )
        panel.axvline(1, color="black", linewidth=0.8, linestyle=":")
        panel.set(title=name(kind), xscale="log", xlabel="speed over Embree ray by ray")
        if run.clock == "processor":
            ticks = [0.2, 0.5, 1, 2, 5]
            panel.set_xticks(ticks, [f"{tick:g}" for tick in ticks], minor=False)
            panel.minorticks_off()
    panels[0].set_yticks(range(len(meshes)), meshes)
    panels[0].invert_yaxis()
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(
        handles, labels, fontsize=8, loc="upper center", bbox_to_anchor=(0.5, 0), ncols=len(labels)
    )
    save(figure, run, "speeds")
    return {
        "speeds": (
            f"Rays per {run.clock} second over Embree ray by ray (1), by mesh and kind of ray,"
            " medians with 95 % intervals."
        )
    }


def animation(run):
    """The time of an update above, the speed of rays below; a column for each mesh."""
    rows = run.get("rows")
    figure, panels = pyplot.subplots(
        2,
        len(rows),
        figsize=(1.2 + 3.2 * len(rows), 5.2),
        sharex="col",
        squeeze=False,
        layout="constrained",
    )
    for column, row in zip(panels.T, rows):
        frames = value(row, "frames")
        x = [value(frame, "frame") for frame in frames]
        for panel, what, key in zip(
            column, ("updates", "rays"), (f"{run.clock}_ms", "speed_over_build")
        ):
            for entry in value(frames[0], what):
                middle, reach = reach_of(
                    [
                        value(next(e for e in frame[what] if e["name"] == entry["name"]), key)
                        for frame in frames
                    ]
                )
                # An update strategy has one colour in both panels.
                place = [u["name"] for u in value(frames[0], "updates")].index(entry["name"])
                panel.errorbar(
                    x,
                    middle,
                    yerr=reach,
                    **series_style(place),
                    label=name(entry["name"]),
                )
        column[0].set(
            title=f"{name(row['mesh'])}, {value(row, 'triangles')} triangles",
            yscale="log",
            ylabel=f"update, {run.clock} ms",
        )
        column[1].set(xlabel="frame", ylabel="speed of diffuse rays")
    handles, labels = panels[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, fontsize=8, loc="upper center", bbox_to_anchor=(0.5, 0), ncols=2)
    save(figure, run, "animation")
    return {
        "animation": (
            f"{run.clock.capitalize()} time of an update by frame, and the rate of diffuse rays"
            " after it over that of a tree rebuilt by the default builder."
        )
    }


DIFFERENCES = ("random", "grazing", "tied", "wrong")


def hits(run):
    """Share of fuzzed rays whose hit differs from Embree's, by mesh; the layout with the most
    differences counts."""
    rows = [row for row in run.get("rows") if row["check"] == "hits"]
    figure, axes = pyplot.subplots(figsize=(7.5, 0.24 * len(rows) + 1.6), layout="constrained")
    for i, kind in enumerate(DIFFERENCES):
        shares = [
            max(value(layout, kind) for layout in row["layouts"]) / value(row, "rays")
            for row in rows
        ]
        axes.plot(
            shares,
            range(len(rows)),
            linestyle="none",
            marker=MARKERS[i],
            color=COLOURS[i],
            markersize=5,
            label=kind,
            markerfacecolor="none" if kind == "wrong" else COLOURS[i],
        )
    axes.set_xscale("symlog", linthresh=1e-7)
    ticks = [0, 1e-6, 1e-4, 1e-2, 1]
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.minorticks_off()
    axes.set(xlim=(-2e-8, 1), xlabel="share of the rays (linear below 1e-7)")
    axes.axvline(1e-6, color="black", linewidth=0.8, linestyle=":")
    axes.set_yticks(range(len(rows)), [name(row["mesh"]) for row in rows])
    axes.invert_yaxis()
    axes.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.4, -0.14), ncols=4)
    save(figure, run, "hits")
    return {
        "hits": (
            "Share of fuzzed rays whose hit differs from Embree's, by the kind of ray, and share of"
            " wrong hits by brute force in double precision; dotted: the limit of wrong hits."
        )
    }


def mean_differences(run):
    """Difference of the mean of every image from Embree's reference, a row for each scene."""
    rows = scene_rows(run)
    figure, axes = pyplot.subplots(figsize=(7, 0.4 * len(rows) + 1.5), layout="constrained")
    found = {}
    for line, row in enumerate(rows):
        for pair in value(row, "pairs"):
            if value(pair, "against") == "embree":
                found.setdefault(value(pair, "image"), []).append(
                    (line, value(pair, "agreement.relative_difference"))
                )
    for i, (image, entries) in enumerate(found.items()):
        middle, reach = reach_of([entry for _, entry in entries])
        axes.errorbar(
            100 * middle,
            [line + 0.2 * (i - (len(found) - 1) / 2) for line, _ in entries],
            xerr=[100 * part for part in reach],
            linestyle="none",
            **series_style(i),
            label=image,
        )
    axes.axvspan(-0.1, 0.1, color="#0072B2", alpha=0.08, linewidth=0)
    axes.axvline(0, color="black", linewidth=0.8, linestyle=":")
    axes.set_xscale("symlog", linthresh=0.1)
    ticks = [-1, -0.1, 0, 0.1, 1]
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.set_yticks(range(len(rows)), [name(row["scene"]) for row in rows])
    axes.invert_yaxis()
    axes.set(xlabel="difference of the mean from Embree's reference, % (linear within 0.1 %)")
    axes.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.4, -0.22), ncols=4)
    save(figure, run, "mean_differences")
    return {
        "mean_differences": (
            "Difference of the mean of every image from Embree's reference with 99 % intervals;"
            " shaded: within 0.1 %."
        )
    }


PLOTS = {
    "bvh_animation": animation,
    "bvh_build": build_time,
    "ray_rates": speeds,
    "reference_agreement": mean_differences,
    "traversal": hits,
}
