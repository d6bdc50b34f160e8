# SPDX-License-Identifier: MIT
"""Tests the tables of efficiency, memory and throughput."""

import csv
import io
import unittest

from rtrays.documents.document import RunError
from rtrays.tables.efficiency_tables import efficiency_table, memory_table, throughput_table
from rtrays.testing import RunFolder


class EfficiencyTables(RunFolder):
    def test_efficiency_compares_what_is_beyond_the_reference_noise(self):
        mis, other = self.document["curves"][1], self.document["curves"][0]
        # At 4 spp the MSE is 0.25, 0.01 of it that of the reference. The other curve has twice the
        # rest in twice the time of 0.4 s, of which its pilot is 0.2 s.
        for repetition in other["points"][2]["repetitions"]:
            repetition.update(mse=0.01 + 2 * 0.24, seconds_device=0.6 + 0.2)
        other["render_report"]["pilot"] = {"seconds": 0.2}
        rows = {row[0]: row for row in efficiency_table(self.run_object()).rows}
        self.assertEqual(rows["path tracing (MIS)"][5:], ["1 (baseline)", "1 (baseline)"])
        self.assertEqual(
            rows["path tracing (implicit)"][3:],
            ["0.8", "0.2", "0.5 [0.5, 0.5]", "0.25 [0.25, 0.25]"],
        )
        mis["points"][0]["noise_dominates"] = True
        with self.assertRaisesRegex(RunError, "path_tracing.mis has no point above"):
            efficiency_table(self.run_object())

    def test_memory_is_what_the_run_reports(self):
        self.document["curves"][0]["algorithm"] = "bdpt"
        self.assertEqual(
            memory_table(self.run_object()).rows[0][1:],
            ["112", "0", "3.5 KB, 16 vertices from either end"],
        )

    def test_refused_throughput_is_said(self):
        self.document["throughput"] = {
            "curve": "path_tracing.mis",
            "accepted": False,
            "reason": "foreign load",
            "repetitions": [],
            "samples_per_repetition": 1.0,
        }
        self.assertIn("Refused: foreign load.", throughput_table(self.run_object()).markdown())

    def test_intervals_have_three_columns_of_numbers_in_csv(self):
        rows = list(csv.reader(io.StringIO(efficiency_table(self.run_object()).csv())))
        column = rows[0].index("gain in equal device time, times")
        self.assertEqual(rows[0][column + 1], "gain in equal device time, times low")
        self.assertEqual([float(cell) for cell in rows[1][column : column + 3]], [1.0, 1.0, 1.0])


if __name__ == "__main__":
    unittest.main()
