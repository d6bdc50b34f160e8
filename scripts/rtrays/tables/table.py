# SPDX-License-Identifier: MIT
"""Tables, and their CSV, Markdown and LaTeX forms."""

import csv
import io
import re

from rtrays.documents.document import RunError, write_text
from rtrays.tables.cells import Interval, Lines, Link

# Numbers and intervals with units, ranges, and counts, as tables print them. An empty cell or a
# dash takes the place of a missing number.
NUMERIC = re.compile(
    r"(–|[-+−<]?\s?[\d.]+(e[-+]?\d+)?( \[[^\]]*\])?( %| ms| MB)?"
    r"|\d+ of \d+|(up to )?[\d.]+( to [\d.]+)?( \([\d.]+ to [\d.]+\))?|)"
    r"( \((baseline|off|undecided|imprecise)\))?"
)
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
    """Returns the text with the special characters of LaTeX escaped."""
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

    @classmethod
    def of(cls, caption, columns, items, notes=()):
        """Returns a table with a row for each item; `columns` are (head, function that makes the
        cell of an item)."""
        rows = [[cell(item) for _, cell in columns] for item in items]
        return cls(caption, [head for head, _ in columns], rows, notes)

    def with_columns(self, heads):
        """Returns the table with some of its columns, in the given order; all without any. Raises
        RunError for an unknown one."""
        unknown = [head for head in heads if head not in self.columns]
        if unknown:
            raise RunError(
                f"unknown column '{unknown[0]}'; columns are: {'; '.join(self.columns)}"
            )
        kept = [self.columns.index(head) for head in heads] or range(len(self.columns))
        return Table(
            self.caption,
            [self.columns[i] for i in kept],
            [[row[i] for i in kept] for row in self.rows],
            self.notes,
        )

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
        """Returns the table as CSV; intervals become three columns: NAME, NAME low, NAME high."""
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
        """Returns the table and its notes as Markdown."""

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
        """Returns the table for the package booktabs; numbers are right-aligned."""

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
