# SPDX-License-Identifier: MIT
"""Tests the page of a measurement without builds."""

import json
import pathlib
import tempfile
import unittest

from rtrays.paths import RESULTS
from rtrays.testing import script


class MeasurementPage(unittest.TestCase):
    def test_a_measurement_without_builds_has_a_plot(self):
        document = json.loads((RESULTS / "chapter4/ablations/run.json").read_text())
        for row in document["rows"]:
            row["frames"], row["builds"] = row["frames"][:2], row["builds"][:1]
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "run.json").write_text(json.dumps(document))
            result = script("results", "page", folder)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertTrue((pathlib.Path(folder) / "speeds_over_defaults.svg").exists())


if __name__ == "__main__":
    unittest.main()
