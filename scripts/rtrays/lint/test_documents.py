# SPDX-License-Identifier: MIT
"""Tests the anchors of headings and the citations of equations."""

import unittest

from rtrays.lint.documents import anchors, cited, row_offences


class Anchors(unittest.TestCase):
    def test_are_those_of_github(self):
        self.assertEqual(anchors("# One two\n\n## What's `new`?\n"), {"one-two", "whats-new"})


class Equations(unittest.TestCase):
    def test_are_cited_alone_and_in_lists(self):
        self.assertEqual(cited("// MIS (2)-(5), thesis (2.73)"), {2, 5})
        self.assertEqual(cited("MIS (11), (15), (19) and (20); thesis (3)"), {11, 15, 19, 20})

    def test_of_a_row_are_those_of_its_files(self):
        row = "| ({}) | `{}` | `mis/{}.h` | |"
        self.assertEqual(row_offences(row.format(13, "camera_path_weight", "truncated")), [])
        self.assertEqual(
            row_offences(row.format(13, "weight", "truncated")), ["not defined: weight"]
        )
        self.assertEqual(
            row_offences(row.format(99, "camera_path_weight", "truncated")),
            ["not cited: MIS (99)"],
        )
        self.assertEqual(
            row_offences(row.format(13, "f", "absent")),
            [
                "no such file: renderer/kernels/mis/absent.h",
                "not defined: f",
                "not cited: MIS (13)",
            ],
        )


if __name__ == "__main__":
    unittest.main()
