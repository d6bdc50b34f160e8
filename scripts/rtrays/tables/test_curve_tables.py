# SPDX-License-Identifier: MIT
"""Tests the tables of a run of curves."""

import csv
import io
import unittest

from rtrays.documents.document import RunError
from rtrays.tables.curve_tables import TABLES, errors_table, repetitions_table
from rtrays.testing import RunFolder


class CurveTables(RunFolder):
    def test_missing_values_are_errors(self):
        for path, where in (
            ("rmse", self.document["curves"][0]["points"][1]),
            ("l2", self.document["curves"][1]["points"][0]),
        ):
            kept = where.pop(path)
            with self.assertRaisesRegex(RunError, path):
                errors_table(self.run_object())
            where[path] = None
            with self.assertRaisesRegex(RunError, path):
                errors_table(self.run_object())
            where[path] = kept
        errors_table(self.run_object())

    def test_forms_hold_the_same_cells(self):
        table = errors_table(self.run_object())
        rows = list(csv.reader(io.StringIO(table.csv())))
        self.assertEqual(rows[0], table.columns)
        self.assertEqual(rows[1:], table.rows)
        self.assertEqual(len(table.rows), 8)
        self.assertEqual(table.markdown().count("\n"), 10)
        self.assertEqual(table.latex().count(r"\\"), 9)
        self.assertIn(r"\toprule", table.latex())

    def test_repetitions_are_exact(self):
        table = repetitions_table(self.run_object())
        self.assertEqual(len(table.rows), 2 * 4 * 8)
        self.assertEqual(
            float(table.rows[0][table.columns.index("rmse")]),
            self.document["curves"][0]["points"][0]["repetitions"][0]["rmse"],
        )

    def test_times_contain_the_pilot(self):
        curve = self.document["curves"][0]
        curve["render_report"]["pilot"] = {"seconds": 3.0}
        run = self.run_object()
        table, raw = errors_table(run), repetitions_table(run)
        self.assertEqual(table.rows[0][table.columns.index("wall time, s")], "3.2")
        self.assertEqual(table.rows[0][table.columns.index("device time, s")], "0.1")
        self.assertEqual(float(raw.rows[0][raw.columns.index("seconds_wall")]), 3.2)
        self.assertIn("its device time is added", table.notes[0])

    def test_wall_times_that_contain_the_pilot_stay(self):
        curve = self.document["curves"][0]
        curve["render_report"]["pilot"] = {"seconds": 3.0, "seconds_wall": 4.0}
        run = self.run_object()
        table, raw = errors_table(run), repetitions_table(run)
        self.assertEqual(table.rows[0][table.columns.index("wall time, s")], "0.2")
        self.assertEqual(float(raw.rows[0][raw.columns.index("seconds_wall")]), 0.2)
        self.assertEqual(
            table.notes[0], "Both times include the pilot that chooses the number of light paths."
        )

    def test_script_writes_all_forms(self):
        self.run_object()
        done = self.results("tabulate", self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        for name in TABLES:
            for extension in ("csv", "md", "tex"):
                self.assertTrue((self.folder / "tables" / f"{name}.{extension}").stat().st_size > 0)


if __name__ == "__main__":
    unittest.main()
