# SPDX-License-Identifier: MIT
"""Tests the figures of claims from runs of curves."""

import copy
import unittest

import numpy

from rtrays.claims.testing import Folders
from rtrays.documents.document import RunError
from rtrays.documents.run_document import Run
from rtrays.tables.efficiency_tables import edges_table
from rtrays.testing import interval, made_up_run


class CurveFigures(Folders):
    def truncated_run(self):
        """Path tracing, and truncated BDPT with a quarter of the MSE, three times the time, and 12
        more bytes."""
        document = made_up_run()
        truncated = copy.deepcopy(document["curves"][1])
        truncated.update(id="truncated_bdpt.mis", algorithm="truncated_bdpt")
        truncated["render_report"]["bytes_per_path"] += 12
        for point in truncated["points"]:
            for repetition in point["repetitions"]:
                # The reference's noise of 0.01 is no error of its own.
                repetition["mse"] = 0.01 + (repetition["mse"] - 0.01) / 4
                repetition["seconds_device"] *= 3
        document["curves"].append(truncated)
        return document

    def test_gains_and_costs(self):
        self.write("box", self.truncated_run())
        for of, expected in (("spp", 4), ("seconds", 4 / 3)):
            (figure,) = self.figures("gain", "box", of=of).values()
            self.assertAlmostEqual(figure["value"], expected)
            self.assertAlmostEqual(figure["low"], expected)
        (figure,) = self.figures("sample_cost", "box").values()
        self.assertAlmostEqual(figure["value"], 3)
        (more,) = self.figures("memory", "box", curve="truncated_bdpt.mis", form="more").values()
        (times,) = self.figures("memory", "box", curve="truncated_bdpt.mis", form="times").values()
        self.assertEqual((more["value"], times["value"]), (12, 124 / 112))
        with self.assertRaisesRegex(RunError, "no curve bdpt.mis"):
            self.figures("gain", "box", of="spp", curve="bdpt.mis")

    def test_errors_at_edges(self):
        folder = self.write("box", made_up_run())
        (folder / "images").mkdir()
        reference = numpy.ones((8, 8, 3), dtype=numpy.float32)
        reference[:, 4:] = 2
        ours = reference + 0.1
        ours[:, 3:5] += 0.1  # either side of the edge
        numpy.save(folder / "images/reference.npy", reference)
        numpy.save(folder / "images/ours.npy", ours)
        self.assertEqual(self.figures("edge_errors", "box"), {})
        edges_table(Run(folder))
        (figure,) = self.figures("edge_errors", "box").values()
        self.assertAlmostEqual(figure["value"], 4, places=4)
        numpy.save(folder / "images/reference.npy", numpy.ones((8, 8, 3)))
        self.assertEqual(edges_table(Run(folder)).rows, [])

    def test_convergence_control_takes_the_best_error(self):
        rows = [
            {
                "scene": scene,
                "algorithm": "path_tracing",
                "error": error,
                "seconds": interval(low, high),
            }
            for scene, error, low, high in (
                ("mirror_ring", 0.01, 0.45, 0.55),
                ("mirror_ring", 0.03, 0.2, 0.3),
                ("box", 0.03, 0.1, 0.1),
            )
        ]
        self.write("control", {"rows": rows})
        ((name, figure),) = self.figures("control_gain", "control", scene="mirror_ring").items()
        self.assertEqual(name, "path tracing, error 0.03")
        self.assertAlmostEqual(figure["value"], 4)
        self.assertAlmostEqual(figure["low"], 1 / 0.3)


if __name__ == "__main__":
    unittest.main()
