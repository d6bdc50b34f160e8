# SPDX-License-Identifier: MIT
"""Measures how the speed of rtrays-mpi grows with the number of ranks on one machine."""

import os
import pathlib
import statistics
import tempfile

from rtrays.documents.document import read_json
from rtrays.programs import call
from rtrays.tables.table import Table


def render(program, scene, spp, ranks, folder):
    """Renders a reference with one thread for each rank; returns how the ranks shared the work."""
    stats = folder / "stats.json"
    call(["mpirun", "-n", ranks, "--bind-to", "none", program, "reference", scene,
          "-o", folder / "image.exr", "--state", folder / "film", "--spp", spp, "--threads", 1,
          "--stats", stats, "--quiet"])
    (folder / "film").unlink()
    return read_json(stats)["job"]


def measure(program, scene, spp, counts, repetitions):
    """Returns the records of all repetitions for each number of ranks, measured in turn."""
    jobs = {count: [] for count in counts}
    with tempfile.TemporaryDirectory() as name:
        for _ in range(repetitions):
            for count in counts:
                jobs[count].append(render(program, scene, spp, count, pathlib.Path(name)))
    return jobs


def row(count, jobs, seconds_of_one, cores):
    """Returns the cells of a number of ranks. The efficiency counts the cores that the ranks can
    use."""
    seconds = statistics.median(job["seconds"] for job in jobs)
    ranges = statistics.median(sum(rank["ranges"] for rank in job["ranks"]) for job in jobs)
    used = min(count, cores)
    return [
        str(count),
        f"{seconds:.2f}",
        f"{seconds_of_one / seconds:.2f}",
        f"{100 * seconds_of_one / seconds / used:.0f} %",
        f"{ranges:.0f}",
        str(jobs[0]["sums"]),
        f"{jobs[0]['summed_bytes'] / 2**20:.1f}",
    ]


def scaling_markdown(program, scene, spp, counts, repetitions):
    """Returns a Markdown table of seconds, speeds and messages for each number of ranks."""
    cores = len(os.sched_getaffinity(0))
    jobs = measure(program, scene, spp, [1, *(count for count in counts if count != 1)],
                   repetitions)
    seconds_of_one = statistics.median(job["seconds"] for job in jobs[1])
    version = call([program, "--version"]).strip()
    return (
        f"`{scene}`, {spp} spp, reference with one thread for each rank, {cores} cores, median of"
        f" {repetitions} interleaved runs; {version}.\n\n"
        + Table(
            "",
            ["ranks", "seconds", "speedup", "efficiency", "ranges", "sums", "MiB of a rank"],
            [row(count, runs, seconds_of_one, cores) for count, runs in jobs.items()],
        ).markdown()
    )
