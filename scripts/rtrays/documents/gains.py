# SPDX-License-Identifier: MIT
"""Gains of truncated BDPT over path tracing: those of the thesis and ours."""

import re

from rtrays.documents.curves import base_curve, curve_named
from rtrays.documents.efficiency import gain
from rtrays.documents.experiments import claim_sections, experiment, experiment_files
from rtrays.documents.run_document import Run


def expected_gains():
    """Returns {experiment: its expected gain} of every experiment that has one, in the thesis'
    order."""
    documents = [experiment(name) for name in experiment_files()]
    found = [document for document in documents if "expected_gain" in document]
    return {
        document["name"]: document["expected_gain"]
        for document in sorted(found, key=lambda document: document.get("thesis", ""))
    }


KEYS = {"time": "seconds", "samples": "spp"}


def thesis_range(run, key):
    """Returns the thesis' gain as (low, high): the numbers of the claim's text, such as "3 to 4
    times less", or the expected gain."""
    expected = expected_gains()[run][key]
    for section in claim_sections():
        for claim in section["claims"]:
            source = claim["figures"][0]
            if (source["run"], source["read"], source.get("of"), "curve" in source) == (
                run,
                "gain",
                KEYS[key],
                False,
            ):
                stated = re.search(r"([\d.]+) to ([\d.]+)", claim["thesis"])
                if stated and float(stated[1]) == expected:
                    return float(stated[1]), float(stated[2])
    return expected, expected


def gain_entries(folder):
    """Returns (name, thesis' ranges, our gains) of every finished run; ranges and gains are by
    "time" and "samples"."""
    entries = []
    for name_of_run, expected in expected_gains().items():
        if not (folder / name_of_run / "run.json").is_file():
            continue
        run = Run(folder / name_of_run)
        curve = curve_named(run, f"{expected['algorithm']}.mis")
        if curve is None:
            continue
        noise, base = run.get("reference.noise_floor.mse"), base_curve(run)
        entries.append(
            (
                name_of_run,
                {key: thesis_range(name_of_run, key) for key in KEYS},
                {key: gain(base, curve, noise, KEYS[key]) for key in KEYS},
            )
        )
    return entries
