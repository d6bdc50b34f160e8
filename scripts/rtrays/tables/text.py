# SPDX-License-Identifier: MIT
"""Names, ranges and notes, which the tables and pages of measurements share."""

import re

from rtrays.documents.document import value
from rtrays.tables.cells import NONE

PROCEDURAL = re.compile(r"(scattered|landscape|hall|court|city)_\d+")
MARK = " †"


def builder(entry):
    """Returns the name of a builder, and the builder that made the tree where the first one gave
    up (bvh/builder.h)."""
    gave_up = "method" in entry and not entry["name"].startswith(entry["method"])
    return name(entry["name"]) + (f", by {name(entry['method'])}" if gave_up else "")


GIVING_UP = (
    "If clustering makes a tree too deep, binned SAH builds it instead; its figures are then those"
    " of binned SAH."
)


def reported(entry, key, form):
    """Returns a figure as text, or a dash if the contestant does not report it."""
    return form.format(entry[key]) if key in entry else NONE


def name(text):
    """Returns an identifier as words."""
    return text.replace("_", " ")


def mesh_name(run, mesh):
    """Returns the name of a mesh; procedural ones have a mark, which mesh_note explains."""
    return name(mesh) + (MARK if PROCEDURAL.match(mesh) else "")


def mesh_note(run):
    """Returns the note below a table that says which meshes are procedural and which models they
    replace."""
    texts = []
    for mesh in dict.fromkeys(
        row["mesh"] for row in run.get("rows") if PROCEDURAL.match(row["mesh"])
    ):
        replaced = run.get("stand_ins").get(mesh)
        texts.append(
            f"{name(mesh)} (procedural)"
            + (f" replaces {name(replaced)}, which is missing" if replaced else "")
        )
    return f"†: {'; '.join(texts)}." if texts else ""


def span(values, form="{:.2f}"):
    """Returns "from A to B", or one number if both read the same."""
    low, high = form.format(min(values)), form.format(max(values))
    return low if low == high else f"{low} to {high}"


def absent_note(run):
    """Returns the sentence that lists the renderers that are not installed, or nothing."""
    absent = {peer for row in run.get("rows") for peer in value(row, "absent_peers")}
    return f"Omitted because they are not installed: {', '.join(sorted(absent))}." if absent else ""


def size_of(run):
    """Returns the size of the frames of a measurement as text."""
    width, height = run.get("experiment.settings.size")
    return f"{width} x {height} pixels"


def samples_of(run):
    """Returns the samples per pixel of a measurement as text."""
    samples = run.get("experiment.settings").get("spp", 1)
    return f"{samples} sample{'s' if samples > 1 else ''} per pixel"


def bounces_text(bounces):
    """Returns "1 bounce", "2 bounces" and so on."""
    return f"{bounces} bounce{'s' if bounces > 1 else ''}"


def listed(texts):
    """Returns texts as a list in a sentence: "a, b and c"."""
    return ", ".join(texts[:-1]) + (" and " if texts[:-1] else "") + texts[-1]
