# SPDX-License-Identifier: MIT
"""Figures of claims from measurements of frames."""

from rtrays.documents.document import value
from rtrays.documents.intervals import exact, inverse, quotient, scaled
from rtrays.documents.measurements import TRACING
from rtrays.documents.run_document import Run
from rtrays.tables.text import name


def scene_name(row):
    """Returns the name of the scene of a row."""
    return name(value(row, "mesh"))


def frame_rate(folder, kind):
    """Mrays/s of a kind of ray, every scene."""
    for row in Run(folder).get("rows"):
        rays = 1e-3 * value(row, f"rays.{kind}")
        yield scene_name(row), quotient(exact(rays), value(row, f"{kind}_ms"))


def coherence(folder):
    """Rate of primary rays over that of secondary ones, every scene."""
    for row in Run(folder).get("rows"):
        rays = value(row, "rays.primary") / value(row, "rays.secondary")
        ratio_of_times = quotient(value(row, "secondary_ms"), value(row, "primary_ms"))
        yield scene_name(row), scaled(rays, ratio_of_times)


THESIS_FRAME = [1024, 768]


def frame_time(folder):
    """Milliseconds of wall time, every scene, if frames are as large as those of the thesis."""
    run = Run(folder)
    if run.get("experiment.settings.size") == THESIS_FRAME:
        for row in run.get("rows"):
            yield f"{scene_name(row)}, ms", value(row, "frame_ms")


def traced_share(folder):
    """Share of intersection in the device's time of a frame, every scene; the ends combine
    opposite ends of both parts."""
    for row in Run(folder).get("rows"):

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
        for row in Run(folder).get("rows")
        for depth in value(row, "depths")
        if depth["bounces"] == bounces
    ]
    yield from [max(found, key=lambda entry: value(entry[1], "value"))] if best and found else found


def ablation(folder, setting, best=False):
    """Speed of frames with a setting over those with the defaults: every scene, or the slowest,
    inverted."""
    found = [
        (scene_name(row), value(entry, "speed_over_defaults"))
        for row in Run(folder).get("rows")
        for entry in value(row, "frames")
        if entry["name"] == setting
    ]
    if best and found:
        scene, speed = min(found, key=lambda entry: value(entry[1], "value"))
        yield f"{scene}, defaults over it", inverse(speed)
    else:
        yield from found
