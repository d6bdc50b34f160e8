# SPDX-License-Identifier: MIT
"""Tests the tables that say where the error is, and under which settings."""

import copy
import unittest

from rtrays.documents.error_parts import shares_of_error
from rtrays.tables.error_tables import gains_table, parts_table, settings_table
from rtrays.testing import RunFolder


class ErrorParts(RunFolder):
    def setUp(self):
        super().setUp()
        self.add_parts()

    def test_shares_are_those_without_the_noise_of_the_reference(self):
        # At 4 samples the MSE is 0.25, and 0.01 of it is noise in the rest.
        shares = shares_of_error(self.run_object(), self.document["curves"][0], 4)
        self.assertAlmostEqual(shares["light_behind_delta"], 0.03125 / 0.24)
        self.assertAlmostEqual(shares["delta"], 0.0625 / 0.24)
        self.assertAlmostEqual(shares["other"], 0.14625 / 0.24)
        self.assertAlmostEqual(sum(shares.values()), 1)

    def test_rows_by_hand(self):
        numbers = ["4", "0.24", "13.02", "26.04", "60.94", "0.125", "0.25"]
        self.assertEqual(
            parts_table(self.run_object()).rows,
            [
                ["(share of pixels)", "–", "–", "6.25", "25.00", "68.75", "–", "–"],
                ["path tracing (implicit)", *numbers],
                ["path tracing (MIS)", *numbers],
            ],
        )

    def test_a_class_without_pixels_has_no_column(self):
        pixels = self.document["first_hits"]["pixels"]
        pixels.update(light_behind_delta=0.0, other=0.75)
        self.assertEqual(len(parts_table(self.run_object()).columns), 7)

    def test_gain_in_one_class(self):
        for point in self.document["curves"][0]["points"]:
            for repetition in point["repetitions"]:
                repetition["mse_parts"]["delta"] *= 0.25
        table = gains_table(self.run_object())
        self.assertEqual(
            table.rows,
            [
                ["path tracing (implicit)", "1.00 [1.00, 1.00]", "1.00 [1.00, 1.00]"]
                + ["4.00 [4.00, 4.00]"]
                + ["1.00 [1.00, 1.00]"] * 3
            ],
        )

    def test_gains_name_path_tracing_with_the_same_sampler(self):
        sobol = {"settings": {"integrator.sampler": "sobol"}}
        self.document["curves"][0].update(sobol)
        curve = copy.deepcopy(self.document["curves"][1])
        curve.update(id="path_tracing.mis,sampler=sobol", **sobol)
        self.document["curves"].insert(0, curve)
        self.assertEqual(
            [row[:2] for row in gains_table(self.run_object()).rows],
            [
                ["path tracing (MIS, sampler = sobol)", "path tracing (MIS)"],
                ["path tracing (implicit)", "path tracing (MIS, sampler = sobol)"],
            ],
        )

    def test_an_error_below_the_noise_has_no_gain(self):
        self.document["first_hits"]["noise_mse"]["delta"] = 1.0
        row = gains_table(self.run_object()).rows[0]
        self.assertEqual(row[3], "–")

    def test_old_documents_have_no_rows(self):
        del self.document["first_hits"]
        run = self.run_object()
        self.assertEqual(parts_table(run).rows + gains_table(run).rows, [])


class Settings(RunFolder):
    def test_settings_of_all_curves_are_named(self):
        settings = {
            "integrator.sampler": "independent",
            "integrator.light_selection": "mixed",
            "integrator.beta": "2",
        }
        first, second = self.document["curves"]
        first["settings"], second["settings"] = settings, {**settings}
        second["settings"]["integrator.sampler"] = "sobol"
        rows = {row[0]: row[1:] for row in settings_table(self.run_object()).rows}
        self.assertEqual(
            rows["integrator.sampler"],
            ["independent", "independent; sobol: path tracing (MIS)"],
        )
        self.assertEqual(rows["integrator.light_selection"], ["uniform", "mixed"])
        # A setting that is newer than the document has its only value then.
        self.assertEqual(rows["integrator.roulette_start"], ["1", "1"])
        self.assertNotIn("integrator.sphere_sampling", rows)


if __name__ == "__main__":
    unittest.main()
