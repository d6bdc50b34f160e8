# SPDX-License-Identifier: MIT
"""Makes the page of a run's folder, whatever the kind of the run."""

from rtrays.documents.document import RunError
from rtrays.documents.run_document import run_in
from rtrays.documents.survey import is_stiffness
from rtrays.pages.control_page import control_page
from rtrays.pages.curve_page import curve_page
from rtrays.pages.measurement_page import TABLES, measurement_page
from rtrays.pages.scene_gains_page import scene_gains_page
from rtrays.pages.stability_page import stability_page
from rtrays.pages.stiffness_page import stiffness_page
from rtrays.pages.sweep_page import sweep_page

PAGES = {
    "curves": curve_page,
    "convergence_control": control_page,
    "sweep": sweep_page,
    "scene_gains": scene_gains_page,
    "stability": lambda run: (stiffness_page if is_stiffness(run) else stability_page)(run),
    **dict.fromkeys(TABLES, measurement_page),
}


def make_page(folder):
    """Makes tables and plots of a folder's run. Returns its page, or None if there is no run.
    Raises RunError if the run cannot be used."""
    run = run_in(folder)
    if run is None:
        return None
    if run.kind not in PAGES:
        raise RunError(
            f"{folder}: runs of the kind '{run.kind}' have no page; kinds with pages are:"
            f" {', '.join(sorted(PAGES))}"
        )
    return PAGES[run.kind](run)


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
