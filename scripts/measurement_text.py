# SPDX-License-Identifier: MIT
"""Names, ranges and provenance, which the pages of measurements share. A dash takes the place of a
figure that one side does not report."""

import re

from cells import NONE
from run_document import commit_of, value

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


def reported(entry, key, form="{:.3g}", scale=1.0):
    return form.format(scale * entry[key]) if key in entry else NONE


def name(text):
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


def geometric_mean(values):
    import numpy

    return float(numpy.exp(numpy.mean(numpy.log(values))))


def provenance(run):
    """Device, host, commit and load of a measurement, a line each."""
    context = run.get("context")
    units = "threads" if run.clock == "processor" else "compute units"
    load = ", ".join(f"{average:.1f}" for average in value(context, "load_average_start"))
    lines = [
        (
            f"commit {commit_of(context)},"
            f" profile {run.get('experiment.profile')}, {value(context, 'finished_at')}"
        ),
        (
            f"device: {value(context, 'device.name')},"
            f" {value(context, 'device.compute_units')} {units}"
        ),
        (
            f"host: {value(context, 'host.cpu')}, {value(context, 'host.cores')} cores;"
            f" {value(context, 'host.compiler')}"
        ),
        (
            f"load average at the start {load}; foreign processes used"
            f" {100 * value(context, 'cpu_use.foreign'):.0f} % of the processors"
        ),
    ]
    if run.get("absent"):
        lines.append(f"omitted because they are missing: {', '.join(map(name, run.get('absent')))}")
    return lines
