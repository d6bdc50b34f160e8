# SPDX-License-Identifier: MIT
"""Tests gains of rows."""

import unittest

from rtrays.documents.sweep import gain


def curve(*repetitions):
    return {"repetitions": [{"mse": mse, "seconds_device": time} for mse, time in repetitions]}


class Gains(unittest.TestCase):
    def test_a_seed_whose_pilot_chose_badly_counts(self):
        """A tenth of the error in 20 times the time costs as much as twice the error."""
        chosen, base = curve((1.0, 1.0), (0.1, 20.0)), curve((1.0, 1.0), (1.0, 1.0))
        row = {"curves": [chosen, base]}
        self.assertAlmostEqual(gain(row, chosen, "time")["value"], 1 / 1.5)
        self.assertAlmostEqual(gain(row, chosen, "samples")["value"], 1 / 0.55)


if __name__ == "__main__":
    unittest.main()
