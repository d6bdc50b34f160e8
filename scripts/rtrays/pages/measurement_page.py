# SPDX-License-Identifier: MIT
"""The page of a measurement."""

from rtrays.pages.page import Figure, Page, TableBlock
from rtrays.pages.provenance import measurement_provenance, run_made_by
from rtrays.plots.frame_plots import samples_per_second, speeds_over_defaults, stage_shares
from rtrays.plots.hierarchy_plots import animation, build_time
from rtrays.plots.ray_plots import hits, speeds
from rtrays.plots.reference_plots import mean_differences
from rtrays.plots.renderer_plots import efficiencies
from rtrays.tables.ablation_tables import ablations
from rtrays.tables.animation_tables import bvh_animation
from rtrays.tables.bounce_tables import bounces
from rtrays.tables.build_tables import bvh_build
from rtrays.tables.frame_tables import frame_times
from rtrays.tables.ray_tables import ray_rates
from rtrays.tables.reference_tables import reference_agreement
from rtrays.tables.renderer_tables import renderers
from rtrays.tables.traversal_tables import traversal

TABLES = {
    "ablations": ablations,
    "bounces": bounces,
    "bvh_animation": bvh_animation,
    "bvh_build": bvh_build,
    "frame_times": frame_times,
    "ray_rates": ray_rates,
    "reference_agreement": reference_agreement,
    "renderers": renderers,
    "traversal": traversal,
}
PLOTS = {
    "ablations": speeds_over_defaults,
    "bounces": samples_per_second,
    "bvh_animation": animation,
    "bvh_build": build_time,
    "frame_times": stage_shares,
    "ray_rates": speeds,
    "reference_agreement": mean_differences,
    "renderers": efficiencies,
    "traversal": hits,
}
# What a plot shows, below its small picture in the overview.
PICTURES = {
    "animation": "Updates and ray rates by frame",
    "build_time": "Build time by triangles",
    "efficiencies": "Efficiency by scene and renderer",
    "hits": "Share of differing hits by mesh",
    "mean_differences": "Differences of means by scene",
    "samples_per_second": "Samples per second by bounces",
    "speeds": "Ray rates over Embree by mesh",
    "speeds_over_defaults": "Speeds over the defaults",
    "stage_shares": "Stages of a frame",
}


def measurement_page(run):
    """Writes plots and tables into the run's folder; returns the page."""
    measures = run.kind
    finding, tables = TABLES[measures](run)
    figures = PLOTS[measures](run)
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
        provenance=measurement_provenance(run),
        picture=f"{first}.svg" if first else "",
        picture_label=PICTURES.get(first, ""),
        made=run_made_by(run),
    )
