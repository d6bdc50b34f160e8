# SPDX-License-Identifier: MIT
"""Tests the commands that scripts/shards prints."""

import pathlib
import shlex
import subprocess
import tempfile
import unittest

from rtrays.testing import script


class Shards(unittest.TestCase):
    def lines(self, *arguments):
        result = script("shards", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout.splitlines()

    def test_ranges_cover_all_samples_once(self):
        for samples, shards in ((10, 3), (7, 7), (1000, 1), (200000, 64)):
            lines = self.lines("scene.json", samples, shards, "-o", "out.exr", "--seed", 3)
            self.assertEqual(len(lines), shards + 1)
            ranges = [shlex.split(line) for line in lines[:-1]]
            ranges = [words[words.index("--samples") + 1].split(":") for words in ranges]
            bounds = [int(bound) for pair in ranges for bound in pair]
            self.assertEqual([bounds[0], bounds[-1]], [0, samples])
            self.assertEqual(bounds[1:-1:2], bounds[2::2])
            self.assertTrue(all(int(begin) < int(end) for begin, end in ranges))

    def test_options_go_to_the_parts_or_to_the_merge(self):
        first, _, merge = map(shlex.split, self.lines(
            "--reference", "a scene.json", 8, 2, "--seed", 3, "-o", "my out.exr", "--manifest", "m",
            "--max-depth", 2))
        self.assertEqual(first[:5], ["mkdir", "-p", "my out.exr.shards", "&&",
                                     "build/bin/rtrays-reference"])
        self.assertEqual(first[5], "a scene.json")
        self.assertEqual(first[-4:], ["--seed", "3", "--max-depth", "2"])
        self.assertNotIn("m", first)
        self.assertEqual(merge, ["build/bin/rtrays-reference", "merge", "my out.exr.shards/0.film",
                                 "my out.exr.shards/1.film", "-o", "my out.exr", "--manifest", "m"])

    def test_lines_run_in_any_order(self):
        """A program that writes its words stands for the renderer."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            program = folder / "rtrays-render"
            program.write_text('#!/bin/sh\necho "$*" >> "$(dirname "$0")/log"\n')
            program.chmod(0o755)
            lines = self.lines("--programs", folder, "scene.json", 4, 2, "-o", folder / "o.exr")
            for line in reversed(lines[:-1]):
                subprocess.run(["sh", "-c", line], check=True)
            subprocess.run(["sh", "-c", lines[-1]], check=True)
            log = (folder / "log").read_text().splitlines()
            self.assertTrue((folder / "o.exr.shards").is_dir())
            self.assertIn("--samples 2:4", log[0])
            self.assertIn("--samples 0:2", log[1])
            self.assertTrue(log[2].startswith("merge "))

    def test_refuses_what_the_parts_decide(self):
        for arguments, text in (
            (("s.json", 4, 2), "add -o"),
            (("s.json", 4, 2, "-o", "a.exr", "--spp", 3), "--spp"),
            (("s.json", 4, 5, "-o", "a.exr"), "at least one sample"),
            (("s.json", 4, 2, "-o"), "a value is missing"),
        ):
            result = script("shards", *arguments)
            self.assertEqual(result.returncode, 2)
            self.assertIn(text, result.stderr)
            self.assertEqual(result.stdout, "")


if __name__ == "__main__":
    unittest.main()
