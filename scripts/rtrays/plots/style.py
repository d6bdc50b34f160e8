# SPDX-License-Identifier: MIT
"""Style of all plots, and files of plots.

Equal input gives equal files: no dates, fixed identifiers, text kept as text.
"""

import matplotlib
from matplotlib import pyplot

matplotlib.use("Agg")
matplotlib.rcParams.update(
    {
        "svg.hashsalt": "rtrays",
        "svg.fonttype": "none",
        "font.size": 9,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.grid": True,
        "grid.alpha": 0.25,
        "legend.framealpha": 0.9,
        "legend.edgecolor": "none",
        "axes.titlesize": 9,
    }
)
# Okabe and Ito: distinguishable with any colour vision.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#8C6D1F")
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")
METADATA = {".svg": {"Date": None}, ".png": {"Software": None}}


def colour_and_marker(index):
    """Returns colour and marker of a series as keywords; the first 64 series have different
    pairs."""
    return {
        "color": COLOURS[index % len(COLOURS)],
        "marker": MARKERS[(index + index // len(COLOURS)) % len(MARKERS)],
    }


def series_style(index):
    """Returns colour, marker and line of a series in a plot of points with intervals."""
    return {**colour_and_marker(index), "markersize": 4, "linewidth": 1.0}


def legend_below(figure, ncols, panel=None):
    """Adds a legend below all panels of a figure; it has the series of one panel if given."""
    series = panel.get_legend_handles_labels() if panel else ()
    figure.legend(*series, fontsize=8, loc="upper center", bbox_to_anchor=(0.5, 0), ncols=ncols)


def legend_below_axes(axes, x, y, ncols):
    """Adds a legend below a single plot, at a point in units of its size."""
    axes.legend(fontsize=8, loc="upper center", bbox_to_anchor=(x, y), ncols=ncols)


def set_ticks(set_positions, ticks):
    """Sets ticks by one of axes' methods, such as set_xticks, with plain numbers as labels."""
    set_positions(ticks, [f"{tick:g}" for tick in ticks])


def name_rows(axes, names):
    """Labels the rows of a plot from top to bottom."""
    axes.set_yticks(range(len(names)), names)
    axes.invert_yaxis()


def line_at_one(draw):
    """Draws a dotted line at 1 by axvline or axhline of axes."""
    draw(1, color="black", linewidth=0.8, linestyle=":")


def save(figure, stem, *extensions):
    """Writes STEM.svg, or the files of the given extensions, and closes the figure."""
    for extension in extensions or (".svg",):
        temporary = stem.with_name(f"{stem.name}.tmp{extension}")
        figure.savefig(temporary, dpi=160, metadata=METADATA[extension], bbox_inches="tight")
        temporary.replace(stem.with_name(stem.name + extension))
    pyplot.close(figure)
