# SPDX-License-Identifier: MIT
"""Tests the plots of curves."""

import copy
import unittest

from rtrays.documents.curves import left_out
from rtrays.plots.curve_plots import curves_figure, write_curves
from rtrays.testing import RunFolder


class CurvePlots(RunFolder):
    def test_long_names_leave_the_axes_their_size(self):
        curve = copy.deepcopy(self.document["curves"][0])
        curve["id"] = "truncated_bdpt.mis,light_selection=uniform,sphere_sampling=area"
        for curves in ([], [curve]):
            self.document["curves"][:0] = curves
            figure = curves_figure(self.run_object(), "spp")
            figure.canvas.draw()
            width, height = figure.axes[0].get_window_extent().size / figure.dpi
            self.assertGreater(width, 5)
            self.assertGreater(height, 3)

    def test_captions_count_the_points_that_are_left_out(self):
        captions = write_curves(self.run_object(), self.folder / "plots")
        self.assertEqual(len(captions), 3)
        for caption in captions.values():
            self.assertTrue(caption.endswith(
                "of the seeds. 2 points of 2 curves left out: a curve ends where the reference's"
                " noise exceeds 10 % of its MSE."
            ))
        implicit, mis = self.document["curves"]
        implicit["points"].pop()

        def points_of(curve):
            return curve["points"]

        self.assertRegex(left_out([implicit, mis], points_of), "^1 point of 1 curve left out:")
        self.assertEqual(left_out([implicit], points_of), "")

    def test_all_curves_have_their_own_colour_and_marker(self):
        for number in range(20):
            curve = copy.deepcopy(self.document["curves"][0])
            curve["id"] = f"path_tracing.mis,beta={number}"
            for point in curve["points"]:
                point["rmse"] *= 2**number
            self.document["curves"].append(curve)
        figure = curves_figure(self.run_object(), "spp")
        lines = [line for line in figure.axes[0].lines if line.get_marker() != "None"]
        self.assertEqual(len(lines), 22)
        self.assertEqual(len({(line.get_color(), line.get_marker()) for line in lines}), 22)


if __name__ == "__main__":
    unittest.main()
