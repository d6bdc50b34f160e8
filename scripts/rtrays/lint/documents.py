# SPDX-License-Identifier: MIT
"""Checks of documents: links, generated blocks, and file names of results."""

import re

from rtrays.lint.report import lines_of, text_of
from rtrays.paths import ROOT

LINK = re.compile(r"\]\(([^)\s]+)\)|(?:src|href)=\"([^\"]+)\"")


def check_links(report):
    """Looks for broken links in Markdown files."""
    for path in report.of(".md"):
        if path.parent.name != "templates":
            for number, line in lines_of(path):
                for found in LINK.finditer(re.sub(r"`[^`]*`", "", line)):
                    check_link(report, path, number, found.group(1) or found.group(2))


def check_link(report, path, number, target):
    """Checks that the file and the heading of a link exist."""
    if re.match(r"[a-z]+:", target):
        return
    file, _, anchor = target.partition("#")
    linked = (ROOT / path).parent / file if file else ROOT / path
    if not linked.exists():
        report.offence(path, number, f"broken link: {target}")
    elif anchor and linked.suffix == ".md" and anchor not in anchors(linked.read_text()):
        report.offence(path, number, f"no such heading: {target}")


def anchors(text):
    """Returns the anchors of a Markdown file's headings, as GitHub makes them."""
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def check_results(report):
    """Checks file names of results, and the generated blocks of documents."""
    for path in report.files:
        if str(path).startswith("results/") and re.search(r"[ ,]", str(path)):
            report.offence(path, 1, "blank or comma in a file name of results")
    generated = [path for path in report.documents() if "<!-- generated:" in text_of(path)]
    report.run("/usr/bin/python3", "scripts/summary", "--check", *generated)
