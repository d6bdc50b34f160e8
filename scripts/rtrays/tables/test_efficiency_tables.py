# SPDX-License-Identifier: MIT
"""Tests the tables of efficiency, memory and throughput."""

import copy
import csv
import io
import unittest

from rtrays.documents.document import RunError
from rtrays.pages.curve_findings import finding
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

    def test_another_renderer_is_compared_in_wall_time(self):
        other = self.document["curves"][0]
        for key in ("algorithm", "strategies", "settings", "render_report", "bvh_seconds"):
            del other[key]
        other.update(id="cycles", engine="Cycles 9")
        for point in other["points"]:
            for repetition in point["repetitions"]:
                repetition.update(seconds_device=0.3, seconds_wall=0.3)
        run = self.run_object()
        table = efficiency_table(run)
        self.assertIn("gain in equal wall time, times", table.columns)
        rows = {row[0]: row for row in table.rows}
        self.assertEqual(rows["path tracing (MIS)"][3], "0.8")  # wall time
        self.assertEqual(rows["Cycles 9"][3:], ["0.3", "0", "1 [1, 1]", "2.667 [2.667, 2.667]"])
        self.assertEqual([row[0] for row in memory_table(run).rows], ["path tracing (MIS)"])
        self.assertIn("In equal wall time Cycles 9 has the highest efficiency", finding(run))

    def add_sobol_curves(self):
        """Adds path tracing and truncated BDPT with Sobol points, whose MSE falls as N^-1.5. At 4
        spp truncated BDPT has a quarter of the MSE without noise, in twice the time."""
        usual = self.document["curves"][-1]
        for algorithm in ("path_tracing", "truncated_bdpt"):
            curve = copy.deepcopy(usual)
            curve.update(
                id=f"{algorithm}.mis,sampler=sobol",
                algorithm=algorithm,
                settings={"integrator.sampler": "sobol"},
                slope_unbiased={**curve["slope_unbiased"], "value": -0.75},
            )
            self.document["curves"].insert(0, curve)
        for repetition in self.document["curves"][0]["points"][2]["repetitions"]:
            repetition.update(mse=0.01 + 0.24 / 4, seconds_device=2 * 0.4)

    def test_gains_are_also_over_path_tracing_with_the_same_sampler(self):
        self.add_sobol_curves()
        rows = {row[0]: row for row in efficiency_table(self.run_object()).rows}
        self.assertEqual(
            rows["truncated BDPT (MIS, sampler = sobol)"][5:],
            ["4 [4, 4]", "2 [2, 2]", "path tracing (MIS, sampler = sobol)", "4 [4, 4]"]
            # Twice the samples lower the error of path tracing by 2^1.5.
            + ["1.414 [1.414, 1.414]"],
        )
        self.assertEqual(
            rows["path tracing (MIS, sampler = sobol)"][5:], ["1 [1, 1]"] * 2 + ["–"] * 3
        )
        self.assertEqual(rows["path tracing (MIS)"][7:], ["–"] * 3)

    def test_the_finding_has_the_gains_of_both_samplers_and_of_the_best_setting(self):
        self.add_sobol_curves()
        truncated = copy.deepcopy(self.document["curves"][-1])
        truncated.update(id="truncated_bdpt.mis", algorithm="truncated_bdpt")
        self.document["curves"].insert(0, truncated)
        self.document["experiment"]["expected_gain"] = {
            "algorithm": "truncated_bdpt",
            "samples": 4,
            "time": 2,
        }
        self.assertEqual(
            finding(self.run_object()),
            "In equal device time truncated BDPT (MIS) has 1.00 [1.00, 1.00] times the efficiency"
            " of path tracing (MIS); the thesis claims 2. With the same sampler on both sides,"
            " truncated BDPT (MIS, sampler = sobol) has 1.41 [1.41, 1.41] times the efficiency of"
            " path tracing (MIS, sampler = sobol). In equal device time truncated BDPT (MIS,"
            " sampler = sobol) has the highest efficiency, 2.00 [2.00, 2.00] times that of path"
            " tracing (MIS) with independent samples.",
        )

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
