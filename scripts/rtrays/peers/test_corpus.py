# SPDX-License-Identifier: MIT
"""Tests the table of Mitsuba files."""

import unittest

from rtrays.documents.document import read_json
from rtrays.peers.corpus import (FILES, PAGE, STORED, agrees, first_error, stored_table, uses, what,
                                 with_table)


class Corpus(unittest.TestCase):
    def test_the_page_has_the_stored_table(self):
        page = PAGE.read_text(encoding="utf-8")
        self.assertEqual(with_table(page, stored_table()), page)

    def test_every_file_has_a_row_that_agrees(self):
        rows = read_json(STORED)["files"]
        self.assertEqual([row["file"] for row in rows], sorted(f.name for f in FILES.glob("*.xml")))
        for row in rows:
            text = (FILES / row["file"]).read_text(encoding="utf-8")
            self.assertEqual(row["uses"], uses(text), row["file"])
            self.assertTrue(agrees(row, len(rows)), row["file"])

    def test_rows_describe_their_files(self):
        text = (
            "<!-- licence -->\n<!-- A pane. -->\n<scene><bsdf type='x'/>"
            '<bsdf type="thindielectric"/><shape type="sphere"/></scene>'
        )
        self.assertEqual(what(text), "A pane.")
        self.assertEqual(uses(text), ["thindielectric"])

    def test_errors_keep_the_names_of_missing_files(self):
        lines = ["notice: grey", "rtrays-render: /a/b/s.xml: 2 errors",
                 "/a/b/s.xml:7: <shape type=\"ply\">: cannot find 'x/y.ply'; searched: '/a/b'"]
        self.assertEqual(first_error(lines, "/a/b"),
                         "s.xml:7: <shape type=\"ply\">: cannot find 'x/y.ply'")


if __name__ == "__main__":
    unittest.main()
