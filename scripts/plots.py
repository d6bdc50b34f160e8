# SPDX-License-Identifier: MIT
"""Figures of a run: error over samples and over time (figure 4.3), and the image triptych (figure 4.2)."""

import matplotlib

matplotlib.use("Agg")
# Equal input gives equal files: no dates, fixed identifiers, text kept as text.
matplotlib.rcParams.update({"svg.hashsalt": "rtrays", "svg.fonttype": "none", "font.size": 9,
                            "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True,
                            "grid.alpha": 0.25, "legend.framealpha": 0.9, "legend.edgecolor": "none", "axes.titlesize": 9})

import matplotlib.pyplot as pyplot
import numpy

from run_document import label, pilot_seconds, shown_curves, usable_points, value

AXES = {
    "spp": "samples per pixel",
    "seconds_device": "device time, s (kernel compilation and BVH construction apart, pilots included)",
    "seconds_wall": "wall time, s (kernel compilation and BVH construction apart, pilots included)",
}
# Okabe & Ito: told apart with any colour vision.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#8C6D1F")
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")


def band(curve_points, key):
    """The central 95 % of the seeds at each point: (low, high)."""
    samples = [[value(repetition, key) for repetition in value(point, "repetitions")] for point in curve_points]
    return numpy.quantile(numpy.array(samples), [0.025, 0.975], axis=1)


def draw_guide(axes, x, y):
    """A line of slope -1/2 over the range of x, from y at its left end."""
    ends = numpy.array([min(x), max(x)], dtype=float)
    axes.plot(ends, y * (ends / ends[0]) ** -0.5, color="black", linewidth=0.8, linestyle=":", label="slope $-1/2$")


def curves_figure(run, x_key):
    """RMSE against `x_key`, log-log. Curves stop where the reference's noise passes 10 % of their MSE."""
    figure, axes = pyplot.subplots(figsize=(6.4, 5.2), layout="constrained")
    floor = run.get("reference.noise_floor.rmse")
    all_x, first_y = [], []
    for index, curve in enumerate(run.curves):
        points = usable_points(curve)
        ahead = pilot_seconds(curve) if x_key == "seconds_wall" else 0.0  # in device seconds it is already
        x = [value(point, x_key) + ahead for point in points]
        y = [value(point, "rmse") for point in points]
        colour = COLOURS[index % len(COLOURS)]
        axes.fill_between(x, *band(points, "rmse"), color=colour, alpha=0.2, linewidth=0)
        axes.plot(x, y, color=colour, marker=MARKERS[index % len(MARKERS)], markersize=4, linewidth=1.2,
                  label=f"{label(curve)}, slope {value(curve, 'slope.value'):.3f}")
        all_x += x
        first_y.append(y[0])
    draw_guide(axes, all_x, 0.6 * min(first_y))
    axes.axhline(floor, color="gray", linestyle="--", linewidth=0.9,
                 label=f"noise of the reference ({run.get('reference.spp')} spp)")
    axes.set(xscale="log", yscale="log", xlabel=AXES[x_key], ylabel="RMSE",
             title=f"{run.get('experiment.title')}: median and central 95 % over seeds", ylim=(0.5 * floor, None))
    if x_key == "spp":
        axes.set_xscale("log", base=2)
    axes.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=2)
    return figure


def to_display(linear):
    """sRGB transfer curve, clipped: for the eye only, never for metrics."""
    clipped = numpy.clip(linear, 0, 1)
    return numpy.where(clipped <= 0.0031308, 12.92 * clipped, 1.055 * clipped ** (1 / 2.4) - 0.055)


def draw_image(axes, title, picture):
    axes.imshow(to_display(picture), interpolation="nearest")
    axes.set_title(title, fontsize=9)
    axes.set_axis_off()


def panels_figure(panels):
    """Pictures side by side; `panels`: (title, linear image)."""
    figure, grid = pyplot.subplots(1, len(panels), figsize=(3.2 * len(panels), 3.5), layout="constrained")
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
    """What each pass of an algorithm adds to the image, and their sum (figures 4.8, 4.11, 4.14, 4.17)."""
    image = value(curve, "image")
    panels = [(f"{layer} paths", run.layer(image, layer)) for layer in value(curve, "layers")]
    panels.append((f"{label(curve)}, {value(curve, 'image_spp')} spp", run.image(image)))
    return panels_figure(panels)


def early_figure(run, curves):
    """The first seed's images after few samples, a row for each curve (figures 4.9, 4.12, 4.15, 4.18)."""
    rows = [[(f"{label(curve)}, {value(early, 'spp')} spp", run.image(value(early, "image")))
             for early in value(curve, "early_images")] for curve in curves]
    columns = max(map(len, rows))
    figure, grid = pyplot.subplots(len(rows), columns, figsize=(2.9 * columns, 3.1 * len(rows)), layout="constrained",
                                   squeeze=False)
    for axes in grid.flat:
        axes.set_axis_off()
    for line, panels in zip(grid, rows):
        for axes, panel in zip(line, panels):
            draw_image(axes, *panel)
    return figure


FORMS = {".svg": {"Date": None}, ".png": {"Software": None}}


def save(figure, stem, *extensions):
    """STEM.svg, STEM.png: curves as both, pictures, which are pixels, as the latter."""
    for extension in extensions:
        metadata = FORMS[extension]
        temporary = stem.with_name(f"{stem.name}.tmp{extension}")
        figure.savefig(temporary, dpi=160, metadata=metadata, bbox_inches="tight")
        temporary.replace(stem.with_name(stem.name + extension))
    pyplot.close(figure)


def write_plots(run, folder):
    """All figures of a run, and its reference as a picture for the index; returns {file: caption} of the former."""
    folder.mkdir(parents=True, exist_ok=True)
    pyplot.imsave(folder / "reference.png", to_display(run.image(run.get("reference.image"))), metadata=FORMS[".png"])
    figures = {}
    for x_key, axis in AXES.items():
        save(curves_figure(run, x_key), folder / f"rmse_{x_key}", ".svg", ".png")
        figures[f"rmse_{x_key}.svg"] = f"RMSE against {axis}."

    def save_pictures(figure, stem, caption):
        save(figure, folder / stem, ".png")
        figures[f"{stem}.png"] = caption

    curves = shown_curves(run)
    for curve in curves:
        save_pictures(images_figure(run, curve), f"images_{value(curve, 'id')}",
                      f"Reference, {label(curve)} and ten times their absolute difference (sRGB for display).")
        if value(curve, "layers"):
            save_pictures(contributions_figure(run, curve), f"contributions_{value(curve, 'id')}",
                          f"What the passes of {label(curve)} contribute, and their sum.")
    if any(value(curve, "early_images") for curve in curves):
        save_pictures(early_figure(run, curves), "early", "After few samples, first seed.")
    return figures
