# SPDX-License-Identifier: MIT
"""Tests FLIP against values of its authors' own program, and where its value is known."""

import unittest

import numpy

from rtrays.documents.document import RunError
from rtrays.metrics.flip import (
    DARKEST,
    EXPOSED,
    PIXELS_PER_DEGREE,
    TO_XYZ,
    exposures,
    flip_map,
    hdr_flip_map,
    tone_mapped,
)


def gratings(phase):
    """Returns an image of 21 x 15 pixels with waves in [0, 1], another one in each channel."""
    y, x = numpy.mgrid[:15, :21]
    waves = (numpy.sin(0.9 * x + phase), numpy.cos(0.7 * y), numpy.sin(0.02 * x * y - phase))
    return 0.5 + 0.5 * numpy.stack(waves, axis=-1)


def bright(phase):
    """Returns an image with radiances from 0.05 to 20."""
    return 0.05 * 400 ** gratings(phase)


def grey(value, size=4):
    """Returns a square image of one grey value."""
    return numpy.full((size, size, 3), value, dtype=float)


# Mean and pixels (0, 0) and (10, 7) of the maps of `picture(0.2)` against `picture(0)`, by the
# program of the authors of FLIP: flip_evaluator.evaluate(reference, image, "LDR" or "HDR",
# inputsRGB=False, applyMagma=False, parameters={"ppd": ...}) of the package flip-evaluator 1.7
# (PyPI). It takes float32; images for "LDR" were clipped to [0, 1].
MEASURED = (
    (flip_map, gratings, PIXELS_PER_DEGREE, (0.189388, 0.258631, 0.167927)),
    (flip_map, gratings, 30, (0.229455, 0.303716, 0.206971)),
    (flip_map, bright, PIXELS_PER_DEGREE, (0.178467, 0.479090, 0.068385)),
    (flip_map, bright, 30, (0.182747, 0.618527, 0.043425)),
    (hdr_flip_map, gratings, PIXELS_PER_DEGREE, (0.139701, 0.166881, 0.115860)),
    (hdr_flip_map, gratings, 30, (0.176730, 0.192249, 0.113973)),
    (hdr_flip_map, bright, PIXELS_PER_DEGREE, (0.267451, 0.411001, 0.212829)),
    (hdr_flip_map, bright, 30, (0.327837, 0.508013, 0.320631)),
)


class Flip(unittest.TestCase):
    def test_maps_are_those_of_the_authors(self):
        for measure, picture, pixels_per_degree, expected in MEASURED:
            errors = measure(picture(0.2), picture(0), pixels_per_degree)
            self.assertEqual(errors.shape, (15, 21))
            found = (errors.mean(), errors[0, 0], errors[7, 10])
            numpy.testing.assert_allclose(found, expected, atol=5e-5)

    def test_equal_images_have_no_difference(self):
        for picture in (gratings(0), bright(0), grey(0), grey(1), grey(0.3, 1)):
            for measure in (flip_map, hdr_flip_map):
                numpy.testing.assert_array_equal(measure(picture, picture.copy()), 0)

    def test_flat_images_have_the_difference_of_their_colours(self):
        green, blue = (grey(1) * channels for channels in ((0, 1, 0), (0, 0, 1)))
        numpy.testing.assert_allclose(flip_map(green, blue), 1, atol=1e-12)
        # The HyAB distance of black and white is 100. That of green, L*a*b* = (87.735, -86.183,
        # 83.180), and blue, (32.297, 79.188, -107.860), is 203.3 after Hunt's factor L* / 100.
        largest = 203.3**0.7
        expected = 0.95 + 0.05 * (100**0.7 - 0.4 * largest) / (0.6 * largest)
        for size in (1, 4):
            found = flip_map(grey(0, size), grey(1, size))
            numpy.testing.assert_allclose(found, expected, atol=2e-5)

    def test_a_display_clips(self):
        numpy.testing.assert_array_equal(flip_map(grey(7), grey(1)), 0)
        numpy.testing.assert_array_equal(flip_map(grey(-1), grey(0)), 0)
        self.assertGreater(hdr_flip_map(grey(7), grey(1)).min(), 0.1)

    def test_two_images_have_one_difference(self):
        numpy.testing.assert_array_equal(
            flip_map(gratings(0.2), gratings(0)), flip_map(gratings(0), gratings(0.2))
        )

    def test_exposures_show_the_brightest_pixel_and_the_median(self):
        reference = bright(0)
        luminance = reference @ TO_XYZ[1]
        stops = exposures(reference)
        self.assertEqual(len(stops), 3)
        shown = tone_mapped(
            2.0 ** stops[[0, -1]] * (luminance.max(), numpy.median(luminance))
        )
        numpy.testing.assert_allclose(shown, EXPOSED)

    def test_exposures_of_dark_references_are_finite(self):
        numpy.testing.assert_array_equal(exposures(grey(0)), [0])
        self.assertGreater(hdr_flip_map(grey(0.5), grey(0)).min(), 0.5)
        lamp = grey(0)
        lamp[0, 0] = 3
        stops = exposures(lamp)
        self.assertAlmostEqual(stops[-1] - stops[0], -numpy.log2(DARKEST))

    def test_values_that_are_not_finite_are_errors(self):
        broken = grey(0.5)
        broken[1, 2, 0] = numpy.nan
        endless = grey(0.5)
        endless[3, 0] = numpy.inf
        for measure in (flip_map, hdr_flip_map):
            with self.assertRaisesRegex(RunError, r"^image: pixel \(2, 1\) is not finite"):
                measure(broken, grey(0.5))
            with self.assertRaisesRegex(RunError, r"^reference: pixel \(0, 3\) is not finite"):
                measure(grey(0.5), endless)

    def test_sizes_must_agree(self):
        for measure in (flip_map, hdr_flip_map):
            with self.assertRaisesRegex(RunError, r"\(1, 1, 3\) is not \(4, 4, 3\)"):
                measure(grey(0, 1), grey(0))


if __name__ == "__main__":
    unittest.main()
