# SPDX-License-Identifier: MIT
"""Curves of a run: their names, times, and the points that count."""

from rtrays.documents.document import value

NAMES = {"bdpt": "BDPT", "truncated_bdpt": "truncated BDPT", "mis": "MIS"}


def algorithm_name(name):
    """Returns the name of an algorithm in text; the harness' "path_tracing explicit" has one,
    too."""
    return " ".join(NAMES.get(word, word.replace("_", " ")) for word in name.split(" "))


def is_other(curve):
    """Whether another renderer made the images of a curve."""
    return "engine" in curve


def own_curves(run):
    """Returns the curves of this renderer."""
    return [curve for curve in run.curves if not is_other(curve)]


def clock_of(run):
    """The time by which curves are compared: "device", or "wall" if another renderer takes part,
    whose device time nobody knows."""
    return "wall" if any(map(is_other, run.curves)) else "device"


def label(curve):
    """Returns the name of a curve in tables and legends: its own, that of another renderer, or one
    from its id."""
    if "label" in curve or is_other(curve):
        return curve.get("label") or value(curve, "engine")
    algorithm, _, settings = value(curve, "id").partition(".")
    shown = [
        NAMES.get(setting, setting.replace("_", " ").replace("=", " = "))
        for setting in settings.split(",")
    ]
    return f"{algorithm_name(algorithm)} ({', '.join(shown)})"


def curve_named(run, name):
    """Returns the curve with this id, or None."""
    return next((curve for curve in run.curves if value(curve, "id") == name), None)


def base_curve(run):
    """Returns the curve of path tracing with both strategies; without it the last curve, of this
    renderer if there is one."""
    return curve_named(run, "path_tracing.mis") or (own_curves(run) or run.curves)[-1]


# Settings that both curves of a gain should share.
SHARED = ("integrator.sampler", "integrator.light_selection", "integrator.sphere_sampling")


def base_for(run, curve):
    """Returns path tracing with both strategies under the curve's own sampler, light selection and
    sphere sampling, or else the base curve of the run. A curve is not its own base unless it is
    that of the run. Other settings of the base are those of the run's base curve."""
    base = base_curve(run)

    def shared(other):
        return [value(other, "settings").get(key) for key in SHARED]

    def others(other):
        return {key: each for key, each in value(other, "settings").items() if key not in SHARED}

    if is_other(curve) or is_other(base):
        return base
    own = (
        other
        for other in own_curves(run)
        if other is not curve
        and (value(other, "algorithm"), value(other, "strategies")) == ("path_tracing", "mis")
        and shared(other) == shared(curve)
        and others(other) == others(base)
    )
    return base if curve is base else next(own, base)


def has_several_bases(run):
    """Whether a curve has another base than that of the run."""
    return any(base_for(run, curve) is not base_curve(run) for curve in run.curves)


def shown_curves(run):
    """Returns the curves whose images have figures: path tracing by MIS and truncated BDPT with
    its defaults, or all curves of a run that has neither. The viewer has the images of all
    curves."""
    shown = [
        curve
        for curve in run.curves
        if value(curve, "id") in ("truncated_bdpt.mis", "path_tracing.mis")
    ]
    return shown or run.curves


def is_blind(curve):
    """Whether the algorithm misses light of the scene: light tracing does not see into mirrors and
    glass."""
    if is_other(curve):
        return False
    features = value(curve, "render_report.features")
    return value(curve, "algorithm") == "light_tracing" and "delta" in features


def is_stratified(curve):
    """Whether the samples fill the domain evenly, so that errors may fall faster than with
    independent samples."""
    return not is_other(curve) and value(curve, "settings").get("integrator.sampler") == "sobol"


def has_pilot(curve):
    """Whether a pilot chose the number of light paths."""
    return "pilot" in curve.get("render_report", {})


def pilot_seconds(curve, clock="device"):
    """Returns the time of the pilot by a clock; zero without one. Documents of version 0.1.0 have
    only the device time, which counts as the other one."""
    if not has_pilot(curve):
        return 0.0
    key = "seconds" if clock == "device" or lacks_wall_time_of_pilot(curve) else "seconds_wall"
    return value(curve, f"render_report.pilot.{key}")


def lacks_wall_time_of_pilot(curve):
    """Whether the curve's wall times exclude the pilot, as those of version 0.1.0 do."""
    return has_pilot(curve) and "seconds_wall" not in value(curve, "render_report.pilot")


def seconds(curve, entry, clock):
    """Returns the seconds of a point or repetition by `clock`, "device" or "wall"; they include the
    pilot.

    Documents of version 0.1.0 have no wall time of the pilot, neither its own nor in the seconds of
    points. There the pilot's device time is added.
    """
    missing = clock == "wall" and lacks_wall_time_of_pilot(curve)
    return value(entry, f"seconds_{clock}") + (pilot_seconds(curve) if missing else 0.0)


def usable_points(curve):
    """Returns the points before the first one that the reference's noise dominates; curves stop
    there."""
    points = []
    for point in value(curve, "points"):
        if value(point, "noise_dominates"):
            break
        points.append(point)
    return points


def is_usable(curve, point):
    """Whether a point of a curve, or an entry with its samples, is before the reference's noise
    dominates."""
    return value(point, "spp") in [value(each, "spp") for each in usable_points(curve)]


def left_out(curves, points_of):
    """Returns the sentence that counts the points of curves that a plot leaves out; empty without
    any. `points_of` returns the points of a curve that the plot would show otherwise."""
    counts = [
        sum(not is_usable(curve, point) for point in points_of(curve)) for curve in curves
    ]
    points, ended = sum(counts), sum(map(bool, counts))
    if not points:
        return ""
    return (
        f"{points} point{'s' * (points > 1)} of {ended} curve{'s' * (ended > 1)} left out: a curve"
        " ends where the reference's noise exceeds 10 % of its MSE."
    )
