# SPDX-License-Identifier: MIT
"""Figures of a run: error over samples and over time (figure 4.3), and images beside the reference
(figure 4.2)."""

import matplotlib
import numpy
from matplotlib import pyplot

from run_document import file_name, label, seconds, shown_curves, usable_points, value

matplotlib.use("Agg")
# Equal input gives equal files: no dates, fixed identifiers, text kept as text.
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

AXES = {
    "spp": "samples per pixel",
    "seconds_device": "device time, s (pilot included; without compilation and BVH construction)",
    "seconds_wall": "wall time, s (pilot included; without compilation and BVH construction)",
}
# Okabe and Ito: distinguishable with any colour vision.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#8C6D1F")
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")


def series_style(index):
    """Colour, marker and line of a series in a plot of points with intervals."""
    return {
        "color": COLOURS[index % len(COLOURS)],
        "marker": MARKERS[index % len(MARKERS)],
        "markersize": 4,
        "linewidth": 1.0,
    }


def band(curve_points, key):
    """The central 95 % of the seeds at each point: (low, high)."""
    samples = [
        [value(repetition, key) for repetition in value(point, "repetitions")]
        for point in curve_points
    ]
    return numpy.quantile(numpy.array(samples), [0.025, 0.975], axis=1)


def draw_guide(axes, x, y):
    """A line of slope -1/2 over the range of x, from y at its left end."""
    ends = numpy.array([min(x), max(x)], dtype=float)
    axes.plot(
        ends,
        y * (ends / ends[0]) ** -0.5,
        color="black",
        linewidth=0.8,
        linestyle=":",
        label="slope $-1/2$",
    )


# Curves this close to an earlier one at every point cover it.
COINCIDENT = 0.08
DASHES = ((0, (2.5, 2.5)), (2.5, (1, 4)))


def x_of(curve, point, key):
    """Samples, or seconds with the pilot."""
    return (
        value(point, "spp") if key == "spp" else seconds(curve, point, key.removeprefix("seconds_"))
    )


def covers(over, under):
    """Whether a curve lies on another one, point by point, where both have samples; curves are (x,
    y), log-log."""
    inside = (over[0] >= under[0][0] / 1.001) & (over[0] <= under[0][-1] * 1.001)
    expected = numpy.exp(numpy.interp(numpy.log(over[0][inside]), *map(numpy.log, under)))
    return inside.sum() > 1 and bool((abs(over[1][inside] / expected - 1) < COINCIDENT).all())


def curves_figure(run, x_key):
    """RMSE against `x_key`, log-log. Curves stop where the reference's noise passes 10 % of their
    MSE.

    A curve that covers earlier ones is thinner and dashed, so that each can be seen, and the
    legend says so.
    """
    figure, axes = pyplot.subplots(figsize=(6.4, 5.2), layout="constrained")
    floor = run.get("reference.noise_floor.rmse")
    all_x, first_y, drawn = [], [], []
    for index, curve in enumerate(run.curves):
        points = usable_points(curve)
        x = numpy.array([x_of(curve, point, x_key) for point in points], dtype=float)
        y = numpy.array([value(point, "rmse") for point in points])
        colour = COLOURS[index % len(COLOURS)]
        below = [earlier for earlier, line in drawn if covers((x, y), line)]
        drawn.append((curve, (x, y)))
        name = f"{label(curve)}, slope {value(curve, 'slope.value'):.3f}" + (
            f"\n(on {label(below[-1])})" if below else ""
        )
        dashes = DASHES[min(len(below), len(DASHES)) - 1] if below else "-"
        axes.fill_between(x, *band(points, "rmse"), color=colour, alpha=0.2, linewidth=0)
        axes.plot(
            x,
            y,
            color=colour,
            marker=MARKERS[index % len(MARKERS)],
            markersize=6 - 1.5 * min(len(below), 2),
            linewidth=2 - 0.4 * min(len(below), 2),
            linestyle=dashes,
            label=name,
            markerfacecolor="white" if below else colour,
        )
        all_x += list(x)
        first_y.append(y[0])
    draw_guide(axes, all_x, 0.6 * min(first_y))
    axes.axhline(
        floor,
        color="gray",
        linestyle="--",
        linewidth=0.9,
        label=f"noise of the reference ({run.get('reference.spp')} spp)",
    )
    axes.set(
        xscale="log", yscale="log", xlabel=AXES[x_key], ylabel="RMSE", ylim=(0.5 * floor, None)
    )
    if x_key == "spp":
        axes.set_xscale("log", base=2)
    axes.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=2)
    return figure


def to_display(linear):
    """sRGB transfer curve, clipped; for display only, never for metrics."""
    clipped = numpy.clip(linear, 0, 1)
    return numpy.where(clipped <= 0.0031308, 12.92 * clipped, 1.055 * clipped ** (1 / 2.4) - 0.055)


