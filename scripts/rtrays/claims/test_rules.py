# SPDX-License-Identifier: MIT
"""Tests the rules of claims."""

import unittest

from rtrays.claims.rules import combined, figure_verdict
from rtrays.testing import interval


class Rules(unittest.TestCase):
    def test_bounds(self):
        rule = {"within": [2, 3], "partly": [1, None]}
        for low, high, expected in (
            (2.1, 2.9, "holds"),
            (1.5, 2.5, "holds partly"),
            (3.5, 4, "holds partly"),
            (0.5, 0.9, "does not hold here"),
            (0.9, 1.5, "does not hold here"),
            (0.9, 2.5, "undecided"),
        ):
            self.assertEqual(figure_verdict(interval(low, high), rule), expected, (low, high))
        self.assertEqual(figure_verdict(interval(-5, 1), {"within": [None, 1.1]}), "holds")
        self.assertEqual(figure_verdict(interval(1, 1.2), {"within": [None, 1.1]}), "undecided")

    def test_gains(self):
        for low, high, expected in (
            (1.9, 2.1, "holds"),
            (1.2, 1.9, "holds partly"),
            (0.8, 0.9, "does not hold here"),
            (0.8, 2.5, "undecided"),
        ):
            self.assertEqual(
                figure_verdict(interval(low, high), {"gain": 2}), expected, (low, high)
            )

    def test_several_figures(self):
        for verdicts, expected in (
            (["holds", "holds"], "holds"),
            (["holds", "does not hold here"], "holds partly"),
            (["holds", "undecided"], "undecided"),
            (["holds partly", "undecided"], "holds partly"),
            (["does not hold here", "undecided"], "does not hold here"),
        ):
            self.assertEqual(combined(verdicts), expected, verdicts)


if __name__ == "__main__":
    unittest.main()
