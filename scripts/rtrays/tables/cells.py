# SPDX-License-Identifier: MIT
"""Cells of tables: numbers, intervals, links and verdicts as text."""

import re

from rtrays.documents.document import value
from rtrays.documents.verdicts import VERDICTS

NONE = "–"


class Interval(str):
    """The text "value [low, high]"; CSV has the three numbers in three columns."""

    def __new__(cls, text, numbers=()):
        made = super().__new__(cls, text)
        made.numbers = numbers
        return made


BASELINE = Interval("1 (baseline)", [1, 1, 1])


class Link(str):
    """A cell that leads to another page: its folder, relative to the table's page, and the name of
    its Markdown file."""

    def __new__(cls, text, folder="", markdown=""):
        made = super().__new__(cls, text)
        made.html = f"{folder}/index.html"
        made.markdown = f"{folder}/{markdown}"
        return made


class Lines(str):
    """A cell of several parts, one a line; CSV and LaTeX have them in one line."""

    def __new__(cls, parts=""):
        made = super().__new__(cls, parts if isinstance(parts, str) else "; ".join(parts))
        made.parts = [parts] if isinstance(parts, str) else list(parts)
        return made


def number(quantity, digits=3):
    """Returns a number of so many significant digits, without an exponent where it is large."""
    return f"{quantity:.{digits}g}" if abs(quantity) < 10**digits else f"{quantity:.0f}"


def interval(document, scale=1.0, form=None, digits=3):
    """Returns the cell "value [low, high]"; `form` is a format, and without it numbers have
    `digits` digits."""
    numbers = [scale * value(document, key) for key in ("value", "low", "high")]
    texts = [form.format(x) if form else number(x, digits) for x in numbers]
    return Interval(f"{texts[0]} [{texts[1]}, {texts[2]}]", numbers)


def ratio(entry):
    """Returns the cell of a ratio; the contestant that all others are compared with is the
    baseline."""
    is_baseline = all(value(entry, key) == 1 for key in ("value", "low", "high"))
    return BASELINE if is_baseline else interval(entry)


def verdict_of(cell):
    """Returns the verdict that a cell states at its start, or None."""
    return next((word for word in VERDICTS if re.match(rf"{word}($|[,:;])", cell)), None)
