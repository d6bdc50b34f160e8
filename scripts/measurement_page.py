# SPDX-License-Identifier: MIT
"""The page of a measurement."""

from animation_tables import bvh_animation
from curve_page import made_by
from frame_plots import FRAME_PLOTS
from frame_tables import FRAME_TABLES
from measurement_plots import PLOTS
from measurement_tables import HIERARCHY_TABLES
from measurement_text import provenance
from pages import Figure, Page, TableBlock
from reference_tables import REFERENCE_TABLES
from traversal_tables import traversal

ALL_TABLES = {
    **HIERARCHY_TABLES,
    **FRAME_TABLES,
    **REFERENCE_TABLES,
    "bvh_animation": bvh_animation,
    "traversal": traversal,
}
ALL_PLOTS = {**PLOTS, **FRAME_PLOTS}
# What a plot shows, below its small picture in the overview.
PICTURES = {
    "animation": "Updates and ray rates by frame",
    "build_time": "Build time by triangles",
    "hits": "Share of differing hits by mesh",
    "mean_differences": "Differences of means by scene",
    "samples_per_second": "Samples per second by bounces",
    "speeds": "Ray rates over Embree by mesh",
    "speeds_over_defaults": "Speeds over the defaults",
    "stage_shares": "Stages of a frame",
}


def measurement_page(run):
    """Writes plots and tables into the run's folder; returns the page."""
    measures = run.get("measures")
    finding, tables = ALL_TABLES[measures](run)
    figures = ALL_PLOTS[measures](run) if measures in ALL_PLOTS else {}
    blocks = [Figure(f"{stem}.svg", caption) for stem, caption in figures.items()]
    for index, table in enumerate(tables, 1):
        table.write(run.folder / "tables", f"table_{index}")
        blocks.append(TableBlock(table, f"tables/table_{index}"))
    first = next(iter(figures), "")
    return Page(
        run.folder,
        f"{run.get('experiment.name')}.md",
        run.prose("title"),
        finding,
        blocks,
        source=run.source,
        claim=run.prose("claim"),
        claim_head="The thesis claims" if run.source else "Claim",
        provenance=provenance(run),
        picture=f"{first}.svg" if first else "",
        picture_label=PICTURES.get(first, ""),
        made=made_by(run),
    )
