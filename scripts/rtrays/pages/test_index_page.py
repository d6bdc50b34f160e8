# SPDX-License-Identifier: MIT
"""Tests the overview, with and without runs of the thesis."""

import pathlib
import shutil
import unittest

from rtrays.testing import RunFolder


class Overview(RunFolder):
    def two_runs(self, *names):
        self.run_object()
        folders = [self.folder.parent / name for name in names]
        for folder in folders:
            shutil.copytree(self.folder, folder)
        shutil.rmtree(self.folder)
        done = self.results("report", *folders)
        self.assertEqual(done.returncode, 0, done.stderr)
        return pathlib.Path(done.stdout.strip())

    def test_runs_of_ones_own_are_not_chapter_4(self):
        index = self.two_runs("first", "second")
        text = index.read_text()
        self.assertIn("<title>RTRays: 2 experiments in ", text)
        self.assertNotIn("chapter 4", text)
        self.assertNotIn("not measured", text)
        self.assertFalse((index.parent / "claims").exists())
        self.assertEqual(text.count("<a class=card"), 2)
        self.assertIn('src="first/plots/reference.png"', text)
        self.assertIn(
            '<a href="../index.html">Overview</a>', (index.parent / "first/index.html").read_text()
        )

    def test_runs_of_the_thesis_have_verdicts_and_missing_charts_are_lines(self):
        index = self.two_runs("cornell_diffuse", "cornell_bumps")
        text = index.read_text()
        self.assertIn("<title>RTRays: chapter 4 of the thesis, reproduced", text)
        self.assertIn('<dt data-verdict="holds"><b>', text)
        self.assertIn('data-verdict="not measured"', text)
        for line in (
            "The gains of truncated BDPT need one of these runs",
            "needs the run bounces",
            "needs: bvh_build, ray_rates",
        ):
            self.assertIn(line, text)
        claims = (index.parent / "claims/index.html").read_text()
        self.assertIn('<a href="../cornell_diffuse/index.html">', claims)
        self.assertIn('data-verdict="holds"', claims)
        self.assertIn("](cornell_diffuse/report.md)", (index.parent / "index.md").read_text())

    def test_a_broken_neighbour_is_a_line(self):
        self.run_object()
        broken = self.folder.parent / "broken"
        broken.mkdir()
        (broken / "run.json").write_text("{")
        other = self.folder.parent / "other"
        shutil.copytree(self.folder, other)
        done = self.results("report", self.folder, other)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("not JSON", done.stderr)
        self.assertIn("Omitted: ", pathlib.Path(done.stdout.strip()).read_text())
        self.assertEqual(self.results("report", broken, other).returncode, 2)


if __name__ == "__main__":
    unittest.main()
