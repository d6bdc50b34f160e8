# SPDX-License-Identifier: MIT
"""Tables of text: numbers, intervals and links as cells, and the CSV, Markdown and LaTeX forms of
a table."""

import csv
import io
import re

from run_document import value, write_text

NONE = "–"
VERDICTS = ("holds", "holds partly", "does not hold here", "undecided", "not measured")
# Numbers and intervals with units, ranges, and counts, as tables print them; an empty cell or a
# dash
# takes the place of a missing number.
NUMERIC = re.compile(
    r"(–|[-+−<]?\s?[\d.]+(e[-+]?\d+)?( \[[^\]]*\])?( %| ms| MB)?"
    r"|\d+ of \d+|(up to )?[\d.]+( to [\d.]+)?( \([\d.]+ to [\d.]+\))?|)"
    r"( \((baseline|off|undecided|imprecise)\))?"
)


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


LATEX_SPECIAL = {
    "\\": r"\textbackslash{}",
    "&": r"\&",
    "%": r"\%",
    "$": r"\$",
    "#": r"\#",
    "_": r"\_",
    "{": r"\{",
    "}": r"\}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
}


def latex_escape(text):
    return "".join(LATEX_SPECIAL.get(character, character) for character in text)


class Table:
    """A caption, column heads, rows of cells, and notes below them; `widths` are those of the
    columns in percent."""

    def __init__(self, caption, columns, rows, notes=(), widths=()):
        self.caption = caption
        self.columns = columns
        self.rows = rows
        self.notes = [note for note in notes if note]
        self.widths = widths

    @property
    def numeric(self):
        """Whether a column holds numbers alone, which are right-aligned."""
        return [
            bool(self.rows)
            and any(row[i] for row in self.rows)
            and all(NUMERIC.fullmatch(row[i]) for row in self.rows)
            for i in range(len(self.columns))
        ]

    def csv(self):
        """Intervals become three columns: NAME, NAME low, NAME high."""
        split = [
            any(isinstance(row[i], Interval) for row in self.rows) for i in range(len(self.columns))
        ]
        stream = io.StringIO()
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(
            [
                name
                for column, three in zip(self.columns, split)
                for name in ([column, f"{column} low", f"{column} high"] if three else [column])
            ]
        )
        for row in self.rows:
            writer.writerow(
                [part for cell, three in zip(row, split) for part in csv_parts(cell, three)]
            )
        return stream.getvalue()

    def markdown(self):
        def line(cells):
            return "| " + " | ".join(cells) + " |"

        def cell(text):
            joined = "<br>".join(text.parts) if isinstance(text, Lines) else text
            escaped = joined.replace("|", "\\|")
            return f"[{escaped}]({text.markdown})" if isinstance(text, Link) else escaped

        marks = ["---:" if right else "---" for right in self.numeric]
        lines = [
            line(map(cell, self.columns)),
            line(marks),
            *(line(map(cell, row)) for row in self.rows),
        ]
        return "\n".join(lines) + "\n" + "".join(f"\n{note}\n" for note in self.notes)

    def latex(self):
        """A table for the package booktabs; numbers are right-aligned."""

        def line(cells):
            return "    " + " & ".join(latex_escape(cell) for cell in cells) + r" \\"

        alignment = "".join("r" if right else "l" for right in self.numeric)
        return "\n".join(
            [
                r"\begin{table}",
                r"  \centering",
                rf"  \caption{{{latex_escape(self.caption)}}}",
                rf"  \begin{{tabular}}{{{alignment}}}",
                r"    \toprule",
                line(self.columns),
                r"    \midrule",
                *map(line, self.rows),
                r"    \bottomrule",
                r"  \end{tabular}",
                r"\end{table}",
                "",
            ]
        )

    def write(self, folder, name):
        """Writes NAME.csv, NAME.md and NAME.tex."""
        folder.mkdir(exist_ok=True)
        write_text(folder / f"{name}.csv", self.csv())
        write_text(folder / f"{name}.md", f"{self.caption}\n\n{self.markdown()}")
        write_text(folder / f"{name}.tex", self.latex())


def csv_parts(cell, three):
    """Returns the cell, or the three numbers of an interval; a column of intervals may have other
    cells too."""
    if not three:
        return [cell]
    return [f"{x:.6g}" for x in cell.numbers] if isinstance(cell, Interval) else [cell, "", ""]
