# SPDX-License-Identifier: MIT
"""Tests the verdicts on curves."""

import copy
import unittest

from rtrays.tables.verdict_table import verdict_table
from rtrays.testing import RunFolder


class VerdictTable(RunFolder):
    def test_slopes_are_judged_where_the_claim_is_made(self):
        self.document["curves"][0]["settings"]["integrator.sampler"] = "sobol"
        self.document["curves"].append(copy.deepcopy(self.document["curves"][1]))
        self.document["curves"][2].update({"id": "light_tracing.mis", "algorithm": "light_tracing"})
        self.document["curves"][2]["render_report"]["features"] = ["delta"]
        slopes = [
            row[-1].partition(":")[0]
            for row in verdict_table(self.run_object()).rows
            if row[1].startswith("slope")
        ]
        self.assertEqual(slopes, ["not expected", "holds", "not expected"])

    def test_gains_are_over_path_tracing_under_the_same_settings(self):
        self.document["experiment"]["expected_gain"] = {
            "algorithm": "truncated_bdpt",
            "samples": 4,
            "time": 2,
        }
        pinned = {"integrator.light_selection": "uniform"}
        for algorithm, settings in (
            ("path_tracing", pinned),
            ("truncated_bdpt", pinned),
            ("truncated_bdpt", {}),
        ):
            curve = copy.deepcopy(self.document["curves"][1])
            name = ",light_selection=uniform" if settings else ""
            curve.update(id=f"{algorithm}.mis{name}", algorithm=algorithm, settings=settings)
            self.document["curves"].insert(1, curve)
        gains = [
            row[:2]
            for row in verdict_table(self.run_object()).rows
            if row[1].startswith("gain") and row[1].endswith("samples")
        ]
        self.assertEqual(
            gains,
            [
                ["truncated BDPT (MIS)", "gain over path tracing (MIS) in equal samples"],
                [
                    "truncated BDPT (MIS, light selection = uniform)",
                    "gain over path tracing (MIS, light selection = uniform) in equal samples",
                ],
            ],
        )


if __name__ == "__main__":
    unittest.main()
