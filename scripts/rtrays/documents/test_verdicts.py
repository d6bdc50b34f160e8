# SPDX-License-Identifier: MIT
"""Tests the verdicts on slopes, gains and agreements."""

import unittest

from rtrays.documents.verdicts import agreement_verdict, gain_verdict, slope_verdict
from rtrays.testing import made_up_curve


class Verdicts(unittest.TestCase):
    def test_verdicts(self):
        self.assertEqual(slope_verdict({"low": -0.52, "high": -0.48}, -0.5, 0.03), "holds")
        self.assertEqual(slope_verdict({"low": -0.54, "high": -0.48}, -0.5, 0.03), "undecided")
        self.assertEqual(
            slope_verdict({"low": -0.40, "high": -0.30}, -0.5, 0.03), "does not hold here"
        )
        for low, high, verdict in (
            (1.9, 2.1, "holds"),
            (2.5, 3, "holds"),
            (1.2, 1.9, "holds partly"),
            (0.8, 1.5, "does not hold here"),
            (0.8, 2.5, "undecided"),
        ):
            self.assertEqual(gain_verdict({"low": low, "high": high}, 2), verdict)
        agreement = made_up_curve("mis")["agreement"]
        self.assertEqual(agreement_verdict(agreement), "holds")
        agreement["equivalence"] = "undecided"
        self.assertEqual(agreement_verdict(agreement), "undecided")
        agreement["agrees"] = False
        self.assertEqual(agreement_verdict(agreement), "does not hold here")


if __name__ == "__main__":
    unittest.main()
