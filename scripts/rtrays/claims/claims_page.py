# SPDX-License-Identifier: MIT
"""Page of all claims with their verdicts."""

from rtrays.claims.judge import all_counts, counts, summary
from rtrays.documents.experiments import claim_sections
from rtrays.documents.run_document import run_in
from rtrays.documents.verdicts import VERDICTS
from rtrays.pages.page import Page, TableBlock, markdown_name
from rtrays.pages.provenance import run_made_by
from rtrays.tables.cells import Lines, Link
from rtrays.tables.table import Table
from rtrays.tables.text import name


def overview(sections):
    """Returns the table of the verdicts by section."""
    shown = [word for word in VERDICTS if any(word in counts(claims) for _, claims in sections)]
    rows = [
        [title, *(str(counts(claims).get(word, "")) for word in shown)]
        for title, claims in sections
    ]
    return Table("Claims by verdict", ["section of the thesis", *shown], rows)


def run_rows(names, folder):
    """Yields where the figures come from, a row for every run that is there."""
    for run in names:
        found = run_in(folder / run)
        if found:
            made = run_made_by(found)
            link = Link(name(run), f"../{run}", markdown_name(folder / run))
            yield [link, *(made[key] for key in ("profile", "commit", "device", "finished"))]


def claim_row(judged, folder):
    """Returns claim, thesis, rule, measurements and verdict; the claim is a link to the run that
    decides it."""
    run = judged.runs[0] if judged.runs else ""
    claim = Link(judged.claim, f"../{run}", markdown_name(folder / run)) if run else judged.claim
    return [claim, judged.thesis, judged.rule, Lines(judged.measured), judged.verdict_text]


def claims_page(sections, folder):
    """Returns the page claims/claims.md: every claim with its verdict."""
    (folder / "claims").mkdir(exist_ok=True)
    names = sorted(
        {
            source["run"]
            for section in claim_sections()
            for claim in section["claims"]
            for source in claim["figures"]
        }
    )
    blocks = [TableBlock(overview(sections))]
    for title, claims in sections:
        columns = ["claim", "thesis", "holds if", "measured", "verdict"]
        rows = [claim_row(judged, folder) for judged in claims]
        blocks.append(TableBlock(Table(title, columns, rows, widths=(22, 14, 17, 33, 14))))
    columns = ["run", "profile", "commit", "device", "finished"]
    blocks.append(TableBlock(Table("Runs", columns, list(run_rows(names, folder)))))
    note = (
        "experiments/claims.json states them before the results. Numbers of the thesis are from its"
        " hardware, which its tables name; ours are from the runs at the end of the page."
    )
    return Page(
        folder / "claims",
        "claims.md",
        "The thesis' claims and their verdicts",
        summary(sections),
        blocks,
        claim=note,
        claim_head="Rules",
        verdicts=list(all_counts(sections)),
    )
