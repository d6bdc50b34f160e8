# SPDX-License-Identifier: MIT
"""Pages as data, and their HTML and Markdown forms, which the templates in scripts/templates make.

HTML pages have relative links, need no network and open from a file.
"""

import dataclasses
import functools
import os
import pathlib
import re

import jinja2
import markupsafe

from cells import VERDICTS, Lines, Link, verdict_of
from run_document import ROOT, write_text

TEMPLATES = pathlib.Path(__file__).with_name("templates")
STATISTICS = ROOT / "docs/statistics.md"
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


@dataclasses.dataclass
class Text:
    """A paragraph."""

    text: str
    kind = "text"


@dataclasses.dataclass
class Figure:
    """A picture in the page's folder; SVG files have a PNG beside them if `png`."""

    file: str
    caption: str
    png: bool = False
    kind = "figure"


@dataclasses.dataclass
class TableBlock:
    """A table under a heading; `files` is the path of its CSV and LaTeX forms without their
    extensions."""

    table: object
    files: str = ""
    kind = "table"


@dataclasses.dataclass
class Viewer:
    """The interactive image comparison, or the sentence that replaces it where the images are
    missing."""

    missing: str = ""
    kind = "viewer"


@dataclasses.dataclass
class Page:
    """One page of a folder: `finding` is its first sentence, `verdicts` what it judges, `picture`
    what its card shows."""

    folder: pathlib.Path
    markdown: str
    title: str
    finding: str
    blocks: list
    source: str = ""
    claim: str = ""
    claim_head: str = "The thesis claims"
    provenance: list = dataclasses.field(default_factory=list)
    verdicts: list = dataclasses.field(default_factory=list)
    picture: str = ""
    picture_label: str = ""
    made: dict = dataclasses.field(
        default_factory=dict
    )  # device, commit, finished, profile of the run

    def write(self):
        """Writes index.html and the Markdown page into the folder."""
        links = site_links(self.folder)
        write_text(self.folder / "index.html", template("page.html").render(page=self, links=links))
        write_text(
            self.folder / self.markdown, tidy(template("page.md").render(page=self, links=links))
        )


def relative(path, folder):
    return pathlib.Path(os.path.relpath(path, folder.resolve())).as_posix()


def site_links(folder):
    """Links from a page to the overview and its parts, where the parent folder has one, and to the
    documentation."""
    inside = folder.resolve().is_relative_to(ROOT)
    return {
        "home": "../" if (folder.parent / "index.md").exists() else "",
        "claims": "../claims/" if (folder.parent / "claims").is_dir() else "",
        "statistics": relative(STATISTICS, folder) if inside else "",
    }


def tidy(markdown):
    """Removes the blank lines that a template leaves beyond one, and those at the ends."""
    return re.sub(r"\n{3,}", "\n\n", markdown).strip() + "\n"


# A number with its interval, tolerance or unit, which no line breaks within.
UNBROKEN = re.compile(
    r"(?<![\w.#:-])[-+−]?\d[\d.]*(?:e[-+]?\d+)?(?: ± [\d.]+| \[[-+−\d.e, ]+\])?(?:"
    r" ?%)?(?![\w-])|\[[-+−\d.e, ]+\]"
)


def unbroken(found):
    return "<span class=n>" + re.sub(r"(?<![\w.])-(?=\d)", "−", found.group()) + "</span>"


def prose(text):
    """Escapes text, keeps its numbers and intervals on one line, and sets their minus signs."""
    return markupsafe.Markup(UNBROKEN.sub(unbroken, str(markupsafe.escape(text))))


SHORT, LONG = (
    20,
    60,
)  # characters: cells up to SHORT do not break, those above LONG take a wide column


def cell_class(cell, numeric):
    """Returns the class of a table's cell."""
    return (
        "number"
        if numeric
        else "n" if len(cell) <= SHORT else "long" if len(cell) > LONG else "text"
    )


@functools.cache
def template(name):
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
