# SPDX-License-Identifier: MIT
"""Tests the table of ranks, from made-up renders."""

import unittest

from rtrays.renders.scaling import row


def job(seconds, *ranges):
    return {"seconds": seconds, "sums": 2, "summed_bytes": 3 << 20,
            "ranks": [{"ranges": number} for number in ranges]}


class Scaling(unittest.TestCase):
    def test_row(self):
        jobs = [job(5.0, 3, 4), job(4.0, 5, 6), job(9.0, 1, 1)]
        self.assertEqual(row(2, jobs, 8.0, 4), ["2", "5.00", "1.60", "80 %", "7", "2", "3.0"])

    def test_more_ranks_than_cores(self):
        self.assertEqual(row(8, [job(2.0, 1)], 4.0, 2)[3], "100 %")


if __name__ == "__main__":
    unittest.main()
