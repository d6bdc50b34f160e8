# SPDX-License-Identifier: MIT
"""The points of runs as one tidy table, for programs such as pandas."""

import csv
import io

from rtrays.documents.curves import label
from rtrays.documents.document import value
from rtrays.documents.points import CLOCKS, METRICS, of_seeds, spread

COLUMNS = ("run", "curve", "label", "scene", "spp", "quantity", "value", "low", "high")


def points_csv(runs):
    """Returns CSV with a row for every quantity of every point: the median over the seeds, and the
    central 95 % of them as low and high. Quantities are the metrics and the seconds by two
    clocks; other renderers have wall time alone."""
    quantities = {name: name for name in METRICS}
    quantities.update((f"seconds_{clock}", clock) for clock in CLOCKS)
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(COLUMNS)
    for run in runs:
        for curve in run.curves:
            names = [
                run.get("experiment.name"),
                value(curve, "id"),
                label(curve),
                value(curve, "scene"),
            ]
            for point in value(curve, "points"):
                for name, quantity in quantities.items():
                    if sample := of_seeds(curve, point, quantity):
                        numbers = [repr(number) for number in spread(sample)]
                        writer.writerow([*names, value(point, "spp"), name, *numbers])
    return stream.getvalue()
