# SPDX-License-Identifier: MIT
"""Tests pages: escaping, and numbers that stay on one line."""

import pathlib
import tempfile
import unittest

from rtrays.pages.page import Figure, Page, TableBlock
from rtrays.pages.rendering import prose
from rtrays.tables.cells import Interval, Link
from rtrays.tables.table import Table


class Prose(unittest.TestCase):
    def test_intervals_and_their_minus_signs_are_kept_on_one_line(self):
        self.assertEqual(
            prose("in -0.5 [-0.6, -0.4] %"), "in <span class=n>−0.5 [−0.6, −0.4] %</span>"
        )
        self.assertEqual(prose("8.7e-13"), "<span class=n>8.7e-13</span>")
        self.assertEqual(prose("2026-11-25T04:28:34Z"), "2026-11-25T04:28:34Z")

    def test_text_is_escaped_once(self):
        self.assertEqual(prose("a's <b> & c"), "a&#39;s &lt;b&gt; &amp; c")


class Templates(unittest.TestCase):
    def test_whatever_a_run_is_called_is_escaped(self):
        evil = "<script>alert(1)</script>"
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            table = Table(
                evil,
                [evil, "b"],
                [[evil, Interval("1 [0, 2]", [1, 0, 2])], [Link(evil, f"../{evil}", "x.md"), "2"]],
                [evil],
            )
            Page(
                folder,
                "page.md",
                evil,
                evil,
                [TableBlock(table), Figure("a.svg", evil)],
                evil,
                evil,
                provenance=[evil],
            ).write()
            text = (folder / "index.html").read_text()
        self.assertNotIn("<script>", text)
        self.assertIn(
            "&lt;script&gt;alert(1)&lt;/script&gt;", text.replace("<span class=n>1</span>", "1")
        )
        self.assertIn('<meta name=viewport content="width=device-width, initial-scale=1">', text)


if __name__ == "__main__":
    unittest.main()
