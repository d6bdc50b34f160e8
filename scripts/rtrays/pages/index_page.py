# SPDX-License-Identifier: MIT
"""The overview of several runs: the verdicts on the thesis' claims, three charts, and a card for
every experiment."""

import dataclasses
import re

from rtrays.claims.claims_page import claims_page, overview
from rtrays.claims.judge import all_counts, is_thesis, judge_all, summary, verdicts_of_run
from rtrays.documents.document import write_text
from rtrays.pages.page import relative, site_links, tidy
from rtrays.pages.rendering import template
from rtrays.plots.gains_chart import gains_chart
from rtrays.plots.hierarchy_chart import hierarchy_chart
from rtrays.plots.speeds_chart import speeds_chart
from rtrays.tables.cells import Link
from rtrays.tables.table import Table


@dataclasses.dataclass
class Card:
    """What the overview shows of one page."""

    title: str
    finding: str
    html: str
    verdicts: dict
    picture: str
    picture_label: str


@dataclasses.dataclass
class Index:
    """The data of the overview; `counts` is empty for runs that are not the thesis'."""

    title: str
    made: str
    cards: list
    runs: Table
    experiments: Table
    skipped: list = dataclasses.field(default_factory=list)
    summary: str = ""
    counts: dict = dataclasses.field(default_factory=dict)
    overview: Table = None
    charts: list = dataclasses.field(default_factory=list)


def tally(words):
    """Returns {word: how often it occurs}."""
    return {word: words.count(word) for word in dict.fromkeys(words)}


def card(folder, page, sections):
    """A page's card; its marks are the verdicts on the claims that the run decides, or else those
    of the page."""
    base = page.folder.resolve()
    picture = page.folder / page.picture if page.picture else None
    return Card(
        page.title,
        page.finding,
        relative(base / "index.html", folder),
        verdicts_of_run(sections, page.folder.name) or tally(page.verdicts),
        relative(picture.resolve(), folder) if picture and picture.exists() else "",
        page.picture_label,
    )


def text_of(values):
    """The values that runs share, or how many different ones there are."""
    found = [value for value in dict.fromkeys(values) if value]
    return ", ".join(found) if len(found) <= 3 else f"{len(found)} different"


def made_line(pages):
    """Device, profile, commits and dates of the runs in one line."""
    made = [page.made for page in pages if page.made]
    dates = sorted(m["finished"][:10] for m in made if m["finished"])
    days = f"{dates[0]} to {dates[-1]}" if dates and dates[0] != dates[-1] else "".join(dates[:1])
    return (
        f"Device: {text_of(m['device'] for m in made)}. Profile:"
        f" {text_of(m['profile'] for m in made)}. Runs finished {days or 'on unknown dates'};"
        f" commits: {text_of(m['commit'] for m in made)}."
    )


def runs_table(folder, pages):
    """Returns where and when the runs were made."""
    rows = [
        [
            Link(page.title, relative(page.folder.resolve(), folder), page.markdown),
            *(page.made.get(key, "") for key in ("profile", "device", "commit", "finished")),
        ]
        for page in pages
    ]
    return Table("Runs", ["run", "profile", "device", "commit", "finished"], rows)


def experiments_table(folder, pages, cards):
    """Returns finding and verdicts of all runs."""
    rows = [
        [
            Link(page.title, relative(page.folder.resolve(), folder), page.markdown),
            page.finding,
            ", ".join(f"{count} × {word}" for word, count in entry.verdicts.items()),
        ]
        for page, entry in zip(pages, cards)
    ]
    return Table("Experiments", ["experiment", "finding", "verdicts"], rows)


def place(page):
    """The order of the cards: runs of curves by the thesis' sections, then the others by name."""
    curves = page.markdown == "report.md"
    found = re.match(r"section (\d+)\.(\d+)(?:\.(\d+))?", page.source) if curves else None
    section = [int(part or 99) for part in found.groups()] if found else [99]
    return not curves, section, page.folder.name


def write_index(folder, pages, skipped):
    """Writes index.html, index.md, the charts and claims/ into the common parent folder of the
    pages."""
    folder, pages = folder.resolve(), sorted(pages, key=place)
    sections = judge_all(folder)
    thesis = is_thesis(sections)
    shown = sections if thesis else []
    cards = [card(folder, page, shown) for page in pages]
    index = Index(
        (
            "RTRays: chapter 4 of the thesis, reproduced"
            if thesis
            else f"RTRays: {len(pages)} experiments in {folder.name}"
        ),
        made_line(pages),
        cards,
        runs_table(folder, pages),
        experiments_table(folder, pages, cards),
        skipped,
    )
    if thesis:
        index.summary, index.counts, index.overview = (
            summary(sections),
            all_counts(sections),
            overview(sections),
        )
        index.charts = [chart(folder) for chart in (gains_chart, speeds_chart, hierarchy_chart)]
    links = {"statistics": site_links(folder / "any")["statistics"].removeprefix("../")}
    write_text(folder / "index.html", template("index.html").render(index=index, links=links))
    write_text(folder / "index.md", tidy(template("index.md").render(index=index, links=links)))
    if thesis:
        claims_page(sections, folder).write()  # last, since it links to the overview
