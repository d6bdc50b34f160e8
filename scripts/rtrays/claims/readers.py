# SPDX-License-Identifier: MIT
"""Readers of the figures that judge the claims of chapter 4; the file of claims names them.

Each reader takes a run's folder and yields (name, {"value", "low", "high"}), or an agreement as
run.json has it. A reader yields nothing if the run does not have the figure.
"""

from rtrays.claims.curve_figures import (
    agreements,
    control_gain,
    edge_errors,
    gain,
    memory,
    sample_cost,
    slopes,
)
from rtrays.claims.frame_figures import (
    ablation,
    coherence,
    frame_rate,
    frame_time,
    traced_share,
    wavefront_gain,
)
from rtrays.claims.hierarchy_figures import build_gain, build_rate, leaks, published_order

READERS = {
    reader.__name__: reader
    for reader in (
        ablation,
        agreements,
        build_gain,
        build_rate,
        coherence,
        control_gain,
        edge_errors,
        frame_rate,
        frame_time,
        gain,
        leaks,
        memory,
        published_order,
        sample_cost,
        slopes,
        traced_share,
        wavefront_gain,
    )
}
