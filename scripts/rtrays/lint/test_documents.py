# SPDX-License-Identifier: MIT
"""Tests the anchors of headings."""

import unittest

from rtrays.lint.documents import anchors


class Anchors(unittest.TestCase):
    def test_are_those_of_github(self):
        self.assertEqual(anchors("# One two\n\n## What's `new`?\n"), {"one-two", "whats-new"})


if __name__ == "__main__":
    unittest.main()
