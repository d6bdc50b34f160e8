# SPDX-License-Identifier: MIT
"""Tables of a run as rows of text, and their CSV, Markdown and LaTeX forms."""

import csv
import io

from edges import edge_errors
from efficiency import Cost, base_curve, gain
from run_document import label, shown_curves, value, write_text

POINT_METRICS = ("l2", "rmse", "mae", "relmse", "mse", "mse_unbiased")


class Table:
    """A caption, column heads, and rows of strings."""

    def __init__(self, caption, columns, rows):
        self.caption = caption
        self.columns = columns
        self.rows = rows

    def csv(self):
        stream = io.StringIO()
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(self.columns)
        writer.writerows(self.rows)
        return stream.getvalue()

    def markdown(self):
        def line(cells):
            return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"

        return "\n".join([line(self.columns), line(["---"] * len(self.columns)), *map(line, self.rows)]) + "\n"

    def latex(self):
        """A booktabs table; numbers are right-aligned."""

        def line(cells):
            return "    " + " & ".join(latex_escape(cell) for cell in cells) + r" \\"

        return "\n".join(
            [
                r"\begin{table}",
                r"  \centering",
                rf"  \caption{{{latex_escape(self.caption)}}}",
                rf"  \begin{{tabular}}{{l{'r' * (len(self.columns) - 1)}}}",
                r"    \toprule",
                line(self.columns),
                r"    \midrule",
                *map(line, self.rows),
                r"    \bottomrule",
                r"  \end{tabular}",
                r"\end{table}",
                "",
            ]
        )

    def write(self, folder, name):
        """NAME.csv, NAME.md and NAME.tex."""
        write_text(folder / f"{name}.csv", self.csv())
        write_text(folder / f"{name}.md", f"{self.caption}\n\n{self.markdown()}")
        write_text(folder / f"{name}.tex", self.latex())


LATEX_SPECIAL = {
    "\\": r"\textbackslash{}", "&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#", "_": r"\_",
    "{": r"\{", "}": r"\}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}",
}


def latex_escape(text):
    return "".join(LATEX_SPECIAL.get(character, character) for character in text)


def number(quantity):
    """Four significant digits."""
    return f"{quantity:.4g}"


def interval(document, scale=1.0, form="{:.4g}"):
    """value [low, high]"""
    parts = [form.format(scale * value(document, key)) for key in ("value", "low", "high")]
    return f"{parts[0]} [{parts[1]}, {parts[2]}]"


def errors_table(run):
    """Median errors and times of every curve and sample count: figure 4.3 in numbers."""
    rows = []
    for curve in run.curves:
        for point in value(curve, "points"):
            rows.append(
                [label(curve), str(value(point, "spp"))]
                + [number(value(point, key)) for key in ("seconds_device", "seconds_wall")]
                + [number(value(point, key)) for key in POINT_METRICS]
                + ["below the noise floor" if value(point, "noise_dominates") else "yes"]
            )
    columns = ["curve", "spp", "device s", "wall s", "L2", "RMSE", "MAE", "relMSE", "MSE", "MSE less reference noise",
               "above floor"]
    return Table(f"{run.get('experiment.title')}: error, medians over seeds", columns, rows)


def slopes_table(run):
    rows = [
        [label(curve), interval(value(curve, "slope"), form="{:.4f}"),
         interval(value(curve, "slope_unbiased"), form="{:.4f}"),
         "{} to {}".format(*value(curve, "slope.spp"))]
        for curve in run.curves
    ]
    return Table(f"{run.get('experiment.title')}: slope of log RMSE against log spp, 95 % intervals",
                 ["curve", "slope", "slope less reference noise", "spp"], rows)


def agreement_table(run):
    rows = []
    for curve in run.curves:
        agreement = value(curve, "agreement")
        rows.append([
            label(curve), str(value(curve, "image_spp")),
            f"{value(agreement, 'rejected')} of {value(agreement, 'tests')}", str(agreement.get("unconfirmed", 0)),
            number(value(agreement, "largest_z")),
            interval(value(agreement, "relative_difference"), 100, "{:+.4f}"), value(agreement, "equivalence"),
        ])
    return Table(f"{run.get('experiment.title')}: agreement with the reference",
                 ["curve", "spp", "tests rejected", "not confirmed", "largest |z|", "difference of the mean, %, 99 %",
                  "within 0.1 %"], rows)


