# SPDX-License-Identifier: MIT
"""Tests the page of gains over scenes on a made-up run."""

import json
import pathlib
import tempfile
import unittest

from matplotlib import pyplot

from rtrays.documents.run_document import Run
from rtrays.pages.scene_gains_page import (
    gains_figure,
    gains_finding,
    gains_table,
    scene_gains_page,
)
from rtrays.pages.test_sweep_page import curve
from rtrays.testing import legend_gap


def row(scene, mse):
    """Returns a row in which path tracing has an error of 1 in 1 s."""
    return {
        "scene": scene,
        "pixels": {"light_behind_delta": 0.0, "delta": 0.0, "other": 1.0},
        "curves": [curve("truncated_bdpt", mse, 2.0), curve("path_tracing", 1.0, 1.0)],
    }


class SceneGainsPage(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name) / "made_up"
        self.folder.mkdir()
        document = {
            "schema_version": 3,
            "kind": "scene_gains",
            "experiment": {
                "name": "made_up",
                "title": "Scenes",
                "thesis": "none",
                "claim": "It never loses.",
                "profile": "ci",
                "size": [4, 4],
                "spp": 2,
                "seeds": 8,
            },
            "context": {"commit": "abc", "dirty": False, "device": {"name": "pthread"}},
            "rows": [row("good", 0.25), row("bad", 1.0)],
        }
        (self.folder / "run.json").write_text(json.dumps(document))
        self.run_object = Run(self.folder)

    def test_the_least_gain_comes_first(self):
        self.assertEqual(
            gains_table(self.run_object).rows,
            [
                ["bad", "truncated BDPT (MIS)"]
                + [f"{x} [{x}, {x}]" for x in ("1.00", "0.25", "0.50")],
                ["good", "truncated BDPT (MIS)"]
                + [f"{x} [{x}, {x}]" for x in ("4.00", "1.00", "2.00")],
            ],
        )

    def test_the_legend_is_just_below_the_axes(self):
        for scenes in (2, 80):
            self.run_object.document["rows"] = [row(f"scene_{i}", 1.0) for i in range(scenes)]
            figure = gains_figure(self.run_object)
            self.assertTrue(0 <= legend_gap(figure) < 0.2)
            pyplot.close(figure)

    def test_the_page_states_the_range_and_the_losses(self):
        self.assertEqual(
            gains_finding(self.run_object),
            "In equal device time, pilots included, truncated BDPT (MIS) has between 0.50 [0.50,"
            " 0.50] (bad) and 2.00 [2.00, 2.00] (good) times the efficiency of path tracing (MIS)."
            " It is below 0.9 in 1 of 2 scenes, with the whole interval in 1.",
        )
        scene_gains_page(self.run_object).write()
        self.assertIn("It never loses.", (self.folder / "made_up.md").read_text())
        for name in ("gain.svg", "gain.png", "tables/gains.csv"):
            self.assertGreater((self.folder / name).stat().st_size, 0)


if __name__ == "__main__":
    unittest.main()
