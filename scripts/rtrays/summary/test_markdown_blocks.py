# SPDX-License-Identifier: MIT
"""Tests the generated blocks of Markdown files."""

import pathlib
import re
import tempfile
import unittest

from rtrays.documents.experiments import claim_sections
from rtrays.testing import script


class Summary(unittest.TestCase):
    def test_blocks_are_checked_and_updated(self):
        with tempfile.TemporaryDirectory() as name:
            file = pathlib.Path(name) / "README.md"
            file.write_text("a\n<!-- generated: gains -->\nold\n<!-- end generated -->\nb\n")
            checked = script("summary", "--check", file)
            self.assertEqual(checked.returncode, 1)
            self.assertIn("--update", checked.stderr)
            self.assertEqual(script("summary", "--update", file).returncode, 0)
            self.assertEqual(script("summary", "--check", file).returncode, 0)
            text = file.read_text()
            self.assertTrue(text.startswith("a\n<!-- generated: gains -->\n| scene |"))
            self.assertTrue(text.endswith("<!-- end generated -->\nb\n"))
            printed = script("summary", "gains").stdout
            self.assertIn(printed, text)

    def test_unknown_and_open_blocks_are_errors(self):
        with tempfile.TemporaryDirectory() as name:
            file = pathlib.Path(name) / "README.md"
            for text in (
                "<!-- generated: nothing -->\n<!-- end generated -->\n",
                "<!-- generated: gains -->\n",
            ):
                file.write_text(text)
                self.assertEqual(script("summary", "--check", file).returncode, 2)

    def test_blocks_of_the_project_are_current(self):
        checked = script("summary", "--check")
        self.assertEqual(checked.returncode, 0, checked.stderr)

    def test_blocks_agree_with_the_documents(self):
        claims = script("summary", "claims").stdout
        count = sum(len(section["claims"]) for section in claim_sections())
        self.assertIn(f"Of {count} claims", claims)
        self.assertEqual(sum(map(int, re.findall(r"\| (\d+) \|$", claims, re.MULTILINE))), count)


if __name__ == "__main__":
    unittest.main()
