# SPDX-License-Identifier: MIT
"""Builds the agreement.md of scripts/peers from its agreement.json."""

import re


def percent(difference):
    """Returns the cells of a relative difference and its interval, in percent."""
    return " | ".join(f"{100 * difference[key]:+.3f}" for key in ("value", "low", "high"))


def ratios(row):
    return ", ".join(f"{ratio:.5f}" for ratio in row)


def scene_rows(document):
    """Returns the table of scenes, then the explained differences and the missing features."""
    lines = ["| scene | renderer | tests | rejected | largest z | at | difference | from | to |",
             "| --- | --- | ---: | ---: | ---: | --- | ---: | ---: | ---: |"]
    missing, explained = {}, []
    for scene in document["scenes"]:
        for renderer, row in scene["results"].items():
            if "missing" in row:
                why = re.sub(r"^.*(by Cycles: |Cycles cannot do that: |(?=Mitsuba (has|supports)))|"
                             r"; (it has|supported are).*$", "",
                             row["missing"])
                missing.setdefault(f"{renderer}: {why}", []).append(scene["scene"])
                continue
            lines.append(f"| {scene['scene']} | {renderer} | {row['tests']} | {row['rejected']} | "
                         f"{row['largest_z']:.2f} | {row['largest_z_at']} | "
                         f"{percent(row['relative_difference'])} |")
            if row["explained"]:
                explained.append(f"* {scene['scene']}, {renderer}: {row['explained']}")
    if explained:
        lines += ["", "Explained differences:", "", *explained]
    if missing:
        lines += ["", "Scenes that a peer cannot express, with the exporter's error:", ""]
        lines += [f"* {why} ({', '.join(scenes)})" for why, scenes in missing.items()]
    return lines


def unit_rows(document):
    yield "| unit | peer | ratios | standard error |"
    yield "| --- | --- | --- | ---: |"
    for row in document["calibration"]:
        yield (f"| {row['what']} | {row['peer']} | {ratios(row['ratio'])} | "
               f"{max(row['standard_error']):.1e} |")


def rows_of_others(document):
    """Yields the table of third-party scenes."""
    yield ("| scene | max_depth | rejected | largest z | difference to Mitsuba | from | to | "
           "ratio to Tungsten |")
    yield "| --- | ---: | ---: | ---: | ---: | ---: | ---: | --- |"
    for row in document["of_others"]:
        original = row["original"]
        yield (f"| {row['scene']} | {row['max_depth']} | "
               f"{original['rejected']} of {original['tests']} | "
               f"{original['largest_z']:.2f} | {percent(original['relative_difference'])} | "
               f"{ratios(row['tungsten']['mean_ratio'])} |")


def table(document):
    size, spp = document["size"], document["spp"]
    lines = [
        "This table compares the renderer, Mitsuba 3 and Blender's Cycles with the Embree "
        f"reference. All render the same scene file with {size} x {size} pixels and {spp} samples "
        f"per pixel; the reference has {2 * spp}. The variance of a peer is estimated from the "
        f"spread of {document['runs']} seeds. Each image is tested per channel, in blocks of "
        "16 x 16 pixels and in its mean, with Holm's correction at 0.01. The verdict divides this "
        "level among all images. The last columns are the relative difference of the mean and its "
        f"99 % interval, in percent. Versions: {', '.join(document['versions'])}.",
        "", *scene_rows(document), "",
        "Units: ratio of the mean radiance to the closed form (scenes/analytic) for the channels "
        "R, G, B, and the largest standard error.",
        "", *unit_rows(document)]
    if document["of_others"]:
        lines += ["", "Third-party scenes: our import is compared with Mitsuba's rendering of the "
                  "original file, and with the Tungsten image distributed with the scene (ratios "
                  "of the means of R, G, B). The Tungsten image of veach-mis contains direct light "
                  "only.",
                  "", *rows_of_others(document)]
    return "\n".join(lines) + "\n"
