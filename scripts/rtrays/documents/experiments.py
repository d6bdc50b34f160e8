# SPDX-License-Identifier: MIT
"""Files of experiments and the file of claims, by name."""

import functools

from rtrays.documents.document import read_json
from rtrays.paths import EXPERIMENTS, ROOT


@functools.cache
def experiment_files():
    """Returns {name: path} of all JSON files below experiments/ but the schemas."""
    paths = sorted(EXPERIMENTS.rglob("*.json"))
    return {path.stem: path for path in paths if path.parent.name != "schema"}


def experiment(name):
    """Returns the document of an experiment, or an empty one if there is no such file."""
    path = experiment_files().get(name)
    return read_json(path) if path else {}


def experiment_path(name):
    """Returns the path of an experiment relative to the repository, for commands in texts."""
    path = experiment_files().get(name, EXPERIMENTS / f"{name}.json")
    return path.relative_to(ROOT).as_posix()


def claim_sections():
    """Returns the sections of the file of claims."""
    return read_json(experiment_files()["claims"])["sections"]
