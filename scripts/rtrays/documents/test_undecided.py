# SPDX-License-Identifier: MIT
"""Tests how many more samples would decide what an interval leaves undecided."""

import unittest

from rtrays.documents.undecided import (
    advice,
    factor,
    factor_of_agreement,
    factor_of_all,
    factor_of_gain,
)


class Undecided(unittest.TestCase):
    def test_widths_fall_as_the_root_of_the_number_of_samples(self):
        figure = {"value": 1.0, "low": 0.6, "high": 1.2}
        self.assertAlmostEqual(factor(figure, 0.8), 4)
        self.assertAlmostEqual(factor(figure, 1.1), 4)
        self.assertEqual(factor(figure, 2), 1)
        self.assertAlmostEqual(factor_of_all(figure, (0.8, 1.05)), 16)
        self.assertAlmostEqual(factor_of_all(figure, (None, 1.1)), 4)

    def test_a_gain_is_decided_above_one_or_below_the_claim(self):
        self.assertAlmostEqual(factor_of_gain({"value": 1.5, "low": 0.5, "high": 2.5}, 2), 4)
        self.assertAlmostEqual(factor_of_gain({"value": 0.9, "low": 0.5, "high": 3.1}, 2), 4)

    def test_the_mean_is_decided_within_or_beyond_the_limit(self):
        difference = {"value": 0.0, "low": -0.003, "high": 0.003, "limit": 0.001}
        self.assertAlmostEqual(factor_of_agreement({"relative_difference": difference}), 9)

    def test_words(self):
        self.assertEqual(advice(4), "about 4 times as many samples would decide it")
        self.assertEqual(advice(1.25), "about 1.3 times as many samples would decide it")
        self.assertEqual(advice(123, "seeds"), "about 130 times as many seeds would decide it")
        self.assertIn("hardly", advice(float("inf")))


if __name__ == "__main__":
    unittest.main()
