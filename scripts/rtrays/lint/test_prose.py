# SPDX-License-Identifier: MIT
"""Tests the rules of prose."""

import re
import unittest

from rtrays.lint.prose import PROSE_RULES, long_sentences


class Rules(unittest.TestCase):
    def offends(self, line):
        return any(re.search(pattern, line) for pattern, _ in PROSE_RULES)

    def test_constructions_to_avoid(self):
        for line in (
            "// The hierarchy is built anew.",
            "/// Of camera paths, the index.",
            "it goes on where it was",
            "'x' is no setting",
            "measured in turns",
            "kernels omit what a scene does not need: what it needs stays",
        ):
            self.assertTrue(self.offends(line), line)
        for line in (
            "// Rebuilds the hierarchy.",
            "/// Index of the path.",
            "the loop turns back",
            "// is none of the caller's concern",
        ):
            self.assertFalse(self.offends(line), line)

    def test_sentences(self):
        short, long = "word " * 20 + "end.", "word " * 40 + "end."
        self.assertEqual(list(long_sentences(f"{short} {short}\n\n{short}\n")), [])
        self.assertEqual([line for line, _ in long_sentences(f"{short}\n\n{long}\n")], [3])
        self.assertEqual(list(long_sentences(f"```\n{long}\n```\n\n| {long} |\n")), [])


if __name__ == "__main__":
    unittest.main()
