# SPDX-License-Identifier: MIT
"""Plots of the hierarchy's measurements."""

import numpy
from matplotlib import pyplot

from measurement_tables import KINDS, name
from plots import COLOURS, MARKERS
from run_document import value


def save(figure, run, stem):
    """STEM.svg in the run's folder; equal input gives equal files (plots.py)."""
    path = run.folder / f"{stem}.svg"
    temporary = path.with_name(path.name + ".tmp.svg")
    figure.savefig(temporary, metadata={"Date": None}, bbox_inches="tight")
    pyplot.close(figure)
    temporary.replace(path)


def build_time(run):
    figure, axes = pyplot.subplots(figsize=(6.4, 5.2), layout="constrained")
    rows = sorted(run.get("rows"), key=lambda row: value(row, "triangles"))
    triangles = numpy.array([value(row, "triangles") for row in rows], dtype=float)
    for i, contestant in enumerate(value(rows[0], "contestants")):
        times = [next(c for c in value(row, "contestants") if c["name"] == contestant["name"])[f"{run.clock}_ms"] for row in rows]
        middle = numpy.array([value(time, "value") for time in times])
        reach = [middle - [value(time, "low") for time in times], [value(time, "high") for time in times] - middle]
        exponent = run.get("summary.exponents").get(contestant["name"])
        label = name(contestant["name"])
        if exponent:
            label += f", k = {value(exponent, 'value'):.3f} [{value(exponent, 'low'):.3f}, {value(exponent, 'high'):.3f}]"
        axes.errorbar(triangles, middle, yerr=reach, color=COLOURS[i % len(COLOURS)], marker=MARKERS[i % len(MARKERS)],
                      markersize=4, linewidth=1.0, linestyle="-" if contestant["side"] == "ours" else "--", label=label)
    axes.set(xscale="log", yscale="log", xlabel="triangles", ylabel=f"{run.clock} time of a build, ms (all threads)",
             title=f"{run.get('experiment.title')}: medians with 95 % intervals, time = c · triangles$^k$")
    axes.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=2)
    save(figure, run, "build_time")
    return {"build_time": f"{run.clock.capitalize()} time of a build against triangles, with the exponents of power laws and their 95 % "
                          "intervals over the meshes; dashed: Embree."}


def speeds(run):
    """A panel for each kind of ray: speeds over Embree, a row for each mesh."""
    figure, panels = pyplot.subplots(1, len(KINDS), figsize=(11, 0.26 * len(run.get("rows")) + 1.8), sharey=True,
                                     layout="constrained")
    meshes = [name(row["mesh"]) for row in run.get("rows")]
    for panel, kind in zip(panels, KINDS):
        entries = [next(k for k in value(row, "kinds") if k["kind"] == kind) for row in run.get("rows")]
        for i, contestant in enumerate(value(entries[0], "contestants")):
            if value(contestant, "speed_over_embree.low") == value(contestant, "speed_over_embree.high"):
                continue  # what all are relative to
            found = [next(c for c in value(entry, "contestants") if c["name"] == contestant["name"])["speed_over_embree"]
                     for entry in entries]
            middle = numpy.array([value(speed, "value") for speed in found])
            reach = [middle - [value(speed, "low") for speed in found], [value(speed, "high") for speed in found] - middle]
            label = name(contestant["name"]) if contestant["side"] == "ours" else "Embree by sixteens"
            panel.errorbar(middle, range(len(meshes)), xerr=reach, linestyle="none", color=COLOURS[i % len(COLOURS)],
                           marker=MARKERS[i % len(MARKERS)], markersize=4, linewidth=1.0, label=label)
        panel.axvline(1, color="black", linewidth=0.8, linestyle=":")
        panel.set(title=name(kind), xscale="log", xlabel="speed / Embree ray by ray")
        if run.clock == "processor":
            ticks = [0.2, 0.5, 1, 2, 5]
            panel.set_xticks(ticks, [f"{tick:g}" for tick in ticks], minor=False)
            panel.minorticks_off()
    panels[0].set_yticks(range(len(meshes)), meshes)
    panels[0].invert_yaxis()
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, fontsize=8, loc="upper center", bbox_to_anchor=(0.5, 0), ncols=len(labels))
    save(figure, run, "speeds")
    return {"speeds": f"Rays per {run.clock} second over Embree's, ray by ray (1), by mesh and kind of ray, medians with 95 % "
                      "intervals."}


def animation(run):
    """Above the time of an update, below the rays' speed, a column for each mesh."""
    rows = run.get("rows")
    figure, panels = pyplot.subplots(2, len(rows), figsize=(1.2 + 3.2 * len(rows), 5.2), sharex="col", squeeze=False,
                                     layout="constrained")
    for column, row in zip(panels.T, rows):
        frames = value(row, "frames")
        x = [value(frame, "frame") for frame in frames]
        for panel, what, key in zip(column, ("updates", "rays"), (f"{run.clock}_ms", "speed_over_build")):
            for i, entry in enumerate(value(frames[0], what)):
                found = [value(next(e for e in frame[what] if e["name"] == entry["name"]), key) for frame in frames]
                middle = numpy.array([value(f, "value") for f in found])
                reach = [middle - [value(f, "low") for f in found], [value(f, "high") for f in found] - middle]
                # A way to update has one colour in both.
                place = [u["name"] for u in value(frames[0], "updates")].index(entry["name"])
                panel.errorbar(x, middle, yerr=reach, color=COLOURS[place], marker=MARKERS[place], markersize=4, linewidth=1.0,
                               label=name(entry["name"]))
        column[0].set(title=f"{name(row['mesh'])}, {value(row, 'triangles')} triangles", yscale="log", ylabel=f"{run.clock} ms of an update")
        column[1].set(xlabel="frame", ylabel="speed of diffuse rays")
    handles, labels = panels[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, fontsize=8, loc="upper center", bbox_to_anchor=(0.5, 0), ncols=2)
    save(figure, run, "animation")
    return {"animation": f"{run.clock.capitalize()} time of an update by frame, and the rate of diffuse rays after it over that of the usual "
                         "builder's tree, built anew."}


PLOTS = {"bvh_animation": animation, "bvh_build": build_time, "ray_rates": speeds}
