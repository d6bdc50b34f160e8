# SPDX-License-Identifier: MIT
"""Tests the lines that drivers print, and the requests that they answer."""

import contextlib
import io
import json
import pathlib
import unittest
import unittest.mock

from rtrays.peers.driver import parser_of, render_runs, serve


def lines_of(function, *arguments):
    """Returns the documents that a function prints, one a line."""
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        function(*arguments)
    return [json.loads(line) for line in printed.getvalue().splitlines()]


class Driver(unittest.TestCase):
    def runs(self, *arguments):
        options = parser_of("driver", "").parse_args(["scene.xml", "/out/image.exr", *arguments])
        return lines_of(render_runs, options, 4, "engine", lambda seed, output: (0.5, [seed] * 3))

    def test_every_seed_has_a_file_and_a_line(self):
        lines = self.runs("--seed", "7", "--runs", "2")
        self.assertEqual([line["file"] for line in lines], ["/out/image.7.exr", "/out/image.8.exr"])
        self.assertEqual([line["mean"] for line in lines], [[7] * 3, [8] * 3])
        self.assertTrue(all(line["engine"] == "engine" and line["spp"] == 4 for line in lines))

    def test_a_single_image_keeps_its_name(self):
        self.assertEqual([line["file"] for line in self.runs()], ["/out/image.exr"])

    def test_requests_are_answered_in_order(self):
        asked, written = [], []
        requests = "2 16 1 5\n3 32 2 0 /out/an image.exr\n"
        with unittest.mock.patch("sys.stdin", io.StringIO(requests)):
            lines = lines_of(
                serve, "engine", lambda *request: asked.append(request), written.append
            )
        self.assertEqual(asked, [(2, 16, 1, 5), (3, 32, 2, 0)])
        self.assertEqual(written, [pathlib.Path("/out/an image.exr")])
        self.assertEqual(lines[0], {"engine": "engine"})
        self.assertEqual([set(line) for line in lines[1:]], [{"seconds", "processor_seconds"}] * 2)


if __name__ == "__main__":
    unittest.main()
