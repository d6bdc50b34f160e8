# SPDX-License-Identifier: MIT
"""Tests the tables of several renderers on a made-up run."""

import json
import pathlib
import tempfile
import unittest

from rtrays.documents.run_document import Run
from rtrays.tables.renderer_tables import best_table, renderers, speeds_table


def contestant(name, mse, seconds, **more):
    """Returns a contestant whose turns have the same error and duration."""
    turn = {"mse": mse, "seconds_processor": seconds, "seconds_wall": seconds / 2}
    return {
        "name": name,
        "is_ours": name.startswith("path"),
        "Msamples_s": {"value": 1, "low": 1, "high": 1},
        "turns": [dict(turn) for _ in range(6)],
        **more,
    }


class RendererTables(unittest.TestCase):
    def run_of(self, *contestants):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        folder = pathlib.Path(temporary.name)
        row = {
            "scene": "cornell_box",
            "absent_peers": ["Blender's Cycles"],
            "foreign_load": 0.25,
            "contestants": contestants,
        }
        document = {
            "schema_version": 3,
            "kind": "renderers",
            "experiment": {"name": "made_up", "settings": {"size": [4, 4], "spp": 2}},
            "context": {"device": {"name": "pthread", "type": "cpu"}},
            "rows": [row],
        }
        (folder / "run.json").write_text(json.dumps(document))
        return Run(folder)

    def test_the_best_of_both_sides_are_compared_in_equal_time(self):
        run = self.run_of(
            contestant("path_tracing.mis", 4.0, 1.0),
            contestant("path_tracing.mis,sampler=sobol", 1.0, 2.0),
            contestant("Mitsuba, roulette from event 1", 2.0, 3.0),
            contestant("Mitsuba, roulette from event 5", 1.0, 5.0),
        )
        (row,) = best_table(run).rows
        self.assertEqual(row[2:], ["Mitsuba, roulette from event 5", "2.50 [2.50, 2.50]"])
        self.assertEqual(speeds_table(run).rows, [["cornell box", "3.00", "5.00"]])
        finding, _ = renderers(run)
        self.assertIn("on 1 of 1 scenes, and more on 0", finding)

    def test_a_run_without_other_renderers_says_so(self):
        run = self.run_of(contestant("path_tracing.mis", 4.0, 1.0))
        finding, tables = renderers(run)
        self.assertEqual(finding, "No other renderer is installed.")
        self.assertEqual(len(tables), 1)


if __name__ == "__main__":
    unittest.main()
