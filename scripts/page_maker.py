# SPDX-License-Identifier: MIT
"""Makes the page of a run's folder, whatever the kind of the run."""

import json

from case_pages import control_page, stability_page, stiffness_page
from curve_page import curve_page
from measurement_page import measurement_page
from plots import write_plots
from run_document import Measurement, Run, RunError
from tables import write_tables


def maker(folder):
    """The function that makes the page of a folder, by its documents; None for a folder without
    any."""
    if (folder / "run.json").is_file():
        try:
            document = json.loads((folder / "run.json").read_text())
        except ValueError as error:
            raise RunError(f"{folder / 'run.json'}: not JSON: {error}") from error
        return measurement_of if "measures" in document else curves_of
    if (folder / "stability.json").is_file():
        rows = json.loads((folder / "stability.json").read_text()).get("rows", [])
        return (
            stiffness_page
            if rows and all(row.get("stiffness", 0) > 0 for row in rows)
            else stability_page
        )
    return control_page if (folder / "convergence_control.json").is_file() else None


def measurement_of(folder):
    return measurement_page(Measurement(folder))


def curves_of(folder):
    run = Run(folder)
    return curve_page(run, write_tables(run, folder / "tables"), write_plots(run, folder / "plots"))


def make_page(folder):
    """Makes tables and plots of a folder's run; returns its page, an error as text, or None if
    there is no run."""
    try:
        make = maker(folder)
        return make(folder) if make else None
    except RunError as error:
        return str(error)
