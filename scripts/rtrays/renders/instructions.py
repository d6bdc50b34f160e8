# SPDX-License-Identifier: MIT
"""Counts instructions per traced ray by callgrind, for hierarchy layouts and for Embree."""

import pathlib
import re
import tempfile

from rtrays.documents.document import read_json
from rtrays.programs import call
from rtrays.tables.table import Table

LAYOUTS = ("bvh2", "bvh2_stackless", "wide8")
QUERIES = {
    "nearest": ("intersect_nearest", "rtcIntersect1"),
    "shadow": ("intersect_any", "rtcOccluded1"),
}
LINE = re.compile(r"^\s*([\d,]+) \([ \d.]+%\)\s+\S*?:(\S+)")
KERNEL = re.compile(r"_pocl_kernel_(\w+)_workgroup")


def counted(command, folder, inclusive):
    """Runs a command under callgrind. Returns the instructions of each function; if `inclusive`,
    they include those of its callees."""
    output = folder / "callgrind.out"
    call(["valgrind", "--tool=callgrind", f"--callgrind-out-file={output}", *command])
    callees = f"--inclusive={'yes' if inclusive else 'no'}"
    text = call(["callgrind_annotate", "--threshold=100", callees, output])
    counts = {}
    for line in filter(None, map(LINE.match, text.splitlines())):
        counts[line[2]] = counts.get(line[2], 0) + int(line[1].replace(",", ""))
    return counts


def measure(program, scene, size, folder, more, inclusive):
    """Returns the instructions of each function and the number of rays of each query."""
    stats = folder / "stats.json"
    files = ["-o", folder / "image.exr", "--stats", stats]
    options = ["--spp", "1", "--size", size, "--quiet", *files, *more]
    counts = counted([program, scene, *options], folder, inclusive)
    rays = read_json(stats)["rays"]
    return counts, {
        "nearest": rays.get("nearest", 0) + rays.get("camera", 0) + rays.get("bounce", 0),
        "shadow": rays["shadow"],
    }


def traversals(renderer, reference, scene, size, folder):
    """Yields the name of each traversal and its instructions per ray for each query."""
    sampler = ["--set", "integrator.sampler=independent"]
    for layout in LAYOUTS:
        settings = [*sampler, "--set", f"device.bvh_layout={layout}"]
        counts, rays = measure(renderer, scene, size, folder, settings, False)
        kernels = {
            match[1]: count for name, count in counts.items() if (match := KERNEL.fullmatch(name))
        }
        yield layout, [kernels[kernel] / rays[query] for query, (kernel, _) in QUERIES.items()]
    counts, rays = measure(reference, scene, size, folder, ["--threads", "1"], True)
    yield "Embree, AVX2", [
        counts[function] / rays[query] for query, (_, function) in QUERIES.items()
    ]


def scene_rows(renderer, reference, scene, size, folder):
    """Returns the rows of a scene: instructions per ray, and their ratios to Embree's."""
    found = list(traversals(renderer, reference, scene, size, folder))
    embree = found[-1][1]
    name = pathlib.Path(scene).parent.name or scene
    return [
        [
            name,
            label,
            *(f"{x:.0f}" for x in values),
            *(f"{x / y:.2f}" for x, y in zip(values, embree)),
        ]
        for label, values in found
    ]


def instructions_markdown(renderer, reference, scenes, size):
    """Returns a Markdown table of the instructions per ray of all scenes."""
    with tempfile.TemporaryDirectory() as name:
        rows = [
            row
            for scene in scenes
            for row in scene_rows(renderer, reference, scene, size, pathlib.Path(name))
        ]
    heads = ["nearest hit", "shadow", "nearest over Embree", "shadow over Embree"]
    return (
        "# Instructions per ray\n\n"
        "Path tracing, one sample per pixel, all kernels compiled for AVX2, counted by callgrind."
        "\n\n" + Table("", ["scene", "traversal", *heads], rows).markdown()
    )
