# SPDX-License-Identifier: MIT
"""Chart of samples per second over other renderers."""

import numpy
from matplotlib import pyplot

from rtrays.documents.measurements import peer_entries
from rtrays.documents.run_document import Run
from rtrays.plots.chart import Chart
from rtrays.plots.style import COLOURS, MARKERS, legend_below, save, set_ticks
from rtrays.tables.text import bounces_text, listed, span


def draw_peer(axes, own, x, index):
    """Draws the speeds over one peer: a line and dots for the scenes, a marker for their mean."""
    colour = COLOURS[index]
    lows, highs = zip(*((min(scenes), max(scenes)) for *_, scenes in own))
    axes.vlines(x, lows, highs, color=colour, linewidth=1)
    axes.plot(
        numpy.repeat(x, [len(scenes) for *_, scenes in own]),
        [speed for *_, scenes in own for speed in scenes],
        ".",
        color=colour,
        markersize=4,
        alpha=0.6,
    )
    means = [mean for _, _, mean, _ in own]
    axes.plot(x, means, MARKERS[index], color=colour, markersize=7, label=own[0][0])


def speeds_figure(entries, peers, lengths):
    """Draws the speeds over all peers by length of path."""
    figure, axes = pyplot.subplots(figsize=(8, 3.4), layout="constrained")
    for i, peer in enumerate(peers):
        own = [entry for entry in entries if entry[0] == peer]
        draw_peer(axes, own, numpy.arange(len(own)) + 0.16 * (i - (len(peers) - 1) / 2), i)
    axes.axhline(1, color="black", linewidth=0.9, linestyle=":")
    axes.set_yscale("log")
    set_ticks(axes.set_yticks, [0.5, 0.7, 1, 1.5, 2, 3])
    axes.minorticks_off()
    axes.set_xticks(range(len(lengths)), map(bounces_text, lengths))
    axes.set(ylabel="speed of RTRays over the peer")
    axes.grid(axis="x", visible=False)
    legend_below(figure, 2)
    return figure


def speeds_chart(folder):
    """Writes the chart of speeds over other renderers; returns it."""
    if not (folder / "bounces/run.json").is_file():
        missing = "The speed against other renderers needs the run bounces."
        return Chart("speeds", "", missing=missing)
    run = Run(folder / "bounces")
    entries = [entry for entry in peer_entries(run) if entry[0] != "megakernel"]
    lengths = list(dict.fromkeys(bounces for _, bounces, _, _ in entries))
    peers = list(dict.fromkeys(peer for peer, *_ in entries))
    save(speeds_figure(entries, peers, lengths), folder / "speeds", ".svg", ".png")
    texts = [
        f"{span([mean for p, _, mean, _ in entries if p == peer])} times as fast as {peer}"
        for peer in peers
    ]
    return Chart(
        "speeds",
        f"At {lengths[0]} to {lengths[-1]} bounces the wavefront is {listed(texts)}.",
        f"Samples per second by {run.clock} time, all programs on one device. Large markers:"
        f" geometric means over {len(run.get('rows'))} scenes; dots and lines: the scenes.",
    )
