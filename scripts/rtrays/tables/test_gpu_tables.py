# SPDX-License-Identifier: MIT
"""Tests the tables of a GPU."""

import unittest

from rtrays.paths import RESULTS
from rtrays.tables.gpu_tables import gpu_markdown


class GpuTables(unittest.TestCase):
    def test_the_stored_tables_are_of_the_stored_runs(self):
        self.assertEqual(
            gpu_markdown(RESULTS / "gpu/h100", RESULTS / "chapter4") + "\n",
            (RESULTS / "gpu/h100.md").read_text(),
            "scripts/results gpu results/gpu/h100 results/chapter4 > results/gpu/h100.md",
        )


if __name__ == "__main__":
    unittest.main()
