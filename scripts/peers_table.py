# SPDX-License-Identifier: MIT
"""The agreement.md of scripts/peers, from its agreement.json."""

import re


def percent(difference):
    return " | ".join(f"{100 * difference[key]:+.3f}" for key in ("value", "low", "high"))


def ratios(row):
    return ", ".join(f"{ratio:.5f}" for ratio in row)


def scene_rows(document):
    lines = ["| scene | renderer | tests | rejected | largest z | at | difference | from | to |",
             "| --- | --- | ---: | ---: | ---: | --- | ---: | ---: | ---: |"]
    missing, explained = {}, []
    for scene in document["scenes"]:
        for renderer, row in scene["results"].items():
            if "missing" in row:
                why = re.sub(r"^.*(Cycles cannot do that: |(?=Mitsuba has))|; it has .*$", "", row["missing"])
                missing.setdefault(f"{renderer}: {why}", []).append(scene["scene"])
                continue
            lines.append(f"| {scene['scene']} | {renderer} | {row['tests']} | {row['rejected']} | "
                         f"{row['largest_z']:.2f} | {row['largest_z_at']} | {percent(row['relative_difference'])} |")
            if row["explained"]:
                explained.append(f"* {scene['scene']}, {renderer}: {row['explained']}")
    if explained:
        lines += ["", "Differences found out:", "", *explained]
    if missing:
        lines += ["", "Not expressed, each an error of the exporter:", ""]
        lines += [f"* {why} ({', '.join(scenes)})" for why, scenes in missing.items()]
    return lines


def unit_rows(document):
    yield "| unit | peer | ratios | standard error |"
    yield "| --- | --- | --- | ---: |"
    for row in document["calibration"]:
        yield f"| {row['what']} | {row['peer']} | {ratios(row['ratio'])} | {max(row['standard_error']):.1e} |"


def rows_of_others(document):
    yield "| scene | max_depth | rejected | largest z | difference to Mitsuba | from | to | ratio to Tungsten |"
    yield "| --- | ---: | ---: | ---: | ---: | ---: | ---: | --- |"
    for row in document["of_others"]:
        original = row["original"]
        yield (f"| {row['scene']} | {row['max_depth']} | {original['rejected']} of {original['tests']} | "
               f"{original['largest_z']:.2f} | {percent(original['relative_difference'])} | "
               f"{ratios(row['tungsten']['mean_ratio'])} |")


def table(document):
    size, spp = document["size"], document["spp"]
    lines = [
        "Renderer, Mitsuba 3 and Blender's Cycles against the Embree reference, each from the same scene file: "
        f"{size} x {size} pixels, {spp} samples per pixel (the reference {2 * spp}); the peers' variance is the spread "
        f"of {document['runs']} seeds. Blocks of 16 x 16 pixels and the mean are tested per channel with Holm's "
        "correction at 0.01 for each image; the verdict divides that among all images. The last columns: difference of "
        f"the mean with its 99 % interval, %. Versions: {', '.join(document['versions'])}.",
        "", *scene_rows(document), "",
        "Units: mean radiance over the closed form (scenes/analytic), channels R, G, B, largest standard error.",
        "", *unit_rows(document)]
    if document["of_others"]:
        lines += ["", "Scene files of others: our importer against Mitsuba on the original file, and against the image "
                  "that came with it (Tungsten, mean ratios of R, G, B; that of veach-mis holds direct light alone).",
                  "", *rows_of_others(document)]
    return "\n".join(lines) + "\n"
