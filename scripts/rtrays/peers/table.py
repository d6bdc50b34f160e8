# SPDX-License-Identifier: MIT
"""Builds the agreement.md of scripts/peers from its agreement.json."""

import re

from rtrays.tables.table import Table

# The parts of an exporter's error that name the file and the alternatives.
AROUND = re.compile(
    r"^.*(by Cycles: |Cycles cannot do that: |(?=Mitsuba (has|supports)))"
    r"|; (it has|supported are).*$"
)


def percent(difference):
    """Returns the cells of a relative difference and its interval, in percent."""
    return [f"{100 * difference[key]:+.3f}" for key in ("value", "low", "high")]


def ratios(row):
    """Returns the ratios of the channels as a cell."""
    return ", ".join(f"{ratio:.5f}" for ratio in row)


def results_of(document):
    """Yields scene, renderer and result of all comparisons."""
    for scene in document["scenes"]:
        for renderer, result in scene["results"].items():
            yield scene["scene"], renderer, result


def scene_table(document):
    """Returns the table of scenes."""
    rows = [
        [
            scene,
            renderer,
            str(result["tests"]),
            str(result["rejected"]),
            f"{result['largest_z']:.2f}",
            result["largest_z_at"],
            *percent(result["relative_difference"]),
        ]
        for scene, renderer, result in results_of(document)
        if "missing" not in result
    ]
    heads = ["tests", "rejected", "largest z", "at", "difference", "from", "to"]
    return Table("", ["scene", "renderer", *heads], rows)


def explained_lines(document):
    """Returns the lines of the explained differences."""
    lines = [
        f"* {scene}, {renderer}: {result['explained']}"
        for scene, renderer, result in results_of(document)
        if result.get("explained")
    ]
    return lines and ["Explained differences:", "", *lines, ""]


def missing_lines(document):
    """Returns the lines of the scenes that a peer cannot express."""
    missing = {}
    for scene, renderer, result in results_of(document):
        if "missing" in result:
            why = AROUND.sub("", result["missing"])
            missing.setdefault(f"{renderer}: {why}", []).append(scene)
    lines = [f"* {why} ({', '.join(scenes)})" for why, scenes in missing.items()]
    head = "Scenes that a peer cannot express, with the exporter's error:"
    return lines and [head, "", *lines, ""]


def unit_table(document):
    """Returns the table of calibrated units."""
    rows = [
        [row["what"], row["peer"], ratios(row["ratio"]), f"{max(row['standard_error']):.1e}"]
        for row in document["calibration"]
    ]
    return Table("", ["unit", "peer", "ratios", "standard error"], rows)


def third_party_table(document):
    """Returns the table of third-party scenes."""
    rows = []
    for row in document["of_others"]:
        original = row["original"]
        rows.append(
            [
                row["scene"],
                str(row["max_depth"]),
                f"{original['rejected']} of {original['tests']}",
                f"{original['largest_z']:.2f}",
                *percent(original["relative_difference"]),
                ratios(row["tungsten"]["mean_ratio"]),
            ]
        )
    heads = ["rejected", "largest z", "difference to Mitsuba", "from", "to", "ratio to Tungsten"]
    return Table("", ["scene", "max_depth", *heads], rows)


def table(document):
    """Returns the text of agreement.md."""
    size, spp = document["size"], document["spp"]
    lines = [
        "This table compares the renderer, Mitsuba 3 and Blender's Cycles with the Embree "
        f"reference. All render the same scene file with {size} x {size} pixels and {spp} samples "
        f"per pixel; the reference has {2 * spp}. The variance of a peer is estimated from the "
        f"spread of {document['runs']} seeds. Each image is tested per channel, in blocks of "
        "16 x 16 pixels and in its mean, with Holm's correction at 0.01. The verdict divides this "
        "level among all images. The last columns are the relative difference of the mean and its "
        f"99 % interval, in percent. Versions: {', '.join(document['versions'])}.",
        "",
        scene_table(document).markdown(),
        *explained_lines(document),
        *missing_lines(document),
        "Units: ratio of the mean radiance to the closed form (scenes/analytic) for the channels "
        "R, G, B, and the largest standard error.",
        "",
        unit_table(document).markdown(),
    ]
    if document["of_others"]:
        lines += [
            "Third-party scenes: our import is compared with Mitsuba's rendering of the original "
            "file, and with the Tungsten image distributed with the scene (ratios of the means of "
            "R, G, B). The Tungsten image of veach-mis contains direct light only.",
            "",
            third_party_table(document).markdown(),
        ]
    return "\n".join(lines)
