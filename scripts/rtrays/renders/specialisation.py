# SPDX-License-Identifier: MIT
"""Measures the savings from specialised kernels."""

import pathlib
import statistics
import tempfile

from rtrays.documents.document import read_json
from rtrays.programs import call
from rtrays.tables.table import Table

VARIANTS = {"its own features": "scene", "all features": "all"}


def render(program, scene, features, spp, folder, caches):
    """Renders the scene; returns the report of the renderer, with the size of PoCL's kernels."""
    stats = folder / "stats.json"
    command = [
        program,
        scene,
        "-o",
        str(folder / "image.exr"),
        "--spp",
        str(spp),
        "--stats",
        str(stats),
        "--quiet",
        "--set",
        f"device.features={features}",
        "--set",
        "integrator.sampler=independent",
    ]
    environment = {
        "RTRAYS_CACHE_DIR": str(caches / "rtrays"),
        "POCL_CACHE_DIR": str(caches / "pocl"),
    }
    call(command, environment)
    report = read_json(stats)
    kernels = (caches / "pocl").rglob("*.so")
    return {**report, "kernel_bytes": sum(kernel.stat().st_size for kernel in kernels)}


def measure(program, scene, spp, repetitions):
    """Returns the reports of all repetitions for each variant."""
    reports = {variant: [] for variant in VARIANTS}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for _ in range(repetitions):
            for variant, features in VARIANTS.items():
                caches = folder / features
                (caches / "pocl").mkdir(parents=True, exist_ok=True)
                reports[variant].append(render(program, scene, features, spp, folder, caches))
    return reports


def figures(reports):
    """Returns label, value of each variant and number of decimals of every figure."""
    first = {variant: runs[0] for variant, runs in reports.items()}
    rate = {
        variant: statistics.median(run["samples"] / run["seconds"]["device"] for run in runs) / 1e6
        for variant, runs in reports.items()
    }
    return [
        ("features", {v: len(r["features"]) for v, r in first.items()}, 0),
        (
            "kernel binaries, KiB",
            {v: r["kernel_bytes"] / 1024 for v, r in first.items()},
            1,
        ),
        (
            "compile time, empty caches, s",
            {v: r["seconds"]["compile"] for v, r in first.items()},
            2,
        ),
        ("bytes per path", {v: r["bytes_per_path"] for v, r in first.items()}, 0),
        (
            "buffers without film, KiB",
            {
                v: sum(b["bytes"] for b in r["buffers"] if not b["name"].startswith("film.")) / 1024
                for v, r in first.items()
            },
            1,
        ),
        ("launches", {v: sum(s["launches"] for s in r["stages"]) for v, r in first.items()}, 0),
        ("Msamples/s, device time", rate, 3),
    ]


def specialisation_markdown(program, scene, spp, repetitions):
    """Returns a Markdown table of kernels with the scene's own features and with all features."""
    reports = measure(program, scene, spp, repetitions)
    report = next(iter(reports.values()))[0]
    rows = []
    for label, values, digits in figures(reports):
        own, everything = (values[variant] for variant in VARIANTS)
        texts = [f"{own:.{digits}f}", f"{everything:.{digits}f}", f"{own / everything:.2f}"]
        rows.append([label, *texts])
    return (
        f"`{scene}`, {spp} spp, median of {repetitions} interleaved runs;"
        f" {report['device']['name']}, commit {report['commit']}"
        f"{'-dirty' if report['dirty'] else ''}.\n\n"
        + Table("", ["figure", *VARIANTS, "ratio"], rows).markdown()
    )
