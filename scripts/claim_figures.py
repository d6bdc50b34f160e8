# SPDX-License-Identifier: MIT
"""Reads the figures that judge the claims of chapter 4 from finished runs; experiments/claims.json
names the readers.

Each reader takes a run's folder and yields (name, {"value", "low", "high"}), or an agreement as
run.json has it. A reader yields nothing if the run does not have the figure.
"""

import json

import numpy

import efficiency
from efficiency import DRAWS, base_curve
from run_document import Measurement, Run, RunError, algorithm_name, label, usable_points, value


def exact(number):
    return {"value": number, "low": number, "high": number}


def inverse(interval):
    return {
        "value": 1 / value(interval, "value"),
        "low": 1 / value(interval, "high"),
        "high": 1 / value(interval, "low"),
    }


def curve_of(run, name):
    for curve in run.curves:
        if value(curve, "id") == name:
            return curve
    raise RunError(f"{run.folder / 'run.json'}: no curve {name}")


def slopes(folder):
    """Slope of log RMSE against log spp, every curve."""
    for curve in Run(folder).curves:
        yield label(curve), value(curve, "slope")


def agreements(folder):
    """Agreement with the reference, every curve."""
    for curve in Run(folder).curves:
        yield label(curve), value(curve, "agreement")


def gain(folder, of, curve="truncated_bdpt.mis", over="path_tracing.mis"):
    """How many times the samples ("spp") or the device time ("seconds") of a curve another needs
    for equal error."""
    run = Run(folder)
    noise = run.get("reference.noise_floor.mse")
    yield (
        f"{label(curve_of(run, curve))} over {label(curve_of(run, over))}",
        efficiency.gain(curve_of(run, over), curve_of(run, curve), noise, of),
    )


def sample_cost(folder, curve="truncated_bdpt.mis", over="path_tracing.mis"):
    """Device time of a sample of a curve over that of another, medians over seeds with a
    bootstrap's interval."""
    run, generator = Run(folder), numpy.random.default_rng(1)

    def medians(name):
        point = usable_points(curve_of(run, name))[-1]
        seconds = numpy.array(
            [value(r, "seconds_device") for r in value(point, "repetitions")]
        ) / value(point, "spp")
        draws = seconds[generator.integers(0, len(seconds), (DRAWS, len(seconds)))]
        return numpy.median(seconds), numpy.median(draws, axis=1)

    (own, own_draws), (other, other_draws) = medians(curve), medians(over)
    low, high = numpy.quantile(own_draws / other_draws, [0.025, 0.975])
    yield "a sample of one over one of the other", {"value": own / other, "low": low, "high": high}


def edge_errors(folder, curve="path_tracing.mis"):
    """Mean squared error of the mean image at edges over that elsewhere; edges.json has it
    (tables.edges_document)."""
    path = folder / "edges.json"
    found = json.loads(path.read_text()) if path.exists() else {}
    if curve in found:
        yield "squared error at edges over elsewhere", found[curve]


def memory(folder, curve, form):
    """Bytes per path of a curve: how many "more" than path tracing, or how many "times" as many."""
    run = Run(folder)
    own = value(curve_of(run, curve), "render_report.bytes_per_path")
    base = value(base_curve(run), "render_report.bytes_per_path")
    if form == "more":
        yield "bytes per path beyond path tracing", exact(own - base)
    else:
        yield "bytes per path over path tracing", exact(own / base)


def control_gain(folder, scene):
    """Device time without convergence control over that with it, where it saves most."""
    path = folder / "convergence_control.json"
    rows = [row for row in value(json.loads(path.read_text()), "rows") if row["scene"] == scene]
    for algorithm in sorted({row["algorithm"] for row in rows}):
        best = min(
            (row for row in rows if row["algorithm"] == algorithm),
            key=lambda row: value(row, "seconds.value"),
        )
        yield f"{algorithm_name(algorithm)}, error {value(best, 'error'):g}", inverse(
            value(best, "seconds")
        )


def contestant_of(entry, name):
    return next((c for c in value(entry, "contestants") if c["name"] == name), None)


def published_order(folder, contestant):
    """Spearman's correlation of our build times with those of the thesis, over the meshes that
    replace its scenes."""
    run = Measurement(folder)
    published = {row["mesh"]: row["ms"]["thesis"] for row in run.get("experiment.published.rows")}
    named = run.get("stand_ins")
    pairs = [
        (
            published[named.get(row["mesh"], row["mesh"])],
            value(contestant_of(row, contestant), "processor_ms.value"),
        )
        for row in run.get("rows")
        if named.get(row["mesh"], row["mesh"]) in published
    ]
    if len(pairs) > 2:
        ranks = numpy.argsort(numpy.argsort(numpy.array(pairs), axis=0), axis=0)
        yield f"rank correlation over {len(pairs)} meshes", exact(
            float(numpy.corrcoef(ranks.T)[0, 1])
        )


