# SPDX-License-Identifier: MIT
"""Tests the report of a run of curves, with and without its images."""

import pathlib
import shutil
import unittest

from rtrays.testing import RunFolder


class CurvePage(RunFolder):
    def test_report_is_self_contained_and_reproducible(self):
        self.run_object()
        done = self.results("report", self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        page = pathlib.Path(done.stdout.strip())
        text = page.read_text()
        self.assertNotIn("http", text)
        self.assertIn("A box &amp; more", text)
        self.assertNotIn("&amp;amp;", text)
        for link in (
            "plots/rmse_spp.svg",
            "plots/rmse_spp.png",
            "plots/images_path_tracing.mis.png",
            "tables/errors.tex",
        ):
            self.assertIn(link, text)
            self.assertTrue((self.folder / link).stat().st_size > 0)
        self.assertIn("commit abc", (self.folder / "report.md").read_text())
        first = (self.folder / "plots/rmse_spp.svg").read_bytes()
        self.results("plot", self.folder)
        self.assertEqual((self.folder / "plots/rmse_spp.svg").read_bytes(), first)

    def test_passes_and_gains_have_figures_and_rows(self):
        curve = self.document["curves"][0]
        curve.update(
            id="truncated_bdpt.mis", algorithm="truncated_bdpt", layers=["camera", "light"]
        )
        self.document["experiment"]["expected_gain"] = {
            "algorithm": "truncated_bdpt",
            "samples": 4,
            "time": 2,
        }
        for layer in curve["layers"]:
            shutil.copy(self.folder / "images/ours.npy", self.folder / f"images/ours.{layer}.npy")
        self.run_object()
        done = self.results("report", self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(
            (self.folder / "plots/contributions_truncated_bdpt.mis.png").stat().st_size > 0
        )
        self.assertTrue((self.folder / "plots/early.png").stat().st_size > 0)
        page = (self.folder / "report.md").read_text()
        self.assertIn(
            (
                "| truncated BDPT (MIS) | gain over path tracing (MIS) in equal samples | 4 times |"
                " 1.00 [1.00, 1.00] | does not hold here |"
            ),
            page,
        )
        self.assertIn(
            (
                "| truncated BDPT (MIS) | gain over path tracing (MIS) in equal device time | 2"
                " times | 1.00 [1.00, 1.00] | does not hold here |"
            ),
            page,
        )
        self.assertIn(
            (
                "**In equal device time truncated BDPT (MIS) has 1.00 [1.00, 1.00] times the"
                " efficiency of path tracing (MIS); the thesis claims 2.**"
            ),
            page,
        )
        self.assertIn("takes 1.00 times as much device time; its light pass is 25 % of that", page)

    def test_a_run_without_images_keeps_its_pictures(self):
        self.run_object()
        self.assertEqual(self.results("report", self.folder).returncode, 0)
        pages = {
            name: (self.folder / name).read_bytes()
            for name in ("report.md", "plots/early.png", "edges.json")
        }
        clone = self.folder.parent / "clone"
        shutil.copytree(
            self.folder, clone, ignore=shutil.ignore_patterns("images", "*.html", "*.js")
        )
        (clone / "plots/images_path_tracing.mis.png").unlink()
        done = self.results("report", clone)
        self.assertEqual(done.returncode, 0, done.stderr)
        page = (clone / "index.html").read_text()
        self.assertIn("plots/early.png", page)
        self.assertNotIn("images_path_tracing.mis.png", page)
        self.assertNotIn("images.js", page)
        self.assertIn("rtrays-experiment run experiments/box.json --profile ci --out DIR", page)
        for name in ("plots/early.png", "edges.json"):
            self.assertEqual((clone / name).read_bytes(), pages[name], name)

    def test_the_page_says_where_the_error_is(self):
        self.add_parts()
        self.run_object()
        done = self.results("report", self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        page = (self.folder / "report.md").read_text()
        for text in (
            "## Where the error is, by what the camera sees first",
            "| (share of pixels) | – | – | 6.25 | 25.00 | 68.75 | – | – |",
            "plots/error_parts.svg",
            "plots/first_hits.png",
        ):
            self.assertIn(text, page)
        self.assertNotIn("This run is older", page)
        for name in ("error_parts.svg", "first_hits.png"):
            self.assertGreater((self.folder / "plots" / name).stat().st_size, 0)

    def test_a_document_without_parts_says_so(self):
        self.run_object()
        self.assertEqual(self.results("report", self.folder).returncode, 0)
        page = (self.folder / "report.md").read_text()
        self.assertIn("This run is older than the division of the error", page)
        self.assertNotIn("Where the error is", page)

    def test_images_that_are_not_exported_are_an_error(self):
        self.run_object()
        (self.folder / "images/reference.npy").rename(self.folder / "images/reference.exr")
        done = self.results("report", self.folder)
        self.assertEqual(done.returncode, 2)
        self.assertIn("rtrays-experiment report", done.stderr)

    def test_missing_image_is_one_clear_error(self):
        self.run_object()
        (self.folder / "images/ours.npy").unlink()
        done = self.results("report", self.folder)
        self.assertEqual(done.returncode, 2)
        self.assertIn("ours.npy", done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1)


if __name__ == "__main__":
    unittest.main()
