# SPDX-License-Identifier: MIT
"""Tests the page of a sweep on a made-up run."""

import json
import pathlib
import tempfile
import unittest

from rtrays.documents.run_document import Run
from rtrays.documents.sweep import position, sweeps
from rtrays.pages.sweep_page import sweep_finding, sweep_page, sweep_table


def curve(name, mse, seconds):
    """Returns a curve of eight seeds with the same error; half of it is in mirrors."""
    parts = {"light_behind_delta": mse / 4, "delta": mse / 4, "other": mse / 2}
    repetition = {
        "rays": round(100 * seconds**2),  # another ratio than that of the times
        "seconds_device": seconds,
        "seconds_wall": seconds,
        "mse": mse,
    }
    return {
        "id": f"{name}.mis",
        "algorithm": name,
        "settings": {},
        "repetitions": [
            {**repetition, "seed": seed, "mse_parts": dict(parts)} for seed in range(1, 9)
        ],
    }


def row(sweep, x, mse):
    """Returns a row in which path tracing has an error of 1 in 1 s."""
    return {
        "sweep": sweep,
        "value": x,
        "pixels": {"light_behind_delta": 0.05, "delta": x / 10, "other": 0.95 - x / 10},
        "curves": [curve("truncated_bdpt", mse, 2.0), curve("path_tracing", 1.0, 1.0)],
    }


def made_up_sweep():
    """Returns the document of two sweeps."""
    described = [
        {
            "name": name,
            "title": title,
            "scene": "scene.json",
            "axis": {"shows": shows, "label": f"{name}, m"},
            "properties": {"lamp.radius": "x"},
        }
        for name, title, shows in (
            ("lamps", "ring, lamps", "value"),
            ("share", "ring, view", "delta_pixels"),
        )
    ]
    return {
        "schema_version": 3,
        "kind": "sweep",
        "experiment": {
            "name": "made_up",
            "title": "A sweep",
            "thesis": "none",
            "claim": "It gains.",
            "profile": "ci",
            "sweeps": described,
            "size": [4, 4],
            "spp": 2,
            "seeds": 8,
        },
        "context": {"commit": "abc", "dirty": False, "device": {"name": "pthread"}},
        "rows": [row("lamps", 1, 0.25), row("lamps", 2, 1.0), row("share", 1, 0.5)],
    }


class SweepPage(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name) / "made_up"
        self.folder.mkdir()
        self.document = made_up_sweep()

    def tearDown(self):
        self.temporary.cleanup()

    def run_object(self):
        (self.folder / "run.json").write_text(json.dumps(self.document))
        return Run(self.folder)

    def test_gains_by_hand(self):
        run = self.run_object()
        table = sweep_table(run, *sweeps(run)[0])
        same = "[{0}, {0}]"
        self.assertEqual(
            table.rows,
            [
                [x, "truncated BDPT (MIS)", pixels, "5.00", "25.0", "25.0"]
                + [f"{gain} {same.format(gain)}" for gain in gains]
                for x, pixels, gains in (
                    ("1", "15.00", ("4.00", "2.00", "4.00")),
                    ("2", "25.00", ("1.00", "0.50", "1.00")),
                )
            ],
        )

    def test_pixels_without_an_error_have_no_gain(self):
        for repetition in self.document["rows"][0]["curves"][0]["repetitions"]:
            repetition["mse_parts"]["other"] = 0.0
        run = self.run_object()
        self.assertEqual(sweep_table(run, *sweeps(run)[0]).rows[0][-1], "–")

    def test_rows_stand_at_their_value_or_share(self):
        (lamps, rows), (share, others) = sweeps(self.run_object())
        self.assertEqual([position(lamps, row) for row in rows], [1, 2])
        self.assertAlmostEqual(position(share, others[0]), 15)

    def test_the_page_states_the_range_of_gains(self):
        run = self.run_object()
        self.assertEqual(
            sweep_finding(run),
            "In equal device time the gain of truncated BDPT (MIS) over path tracing (MIS) is"
            " between 0.50 [0.50, 0.50] (ring, lamps, x = 2) and 2.00 [2.00, 2.00] (ring, lamps,"
            " x = 1). In pixels without mirrors and glass, in equal samples, it is between 1.00"
            " [1.00, 1.00] (ring, lamps, x = 2) and 4.00 [4.00, 4.00] (ring, lamps, x = 1).",
        )
        sweep_page(run).write()
        page = (self.folder / "made_up.md").read_text()
        self.assertIn("## Ring, view", page)
        for name in ("gain.svg", "gain.png", "tables/lamps.csv"):
            self.assertGreater((self.folder / name).stat().st_size, 0)


if __name__ == "__main__":
    unittest.main()
