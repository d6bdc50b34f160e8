# SPDX-License-Identifier: MIT
"""Templates of pages, and text in HTML."""

import functools
import pathlib
import re

import jinja2
import markupsafe

from rtrays.documents.verdicts import VERDICTS
from rtrays.tables.cells import Lines, Link, verdict_of

TEMPLATES = pathlib.Path(__file__).with_name("templates")
METRICS = (
    "RMSE, MAE and L2 are errors against the reference image; relMSE divides squared differences by"
    " the squared reference. A gain or ratio above 1 favours the first of the two. Brackets are 95"
    " % intervals unless another level is stated."
)
LEGEND = (
    ("holds", "the whole interval is within the claim"),
    (
        "holds partly",
        "a weaker form of the claim holds, or the claim holds for some of the measurements",
    ),
    (
        "does not hold here",
        "the interval is outside the claim, on the device and in the scenes of these runs",
    ),
    ("undecided", "the interval reaches beyond a bound of the claim; more samples are needed"),
    ("not measured", "the run that decides the claim is missing"),
)
# A number with its interval, tolerance or unit, which no line breaks within.
UNBROKEN = re.compile(
    r"(?<![\w.#:-])[-+−]?\d[\d.]*(?:e[-+]?\d+)?(?: ± [\d.]+| \[[-+−\d.e, ]+\])?(?:"
    r" ?%)?(?![\w-])|\[[-+−\d.e, ]+\]"
)


def unbroken(found):
    """Returns a number in HTML that keeps it on one line."""
    return "<span class=n>" + re.sub(r"(?<![\w.])-(?=\d)", "−", found.group()) + "</span>"


def prose(text):
    """Returns text as HTML: escaped, with numbers and intervals that stay on one line and have
    minus signs."""
    return markupsafe.Markup(UNBROKEN.sub(unbroken, str(markupsafe.escape(text))))


# Characters: cells up to SHORT do not break, those above LONG take a wide column.
SHORT, LONG = 20, 60


def cell_class(cell, numeric):
    """Returns the class of a table's cell."""
    if numeric:
        return "number"
    return "n" if len(cell) <= SHORT else "long" if len(cell) > LONG else "text"


@functools.cache
def template(name):
    """Returns a template of the folder "templates"."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(TEMPLATES),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        autoescape=lambda file: file is not None and not file.endswith(".md"),
    )
    environment.filters.update(prose=prose, verdict=verdict_of, cell_class=cell_class)
    environment.tests["link"] = lambda cell: isinstance(cell, Link)
    environment.tests["lines"] = lambda cell: isinstance(cell, Lines)
    environment.globals.update(metrics=METRICS, legend=LEGEND, verdict_words=VERDICTS)
    return environment.get_template(name)
