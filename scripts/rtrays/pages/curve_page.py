# SPDX-License-Identifier: MIT
"""Page of a run of curves, with its tables and plots."""

from rtrays.documents.curves import clock_of
from rtrays.documents.error_parts import has_parts
from rtrays.documents.experiments import experiment_path
from rtrays.pages.curve_findings import explanation, finding
from rtrays.pages.page import Figure, Page, TableBlock, Text, Viewer
from rtrays.pages.provenance import curve_provenance, run_made_by
from rtrays.plots.curve_plots import write_plots
from rtrays.tables.cells import verdict_of
from rtrays.tables.curve_tables import write_tables
from rtrays.tables.verdict_table import gain_rows, verdict_table

NO_PARTS = (
    "This run is older than the division of the error by what the camera sees first; a new run has"
    " it."
)


def viewer_block(run):
    """Returns the viewer, or the command that makes the images it needs."""
    if run.has_images():
        from rtrays.pages.viewer import write_viewer

        write_viewer(run)
        return Viewer()
    return Viewer(
        "The interactive comparison needs the measured images, which the repository does not keep."
        f" This command makes them: rtrays-experiment run"
        f" {experiment_path(run.get('experiment.name'))} --profile"
        f" {run.get('experiment.profile')} --out DIR"
    )


def curve_page(run):
    """Writes tables and plots into the run's folder; returns the page, which shows the most
    decisive plot first."""
    tables, figures = write_tables(run), write_plots(run)
    verdicts = verdict_table(run)
    is_about_time = bool(gain_rows(run)) or clock_of(run) == "wall"
    first = f"rmse_seconds_{clock_of(run)}.svg" if is_about_time else "rmse_spp.svg"
    blocks = [Figure(f"plots/{first}", figures[first], png=True), TableBlock(verdicts)]
    if explanation(run):
        blocks.append(Text(explanation(run)))
    blocks += [
        Figure(f"plots/{file}", caption, png=file.endswith(".svg"))
        for file, caption in figures.items()
        if file != first
    ]
    blocks.append(viewer_block(run))
    blocks += [TableBlock(table, f"tables/{name}") for name, table in tables.items() if table.rows]
    if not has_parts(run):
        blocks.append(Text(NO_PARTS))
    width, height = run.get("experiment.size")
    return Page(
        run.folder,
        "report.md",
        run.prose("title"),
        finding(run),
        blocks,
        source=run.source,
        claim=run.prose("claim"),
        claim_head="The thesis claims" if run.source else "Claim",
        provenance=curve_provenance(run),
        verdicts=[word for word in (verdict_of(row[-1]) for row in verdicts.rows) if word],
        picture="plots/reference.png",
        picture_label=f"Reference image, {width} x {height}",
        made=run_made_by(run),
    )
