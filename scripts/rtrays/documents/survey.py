# SPDX-License-Identifier: MIT
"""Runs of stability suites: stiff cases, and how algorithms fail as scenes become stiffer."""

from rtrays.documents.document import file_name


def rename_images(folder):
    """Replaces the blanks in the names of a suite's images, which are named after its cases."""
    for path in folder.glob("images/*.exr"):
        path.rename(path.with_name(file_name(path.name)))


def is_stiffness(run):
    """Whether every case of a stability suite has a stiffness: it is then about stiffness."""
    measured = [row["stiffness"] for row in run.get("rows") if "stiffness" in row]
    return bool(measured) and min(measured) > 0
