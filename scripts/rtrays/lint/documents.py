# SPDX-License-Identifier: MIT
"""Checks of documents: links, equation numbers, generated blocks, and file names of results."""

import pathlib
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


def check_equations(report):
    """Compares the equation numbers that kernels cite with docs/mis-weights.md."""
    page = pathlib.Path("docs/mis-weights.md")
    text = text_of(page)
    equations = set(map(int, re.findall(r"\\tag\{(\d+)\}", text)))
    for path in report.of(".h", ".cl", ".cpp", under="renderer/"):
        for number, line in lines_of(path):
            for equation in sorted(cited(line) - equations):
                report.offence(path, number, f"no such equation: MIS ({equation})")
    for number, line in lines_of(page):
        for rule in row_offences(line):
            report.offence(page, number, rule)


def cited(text):
    """Returns the numbers of the equations that a text cites, as in "MIS (2)-(5) and (7)"."""
    numbers = set()
    for run in re.findall(r"MIS (\(\d+\)(?:(?:-|, | and )\(\d+\))*)", text):
        numbers.update(map(int, re.findall(r"\d+", run)))
    return numbers


def row_offences(line):
    """Returns what is wrong in a row of the table of equations: a function that none of its files
    defines, or an equation that none of them cites."""
    row = re.match(r"\| (\(\d+\)[^|]*)\| ([^|]*)\| ([^|]*`[\w/]+\.h`[^|]*)\|", line)
    if not row:
        return []
    equations = [int(number) for number in re.findall(r"\d+", row.group(1))]
    functions, files = (re.findall(r"`([^`]+)`", cell) for cell in row.groups()[1:])
    paths = [pathlib.Path("renderer/kernels") / file for file in files]
    code = "\n".join(text_of(path) for path in paths if (ROOT / path).exists())
    defined = set(re.findall(r"^DEVICE .*?(\w+)\(", code, re.MULTILINE))
    return (
        [f"no such file: {path}" for path in paths if not (ROOT / path).exists()]
        + [f"not defined: {function}" for function in functions if function not in defined]
        + [f"not cited: MIS ({number})" for number in equations if number not in cited(code)]
    )
