# SPDX-License-Identifier: MIT
"""Makes the page of a run's folder, whatever the kind of the run."""

from rtrays.documents.document import RunError, read_json
from rtrays.documents.run_document import Measurement, Run
from rtrays.documents.survey import is_stiffness
from rtrays.pages.control_page import control_page
from rtrays.pages.curve_page import curve_page
from rtrays.pages.measurement_page import measurement_page
from rtrays.pages.stability_page import stability_page
from rtrays.pages.stiffness_page import stiffness_page


def make_page(folder):
    """Makes tables and plots of a folder's run. Returns its page, or None if there is no run.
    Raises RunError if the run cannot be used."""
    if (folder / "run.json").is_file():
        is_measurement = "measures" in read_json(folder / "run.json")
        return measurement_page(Measurement(folder)) if is_measurement else curve_page(Run(folder))
    if (folder / "stability.json").is_file():
        make = (
            stiffness_page if is_stiffness(read_json(folder / "stability.json")) else stability_page
        )
        return make(folder)
    return control_page(folder) if (folder / "convergence_control.json").is_file() else None


def write_page(folder):
    """Writes the page of a folder's run; returns the page. Raises RunError if there is no run."""
    page = make_page(folder)
    if page is None:
        raise RunError(f"{folder}: no run; rtrays-experiment run ... --out {folder} makes one")
    page.write()
    return page


def page_or_error(folder):
    """Returns the page of a folder's run, the error as text, or None if there is no run."""
    try:
        return make_page(folder)
    except RunError as error:
        return str(error)
