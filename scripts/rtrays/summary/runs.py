# SPDX-License-Identifier: MIT
"""Blocks of stored runs: their durations, pages and commands."""

import datetime

from rtrays.documents.document import read_json, value
from rtrays.documents.experiments import experiment_path
from rtrays.documents.run_document import Run, run_in
from rtrays.pages.page import markdown_name
from rtrays.paths import RESULTS
from rtrays.tables.cells import NONE, Link, number
from rtrays.tables.table import Table
from rtrays.tables.text import name


def minutes(context):
    """Returns the minutes from the start to the finish of a run."""
    start, end = (
        datetime.datetime.fromisoformat(value(context, key).rstrip("Z"))
        for key in ("started_at", "finished_at")
    )
    return (end - start).total_seconds() / 60


def durations():
    """Returns the minutes of every stored run of chapter 4 that records its times."""
    rows = []
    for path in sorted((RESULTS / "chapter4").glob("*/run.json")):
        run = Run(path.parent)
        if "started_at" in run.get("context"):
            rows.append(
                [
                    name(path.parent.name),
                    run.get("experiment.profile"),
                    str(run.get("context.host.cores")),
                    f"{minutes(run.get('context')):.0f}",
                ]
            )
    return Table("Durations", ["experiment", "profile", "cores", "minutes"], rows).markdown()


def run_rows():
    """Yields a row for every folder of chapter 4 and every measurement of a GPU."""
    for folder in sorted([*RESULTS.glob("chapter4/*/"), *RESULTS.glob("gpu/*/*/")]):
        run = run_in(folder)
        if run is None:
            continue
        context = run.get("context")
        place, page = folder.relative_to(RESULTS).as_posix(), markdown_name(folder)
        yield [
            Link(place, place, page) if (folder / page).exists() else place,
            f"`rtrays-experiment run {experiment_path(folder.name)}"
            f" --profile {run.get('experiment.profile')}`",
            number(minutes(context), 2) if "started_at" in context else NONE,
            value(context, "commit")[:12],
        ]


def reference_rows():
    """Yields a row for every engine of the references, by their manifest."""
    references = read_json(RESULTS / "references/manifest.json")["references"]
    for engine in sorted({entry["engine"] for entry in references.values()}):
        seconds = [entry["seconds"] for entry in references.values() if entry["engine"] == engine]
        command = f"`scripts/references --engine {engine}`"
        yield [f"references, {len(seconds)} images", command, f"{sum(seconds) / 60:.0f}", NONE]


def runs():
    """Returns every stored run: its page, command, minutes and commit."""
    rows = [*run_rows(), *reference_rows()]
    return Table("Runs", ["folder and page", "command", "minutes", "commit"], rows).markdown()
