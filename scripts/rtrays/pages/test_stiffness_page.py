# SPDX-License-Identifier: MIT
"""Tests the map of stiffness of a survey of two algorithms: what is off, and what the reference's
noise hides."""

import json
import pathlib
import tempfile
import unittest

from rtrays.testing import script


def row(algorithm, stiffness, mse, verdict="ok"):
    return {
        "case": f"gloss {stiffness}",
        "group": "gloss",
        "title": "A floor",
        "algorithm": algorithm,
        "stiffness": stiffness,
        "mse": mse,
        "mse_expected": 1e-4,
        "seconds": 2.0,
        "verdict": verdict,
        "spp": 64,
    }


class Stiffness(unittest.TestCase):
    def make(self, rows):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "run.json").write_text(
                json.dumps(
                    {
                        "schema_version": 3,
                        "kind": "stability",
                        "experiment": {"name": "stiff", "profile": "ci", "batches": 32},
                        "context": {
                            "commit": "0123456789abcdef",
                            "dirty": False,
                            "device": {"name": "a device"},
                        },
                        "rows": rows,
                    }
                )
            )
            made = script("results", "page", folder)
            self.assertEqual(made.returncode, 0, made.stderr)
            self.assertIn("<svg", (folder / "stiffness.svg").read_text())
            return (folder / "stiffness.md").read_text()

    def test_rows_are_algorithms_and_columns_stiffer_to_the_right(self):
        page = self.make(
            [
                row("light_tracing", 0.01, 2e-1, "off"),
                row("light_tracing", 1, 3e-2),
                row("bdpt", 1, 1e-5),
                row("bdpt", 0.01, 4e-3),
            ]
        )
        self.assertIn("| algorithm | 1 | 0.01 |", page)
        self.assertIn("| light tracing | 3.0e-02 | 2.0e-01 (off) |", page)
        self.assertIn("| BDPT | < 1e-04 | 4.0e-03 |", page)
        self.assertIn("batch of 2 samples per pixel", page)

    def test_cases_out_of_reach_are_left_out(self):
        self.assertNotIn(
            "out of reach",
            self.make(
                [
                    row("bdpt", 1, 1e-2),
                    {"group": "gloss", "algorithm": "x", "verdict": "out of reach"},
                ]
            ),
        )


if __name__ == "__main__":
    unittest.main()
