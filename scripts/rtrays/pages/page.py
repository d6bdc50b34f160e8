# SPDX-License-Identifier: MIT
"""Pages as data, and their HTML and Markdown files, which the templates make.

HTML pages have relative links, need no network and open from a file.
"""

import dataclasses
import os
import pathlib
import re

from rtrays.documents.document import write_text
from rtrays.pages.rendering import template
from rtrays.paths import ROOT

STATISTICS = ROOT / "docs/statistics.md"


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
    made: dict = dataclasses.field(default_factory=dict)  # provenance.made_by

    def write(self):
        """Writes index.html and the Markdown page into the folder."""
        links = site_links(self.folder)
        write_text(self.folder / "index.html", template("page.html").render(page=self, links=links))
        write_text(
            self.folder / self.markdown, tidy(template("page.md").render(page=self, links=links))
        )


def relative(path, folder):
    """Returns a path relative to a folder, for links."""
    return pathlib.Path(os.path.relpath(path, folder.resolve())).as_posix()


def site_links(folder):
    """Returns the links of a page: to the overview and its parts, where the parent folder has one,
    and to the documentation."""
    inside = folder.resolve().is_relative_to(ROOT)
    return {
        "home": "../" if (folder.parent / "index.md").exists() else "",
        "claims": "../claims/" if (folder.parent / "claims").is_dir() else "",
        "statistics": relative(STATISTICS, folder) if inside else "",
    }


def tidy(markdown):
    """Removes the blank lines that a template leaves beyond one, and those at the ends."""
    return re.sub(r"\n{3,}", "\n\n", markdown).strip() + "\n"


def markdown_name(folder):
    """Returns the name of the Markdown page of a run's folder."""
    return "report.md" if (folder / "report.md").exists() else f"{folder.name}.md"
