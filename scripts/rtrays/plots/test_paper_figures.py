# SPDX-License-Identifier: MIT
"""Tests the figures and tables for papers."""

import csv
import pathlib
import unittest

import numpy

from rtrays.documents.document import RunError
from rtrays.metrics.flip import flip_map, hdr_flip_map
from rtrays.plots.image_row import image_near, image_row
from rtrays.plots.paper_plot import note_of, paper_figure
from rtrays.tables.points import points_csv
from rtrays.testing import RunFolder, legend_gap


class PaperFigures(RunFolder):
    def test_a_curve_is_drawn_over_its_own_seconds(self):
        run = self.run_object()
        figure = paper_figure(run, "relmse", "wall", ["path tracing (MIS)"])
        (line,) = figure.axes[0].lines
        numpy.testing.assert_allclose(line.get_xdata(), [0.2, 0.4, 0.8])  # 8 spp are noise
        numpy.testing.assert_allclose(line.get_ydata(), [1, 1 / 2, 1 / 4])
        self.assertEqual(figure.axes[0].get_xlabel(), "wall time, s")
        self.assertEqual(len(paper_figure(run, "rmse", "spp").axes[0].lines), 2)
        with self.assertRaisesRegex(RunError, "'bdpt'; curves are: path tracing .implicit.; "):
            paper_figure(run, "rmse", "spp", ["bdpt"])

    def test_the_command_counts_the_points_that_are_left_out(self):
        self.run_object()
        done = self.results("figure", self.folder, "-o", self.folder / "plot.pdf", "--curve",
                            "path_tracing.mis")
        self.assertIn("results: 1 point of 1 curve left out:", done.stderr)

    def test_images_are_those_nearest_in_time(self):
        curve = self.document["curves"][0]
        curve["early_images"] = [
            {"spp": spp, "image": f"images/{name}.exr"} for spp, name in ((1, "ours"), (4, "early"))
        ]
        run = self.run_object()
        for time, spp in ((0.01, 1), (0.19, 1), (0.21, 4), (9, 4), (None, 4)):
            found, picture = image_near(run, run.curves[0], time)
            self.assertEqual((found["spp"], found["seconds"]), (spp, 0.1 * spp))
            self.assertEqual(found["mse"], 1 / spp)
            file = self.folder / f"images/{'ours' if spp == 1 else 'early'}.npy"
            numpy.testing.assert_array_equal(picture, numpy.load(file))

    def test_the_row_shows_errors_with_their_scale(self):
        run = self.run_object()
        figure = image_row(run, None, ["path_tracing.mis"], [(1, 0, 2, 3)])
        reference, early = (
            numpy.load(self.folder / f"images/{name}.npy").astype(float)
            for name in ("reference", "early")
        )
        axes = [each for each in figure.axes if each.images]
        numpy.testing.assert_allclose(
            axes[-1].images[0].get_array(), numpy.abs(early - reference).mean(axis=2)
        )
        self.assertEqual(axes[2].images[0].get_array().shape, (3, 2, 3))  # the inset
        rmse = 2**-0.5 * 1.01  # of the first seed at 2 spp
        self.assertTrue(any(f"RMSE {rmse:.3g}" in each.get_xlabel() for each in axes))
        self.assertEqual(figure.axes[-1].get_ylabel(), "|difference|")
        with self.assertRaisesRegex(RunError, "not inside the image of 4x4"):
            image_row(run, None, [], [(3, 0, 2, 1)])

    def test_the_row_shows_flip_with_its_mean(self):
        run = self.run_object()
        early, reference = (run.image(f"images/{name}.exr") for name in ("early", "reference"))
        for metric, name, measure in (
            ("flip", "FLIP", flip_map),
            ("hdr_flip", "HDR-FLIP", hdr_flip_map),
        ):
            figure = image_row(run, ids=["path_tracing.mis"], metric=metric)
            axes = [each for each in figure.axes if each.images]
            errors, shown = measure(early, reference), axes[-1].images[0]
            numpy.testing.assert_array_equal(shown.get_array(), errors)
            self.assertEqual((shown.get_cmap().name, *shown.get_clim()), ("magma", 0, 1))
            self.assertEqual(figure.axes[-1].get_ylabel(), name)
            self.assertTrue(axes[1].get_xlabel().endswith(f"\n{name} {errors.mean():.3g}"))
        with self.assertRaisesRegex(RunError, "unknown metric 'rmse'; metrics are: mae, flip, hdr"):
            image_row(run, metric="rmse")

    def test_flip_is_that_of_the_kept_images(self):
        run = self.run_object()
        figure = paper_figure(run, "flip", "wall", ["path_tracing.mis"])
        (line,) = figure.axes[0].lines
        early, reference = (run.image(f"images/{name}.exr") for name in ("early", "reference"))
        numpy.testing.assert_allclose(line.get_xdata(), [0.4])  # at 2 spp
        numpy.testing.assert_allclose(line.get_ydata(), [flip_map(early, reference).mean()])
        self.assertEqual(figure.axes[0].get_ylabel(), "FLIP, first seed")
        self.assertEqual(note_of(run, "flip"), "")

        self.document["curves"][0]["early_images"][0]["spp"] = 8  # noise of the reference
        run = self.run_object()
        self.assertRegex(note_of(run, "flip"), "^1 point of 1 curve left out:")
        with self.assertRaisesRegex(RunError, "path_tracing.implicit keeps no image above the"):
            paper_figure(run, "flip", "spp")

        self.document["curves"][0]["early_images"] = []
        with self.assertRaisesRegex(RunError, "path_tracing.implicit has no images of single"):
            paper_figure(self.run_object(), "flip", "spp")

    def test_flip_needs_finite_images(self):
        run, file = self.run_object(), self.folder / "images/early.npy"
        broken = numpy.load(file)
        broken[3, 1, 2] = numpy.nan
        numpy.save(file, broken)
        for draw in (paper_figure, lambda *_: image_row(run)):
            with self.assertRaisesRegex(RunError, r"early.exr: pixel \(1, 3\) is not finite"):
                draw(run, "flip", "spp")

    def test_a_run_without_images_says_what_is_missing(self):
        run = self.run_object()
        (self.folder / "images/reference.npy").unlink()
        for draw in (paper_figure, lambda *_: image_row(run)):
            with self.assertRaisesRegex(RunError, "box: has no images, from which this figure"):
                draw(run, "flip", "spp")
        paper_figure(run, "rmse", "spp")

    def test_many_curves_can_be_told_apart(self):
        first = self.document["curves"][0]
        self.document["curves"] = [{**first, "label": f"curve {i}"} for i in range(10)]
        run = self.run_object()
        figure = paper_figure(run, "rmse", "spp")
        lines = figure.axes[0].lines
        self.assertEqual(len({(line.get_color(), line.get_marker()) for line in lines}), 10)
        self.assertTrue(0 <= legend_gap(figure) < 0.2)
        row = image_row(run)
        row.canvas.draw()
        titles = [each.title.get_window_extent() for each in row.axes[:11]]
        for left, right in zip(titles, titles[1:]):
            self.assertLess(left.x1, right.x0)

    def test_another_renderer_has_no_device_time(self):
        self.document["curves"][0]["engine"] = "Cycles 9"
        run = self.run_object()
        with self.assertRaisesRegex(RunError, "path_tracing.implicit has no device time"):
            paper_figure(run, "rmse", "device")
        rows = list(csv.DictReader(points_csv([run]).splitlines()))
        clocks = {
            name: {row["quantity"] for row in rows if row["curve"] == f"path_tracing.{name}"}
            for name in ("implicit", "mis")
        }
        self.assertEqual(clocks["mis"] - clocks["implicit"], {"seconds_device"})

    def test_commands(self):
        self.run_object()
        for arguments in (
            ("figure", self.folder, "-o", self.folder / "paper/plot.pdf"),
            ("images", self.folder, "-o", self.folder / "paper/row.png", "--inset", "0,0,2x2",
             "--metric", "flip"),
            ("table", self.folder, "errors", "-o", self.folder / "paper/t.tex", "--columns", "L2"),
            ("points", self.folder, self.folder, "-o", self.folder / "paper/points.csv"),
        ):
            done = self.results(*arguments)
            self.assertEqual(done.returncode, 0, done.stderr)
            written = pathlib.Path(done.stdout.strip())
            self.assertGreater(written.stat().st_size, 50)
        self.assertIn(r"\toprule", (self.folder / "paper/t.tex").read_text())
        with open(self.folder / "paper/points.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        (row,) = (
            row
            for row in rows[: len(rows) // 2]
            if (row["curve"], row["spp"], row["quantity"]) == ("path_tracing.mis", "4", "mse")
        )
        self.assertEqual([float(row[key]) for key in ("value", "low", "high")], [0.25] * 3)
        self.assertEqual(self.results("images", self.folder, "-o", "x.bmp").returncode, 2)
        self.assertEqual(self.results("table", self.folder, "slope", "-o", "x.tex").returncode, 2)


if __name__ == "__main__":
    unittest.main()
