# SPDX-License-Identifier: MIT
"""Tests the figures made of images."""

import unittest

import numpy

from rtrays.plots.image_plots import images_figure, to_display
from rtrays.testing import RunFolder


class ImagePlots(RunFolder):
    def test_difference_is_ten_times(self):
        run = self.run_object()
        figure = images_figure(run, run.curves[0])
        shown = figure.axes[2].images[0].get_array()
        reference, ours = (
            numpy.load(self.folder / f"images/{name}.npy") for name in ("reference", "ours")
        )
        numpy.testing.assert_allclose(
            shown, to_display(10 * numpy.abs(ours.astype(float) - reference)), atol=1e-12
        )
        self.assertAlmostEqual(float(to_display(numpy.array(0.5))), 0.7353569830524495)


if __name__ == "__main__":
    unittest.main()