def cost_table(run):
    """What is kept out of the curves: compilation and BVH construction."""
    rows = [[label(curve), number(value(curve, "compile_seconds")), number(value(curve, "bvh_seconds"))]
            for curve in run.curves]
    return Table(f"{run.get('experiment.title')}: seconds outside of the curves",
                 ["curve", "kernels compiled or loaded, first enqueue included", "BVH construction"], rows)


def efficiency_table(run):
    """Every curve against path tracing: samples for the same error, error in the same time."""
    noise = run.get("reference.noise_floor.mse")
    base = base_curve(run)
    rows = []
    for curve in run.curves:
        cost = Cost(curve, noise)
        rows.append([label(curve), str(cost.spp), number(cost.mse.mean()), number(cost.seconds), number(cost.pilot_seconds),
                     interval(gain(base, curve, noise, "spp")), interval(gain(base, curve, noise, "seconds"))])
    name = label(base)
    return Table(f"{run.get('experiment.title')}: against {name}, less reference noise, 95 % intervals over seeds; "
                 "light that a curve cannot see counts as its error",
                 ["curve", "at spp", "MSE", "device s without pilot", "pilot s", f"samples of {name} for one of its own",
                  "times less MSE in equal time"], rows)


# What the thesis says of memory (2.8; full bidirectional: its figure of the literature).
THESIS_MEMORY = {"truncated_bdpt": "path tracing and one scalar", "bdpt": "3.5 KB, 16 vertices from either end"}


def memory_table(run):
    """Bytes for every path in flight, queues included."""
    rows = []
    for curve in run.curves:
        report = value(curve, "render_report")
        rows.append([label(curve), str(value(report, "bytes_per_path")), str(value(report, "light_vertex_bytes_per_path")),
                     THESIS_MEMORY.get(value(curve, "algorithm"), "-")])
    return Table(f"{run.get('experiment.title')}: bytes per path, whatever its length",
                 ["curve", "bytes", "of light vertices", "thesis"], rows)


def throughput_table(run):
    """Renderer against reference, or the reason why it was refused."""
    throughput = run.get("throughput")
    columns = ["curve", "renderer, Msamples/s", "reference, Msamples/s", "ratio"]
    if value(throughput, "accepted"):
        cells = [interval(value(throughput, f"{side}_samples_per_second"), 1e-6) for side in ("renderer", "reference")]
        row = [*cells, interval(value(throughput, "ratio"))]
    else:
        row = [f"refused: {value(throughput, 'reason')}", "error: no value", "error: no value"]
    return Table(f"{run.get('experiment.title')}: samples per second, renderer and reference in turns", columns,
                 [[value(throughput, "curve"), *row]])


def edges_table(run):
    """Where the error lies."""
    rows = []
    for curve in shown_curves(run):
        ratio = edge_errors(run, curve)
        if ratio:
            rows.append([value(curve, "id"), *(number(value(ratio, key)) for key in ("value", "low", "high"))])
    return Table("Mean squared error at edges of the image over that elsewhere, 95 % interval", ["curve", "value", "low", "high"], rows)


def repetitions_table(run):
    """Every raw measurement, one row each, with all digits."""
    keys = ("seconds_device", "seconds_wall", "l2", "rmse", "mae", "relmse", "mse")
    rows = []
    for curve in run.curves:
        for point in value(curve, "points"):
            for repetition in value(point, "repetitions"):
                rows.append([value(curve, "id"), str(value(point, "spp")), str(value(repetition, "seed"))]
                            + [repr(value(repetition, key)) for key in keys])
    return Table("all repetitions", ["curve", "spp", "seed", *keys], rows)


TABLES = {
    "errors": errors_table,
    "slopes": slopes_table,
    "efficiency": efficiency_table,
    "memory": memory_table,
    "agreement": agreement_table,
    "cost": cost_table,
    "throughput": throughput_table,
    "edges": edges_table,
}


def write_tables(run, folder):
    """All tables as CSV, Markdown and LaTeX, the raw repetitions as CSV; returns the tables by name."""
    folder.mkdir(parents=True, exist_ok=True)
    tables = {name: make(run) for name, make in TABLES.items()}
    for name, table in tables.items():
        table.write(folder, name)
    write_text(folder / "repetitions.csv", repetitions_table(run).csv())
    return tables
