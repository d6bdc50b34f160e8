# SPDX-License-Identifier: MIT
"""Tests cells, and the forms of tables."""

import unittest

from rtrays.documents.document import RunError
from rtrays.tables.cells import verdict_of
from rtrays.tables.table import Table, latex_escape


class Cells(unittest.TestCase):
    def test_verdicts_are_read_from_the_start_of_a_cell(self):
        for cell, word in (
            ("holds", "holds"),
            ("holds partly", "holds partly"),
            ("undecided: about 4 times as many samples would decide it", "undecided"),
            ("holds, of what was measured", "holds"),
            ("holds if", None),
        ):
            self.assertEqual(verdict_of(cell), word, cell)


class Forms(unittest.TestCase):
    def test_columns_of_numbers_are_right_aligned(self):
        table = Table("t", ["a", "b", "c"], [["x", "1.5 [1, 2]", "–"], ["y", "-3e-05", "12 of 70"]])
        self.assertEqual(table.numeric, [False, True, True])
        self.assertIn("| --- | ---: | ---: |", table.markdown())

    def test_columns_are_chosen_by_their_heads(self):
        table = Table("t", ["a", "b", "c"], [["1", "2", "3"], ["4", "5", "6"]])
        chosen = table.with_columns(["c", "a"])
        self.assertEqual((chosen.columns, chosen.rows), (["c", "a"], [["3", "1"], ["6", "4"]]))
        self.assertEqual(table.with_columns([]).rows, table.rows)
        with self.assertRaisesRegex(RunError, "unknown column 'd'; columns are: a; b; c"):
            table.with_columns(["d"])

    def test_latex_is_escaped(self):
        self.assertEqual(latex_escape("50 % & a_b"), r"50 \% \& a\_b")


if __name__ == "__main__":
    unittest.main()