def draw_image(axes, title, picture):
    axes.imshow(to_display(picture), interpolation="nearest")
    axes.set_title(title, fontsize=9)
    axes.set_axis_off()


def panels_figure(panels):
    """Pictures side by side; `panels`: (title, linear image)."""
    figure, grid = pyplot.subplots(
        1, len(panels), figsize=(3.2 * len(panels), 3.5), layout="constrained"
    )
    for axes, panel in zip(grid, panels):
        draw_image(axes, *panel)
    return figure


def images_figure(run, curve):
    """Reference, ours, and ten times their absolute difference."""
    reference = run.image(run.get("reference.image"))
    ours = run.image(value(curve, "image"))
    panels = (
        (f"reference, {run.get('reference.spp')} spp", reference),
        (f"{label(curve)}, {value(curve, 'image_spp')} spp", ours),
        ("10 × |difference|", 10 * numpy.abs(ours.astype(float) - reference)),
    )
    return panels_figure(panels)


def contributions_figure(run, curve):
    """Contribution of each pass of an algorithm, and the sum (figures 4.8, 4.11, 4.14, 4.17)."""
    image = value(curve, "image")
    panels = [(f"{layer} paths", run.layer(image, layer)) for layer in value(curve, "layers")]
    panels.append((f"{label(curve)}, {value(curve, 'image_spp')} spp", run.image(image)))
    return panels_figure(panels)


def early_figure(run, curves):
    """The first seed's images after few samples, a row for each curve (figures 4.9, 4.12, 4.15,
    4.18)."""
    rows = [
        [
            (f"{label(curve)}, {value(early, 'spp')} spp", run.image(value(early, "image")))
            for early in value(curve, "early_images")
        ]
        for curve in curves
    ]
    columns = max(map(len, rows))
    figure, grid = pyplot.subplots(
        len(rows),
        columns,
        figsize=(2.9 * columns, 3.1 * len(rows)),
        layout="constrained",
        squeeze=False,
    )
    for axes in grid.flat:
        axes.set_axis_off()
    for line, panels in zip(grid, rows):
        for axes, panel in zip(line, panels):
            draw_image(axes, *panel)
    return figure


FORMS = {".svg": {"Date": None}, ".png": {"Software": None}}


def save(figure, stem, *extensions):
    """Writes STEM.svg and STEM.png: curves as both, pictures as PNG."""
    for extension in extensions:
        metadata = FORMS[extension]
        temporary = stem.with_name(f"{stem.name}.tmp{extension}")
        figure.savefig(temporary, dpi=160, metadata=metadata, bbox_inches="tight")
        temporary.replace(stem.with_name(stem.name + extension))
    pyplot.close(figure)


def write_curves(run, folder):
    """Writes the plots of errors; returns {file: caption}."""
    folder.mkdir(parents=True, exist_ok=True)
    figures = {}
    for x_key, axis in AXES.items():
        save(curves_figure(run, x_key), folder / f"rmse_{x_key}", ".svg", ".png")
        figures[f"rmse_{x_key}.svg"] = (
            f"RMSE against {axis}; medians and the central 95 % of the seeds."
        )
    return figures


def pictures(run):
    """(file, caption, function that draws it) of every figure that is made of images."""
    curves = shown_curves(run)
    for curve in curves:
        stem = file_name(value(curve, "id"))
        yield (
            f"images_{stem}.png",
            (
                f"Reference, {label(curve)}, and ten times their absolute difference (sRGB for"
                " display)."
            ),
            lambda curve=curve: images_figure(run, curve),
        )
        if value(curve, "layers"):
            yield (
                f"contributions_{stem}.png",
                f"Contributions of the passes of {label(curve)}, and their sum.",
                lambda curve=curve: contributions_figure(run, curve),
            )
    if any(value(curve, "early_images") for curve in curves):
        yield "early.png", "Images after few samples, first seed.", lambda: early_figure(
            run, curves
        )


def write_pictures(run, folder):
    """Writes the figures made of images, and the reference for the index; returns {file: caption}.

    Without the images the stored PNG files stay as they are.
    """
    if not run.has_images():
        return {file: caption for file, caption, _ in pictures(run) if (folder / file).exists()}
    folder.mkdir(parents=True, exist_ok=True)
    pyplot.imsave(
        folder / "reference.png",
        to_display(run.image(run.get("reference.image"))),
        metadata=FORMS[".png"],
    )
    figures = {}
    for file, caption, draw in pictures(run):
        save(draw(), folder / file.removesuffix(".png"), ".png")
        figures[file] = caption
    return figures


def write_plots(run, folder):
    """Writes all figures of a run; returns {file: caption}."""
    return {**write_curves(run, folder), **write_pictures(run, folder)}
