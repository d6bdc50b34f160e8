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


if __name__ == "__main__":
    unittest.main()
