# SPDX-License-Identifier: MIT
"""Documents of surveys: stability.json and convergence_control.json."""

from rtrays.documents.document import file_name, read_json


def read_survey(folder, file):
    """Returns the document of a finished survey. Replaces the blanks in the names of its images,
    which are named after its cases."""
    document = read_json(folder / file, f"rtrays-experiment run ... --out {folder}")
    for path in folder.glob("images/*.exr"):
        path.rename(path.with_name(file_name(path.name)))
    return document


def is_stiffness(document):
    """Whether every case of a survey of stability has a stiffness: it is then about stiffness."""
    measured = [row["stiffness"] for row in document["rows"] if "stiffness" in row]
    return bool(measured) and min(measured) > 0
