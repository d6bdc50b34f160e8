# SPDX-License-Identifier: MIT
"""Blocks of claims and gains, and the table of all blocks."""

from rtrays.claims.judge import all_counts, judge_all, summary
from rtrays.documents.gains import gain_entries
from rtrays.lint.stages import stage_rows
from rtrays.paths import RESULTS
from rtrays.summary.runs import durations, runs
from rtrays.summary.speeds import renderers, speeds, speeds_at_a_glance
from rtrays.tables.cells import interval
from rtrays.tables.table import Table
from rtrays.tables.text import name


def claims_sentence():
    """Returns the counts of the verdicts as a sentence."""
    return summary(judge_all(RESULTS / "chapter4")) + "\n"


def claims():
    """Returns the counts of the verdicts as a sentence and a table."""
    sections = judge_all(RESULTS / "chapter4")
    rows = [[word, str(count)] for word, count in all_counts(sections).items()]
    return f"{summary(sections)}\n\n{Table('Claims', ['verdict', 'claims'], rows).markdown()}"


def thesis_text(bounds):
    """Returns the thesis' gain as text: a number or a range."""
    low, high = bounds
    return f"{low:g}" + (f" to {high:g}" if high > low else "")


def gains():
    """Returns the gains of truncated BDPT over path tracing (MIS) by scene."""
    rows = [
        [
            name(run),
            thesis_text(thesis["samples"]),
            interval(ours["samples"], form="{:.2f}"),
            thesis_text(thesis["time"]),
            interval(ours["time"], form="{:.2f}"),
        ]
        for run, thesis, ours in gain_entries(RESULTS / "chapter4")
    ]
    return Table(
        "Gains", ["scene", "equal samples: thesis", "ours", "equal time: thesis", "ours"], rows
    ).markdown()


def stages():
    """Returns what each stage may touch, from the heads of the kernels."""
    return Table("Stages", ["stage", "reads", "writes", "fills"], stage_rows()).markdown()


BLOCKS = {
    "claims": claims,
    "claims_sentence": claims_sentence,
    "gains": gains,
    "renderers": renderers,
    "runs": runs,
    "speeds": speeds,
    "speeds_at_a_glance": speeds_at_a_glance,
    "durations": durations,
    "stages": stages,
}