def build_rate(folder, contestant):
    """Million triangles per second of wall time, the largest of all meshes."""
    rows = [
        (
            row["mesh"],
            1e-3 * value(row, "triangles"),
            inverse(value(contestant_of(row, contestant), "wall_ms")),
        )
        for row in Measurement(folder).get("rows")
    ]
    mesh, scale, rate = max(rows, key=lambda row: row[1] * row[2]["value"])
    yield f"{mesh.replace('_', ' ')}, Mtris/s", {key: scale * rate[key] for key in rate}


def build_gain(folder, contestant):
    """Speed over Embree's builder of medium quality, the largest of all meshes."""
    mesh, speed = max(
        (
            (row["mesh"], value(contestant_of(row, contestant), "speed_over_embree"))
            for row in Measurement(folder).get("rows")
        ),
        key=lambda entry: value(entry[1], "value"),
    )
    yield f"{mesh.replace('_', ' ')}, over Embree", speed


def scene_name(row):
    return value(row, "mesh").replace("_", " ")


def quotient(over, under):
    """Quotient of two intervals; its ends are the extreme quotients."""
    return {
        "value": value(over, "value") / value(under, "value"),
        "low": value(over, "low") / value(under, "high"),
        "high": value(over, "high") / value(under, "low"),
    }


def frame_rate(folder, kind):
    """Mrays/s of a kind of ray, every scene."""
    for row in Measurement(folder).get("rows"):
        rays = 1e-3 * value(row, f"rays.{kind}")
        yield scene_name(row), quotient(exact(rays), value(row, f"{kind}_ms"))


def coherence(folder):
    """Rate of primary rays over that of secondary ones, every scene."""
    for row in Measurement(folder).get("rows"):
        rays = value(row, "rays.primary") / value(row, "rays.secondary")
        ratio_of_times = quotient(value(row, "secondary_ms"), value(row, "primary_ms"))
        yield scene_name(row), {key: rays * ratio_of_times[key] for key in ratio_of_times}


THESIS_FRAME = [1024, 768]


def frame_time(folder):
    """Milliseconds of wall time, every scene, if frames are as large as those of the thesis."""
    run = Measurement(folder)
    if run.get("experiment.settings.size") == THESIS_FRAME:
        for row in run.get("rows"):
            yield f"{scene_name(row)}, ms", value(row, "frame_ms")


TRACING = ("intersect_nearest", "intersect_any")


def traced_share(folder):
    """Share of intersection in the device's time of a frame, every scene; the ends combine
    opposite ends of both parts."""
    for row in Measurement(folder).get("rows"):

        def together(end, tracing, stages=value(row, "stages")):
            return sum(
                value(stage, f"ms.{end}")
                for stage in stages
                if (stage["name"] in TRACING) == tracing
            )

        yield scene_name(row), {
            end: together(end, True) / (together(end, True) + together(other, False))
            for end, other in (("value", "value"), ("low", "high"), ("high", "low"))
        }


def wavefront_gain(folder, rival, bounces, best=False):
    """Samples per second of the wavefront over those of a rival at so many bounces: every scene,
    or the largest."""
    found = [
        (scene_name(row), value(depth, "wavefront_over")[rival])
        for row in Measurement(folder).get("rows")
        for depth in value(row, "depths")
        if depth["bounces"] == bounces
    ]
    yield from [max(found, key=lambda entry: value(entry[1], "value"))] if best and found else found


def ablation(folder, setting, best=False):
    """Speed of frames with a setting over those with the defaults: every scene, or the slowest,
    inverted."""
    found = [
        (scene_name(row), value(entry, "speed_over_defaults"))
        for row in Measurement(folder).get("rows")
        for entry in value(row, "frames")
        if entry["name"] == setting
    ]
    if best and found:
        name, speed = min(found, key=lambda entry: value(entry[1], "value"))
        yield f"{name}, defaults over it", inverse(speed)
    else:
        yield from found


def leaks(folder):
    """Number of rays from inside closed shapes that hit nothing, worst layout, for shapes that
    must be closed exactly."""
    for row in Measurement(folder).get("rows"):
        if row["check"] != "hits" and all(
            value(layout, "limit") == 0 for layout in value(row, "layouts")
        ):
            yield f"{row['mesh']}, {value(row, 'rays'):.3g} rays", exact(
                max(value(layout, "misses") for layout in row["layouts"])
            )


READERS = {
    reader.__name__: reader
    for reader in (
        ablation,
        agreements,
        build_gain,
        build_rate,
        coherence,
        control_gain,
        edge_errors,
        frame_rate,
        frame_time,
        gain,
        leaks,
        memory,
        published_order,
        sample_cost,
        slopes,
        traced_share,
        wavefront_gain,
    )
}
