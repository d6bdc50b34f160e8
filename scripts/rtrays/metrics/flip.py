# SPDX-License-Identifier: MIT
"""FLIP: how different two images look to a person who sees them alternate on a display. Every pixel
has a value between 0, no visible difference, and 1; the mean over the pixels is the FLIP of the
image.

* FLIP: P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. D. Fairchild,
  "FLIP: A Difference Evaluator for Alternating Images", HPG 2020. Comments name the steps of the
  paper.
* HDR-FLIP: P. Andersson, J. Nilsson, P. Shirley, T. Akenine-Möller, "Visualizing Errors in Rendered
  High Dynamic Range Images", Eurographics 2021, short papers.

Images are arrays of linear R, G, B (Rec. 709), shape (height, width, 3). Maps have the shape
(height, width).
"""

import math

import numpy

from rtrays.documents.document import RunError

# Observer of the paper: at 0.7 m from a display that is 0.7 m and 3840 pixels wide.
PIXELS_PER_DEGREE = 3840 * 0.7 / 0.7 * math.pi / 180

# Chromaticities (x, y) of the primaries of Rec. 709, and of its white, D65.
PRIMARIES = ((0.64, 0.33), (0.30, 0.60), (0.15, 0.06))
WHITE = (0.3127, 0.3290)

# Contrast sensitivity of the opponent channels by frequency f in cycles per degree: sums of
# a exp(-b f²), as (a, b), for luminance, red-green and blue-yellow.
SENSITIVITIES = (((1, 0.0047),), ((1, 0.0053),), ((34.1, 0.04), (13.5, 0.025)))

# Width of the detectors of edges and points, in degrees, from the least to the largest weight.
FEATURE_WIDTH = 0.082

COLOUR_EXPONENT = 0.7
FEATURE_EXPONENT = 0.5
# Differences below this share of the largest one take this share of the scale.
SHARE_OF_LARGEST = 0.4
SHARE_OF_SCALE = 0.95

# Tone-mapped value that the brightest pixel has in the shortest exposure of HDR-FLIP, and the
# median in the longest one.
EXPOSED = 0.85
# Least median that HDR-FLIP exposes, relative to the brightest pixel: one bit of a float. A darker
# one, as in an image that is black by half, would take infinite exposure.
DARKEST = 2.0**-23


def to_relative_xyz():
    """Returns the matrix from linear Rec. 709 to CIE XYZ, each relative to that of white."""
    x, y = numpy.array([*PRIMARIES, WHITE]).T
    *primaries, white = numpy.array([x / y, numpy.ones(4), (1 - x - y) / y]).T
    matrix = numpy.transpose(primaries)
    return matrix * numpy.linalg.solve(matrix, white) / white[:, None]


TO_XYZ = to_relative_xyz()
TO_RGB = numpy.linalg.inv(TO_XYZ)


def require_finite(picture, name):
    """Raises RunError with a name for the picture unless all its values are finite."""
    bad = numpy.argwhere(~numpy.isfinite(picture))
    if bad.size:
        row, column = bad[0][:2]
        raise RunError(f"{name}: pixel ({column}, {row}) is not finite; metrics need finite values")


def gaussian(offsets, deviation):
    """Returns a Gaussian with 1 at its centre."""
    return numpy.exp(-0.5 * (offsets / deviation) ** 2)


def filtered_down(channel, kernel):
    """Returns a channel filtered along its columns; the first and last row continue outside."""
    reach = len(kernel) // 2
    padded = numpy.pad(channel, ((reach, reach), (0, 0)), mode="edge")
    return sum(weight * padded[i : i + len(channel)] for i, weight in enumerate(kernel))


def filtered(channel, down, across):
    """Returns a channel filtered by the product of a kernel along columns and one along rows."""
    return filtered_down(filtered_down(channel, down).T, across).T


def opponent_channels(picture):
    """Returns Y, Cx and Cz of a picture in [0, 1] as a list, without the paper's scales (116, 500,
    200) and offset, which no linear filter needs. Luminance is 1 for white."""
    x, y, z = numpy.moveaxis(picture @ TO_XYZ.T, 2, 0)
    return [y, x - y, y - z]


def resolved(channel, terms, pixels_per_degree):
    """Returns an opponent channel as the eye resolves it: filtered by the inverse Fourier transform
    of its sensitivity, with sum 1 (spatial filtering)."""
    # All channels have the reach of the widest Gaussian: three standard deviations.
    widest = max(b for terms_of_channel in SENSITIVITIES for _, b in terms_of_channel)
    reach = math.ceil(3 * math.sqrt(widest / 2) / math.pi * pixels_per_degree)
    offsets = numpy.arange(-reach, reach + 1) / pixels_per_degree
    kernels = [gaussian(offsets, math.sqrt(b / 2) / math.pi) for _, b in terms]
    weights = [a * math.sqrt(math.pi / b) for a, b in terms]  # of one dimension, as in the paper
    total = sum(weight * kernel.sum() ** 2 for weight, kernel in zip(weights, kernels))
    return sum(
        weight / total * filtered(channel, kernel, kernel)
        for weight, kernel in zip(weights, kernels)
    )


def displayable(channels):
    """Returns linear R, G, B of opponent channels, clipped to the colours of the display."""
    y, cx, cz = channels
    return numpy.clip(numpy.stack([y + cx, y, y - cz], axis=-1) @ TO_RGB.T, 0, 1)


def uniform_colours(picture):
    """Returns L*, a*, b* of linear colours; a* and b* shrink with L*, by the Hunt effect
    (perceptually uniform colour space)."""
    t = picture @ TO_XYZ.T
    knee = 6 / 29
    x, y, z = numpy.moveaxis(
        numpy.where(t > knee**3, numpy.cbrt(t), t / (3 * knee**2) + 4 / 29), -1, 0
    )
    lightness = 116 * y - 16
    return lightness, 5 * lightness * (x - y), 2 * lightness * (y - z)


def hyab(colours, others):
    """Returns the HyAB distance of colours: city block in lightness, Euclidean in hue."""
    lightness, a, b = (one - other for one, other in zip(colours, others))
    return abs(lightness) + numpy.hypot(a, b)


def colour_difference(channels, others, pixels_per_degree):
    """Returns the difference of the resolved colours in [0, 1] (colour pipeline)."""
    difference = hyab(
        *(
            uniform_colours(
                displayable(
                    [
                        resolved(channel, terms, pixels_per_degree)
                        for channel, terms in zip(picture, SENSITIVITIES)
                    ]
                )
            )
            for picture in (channels, others)
        )
    )
    green, blue = numpy.identity(3)[1:]
    largest = hyab(uniform_colours(green), uniform_colours(blue)) ** COLOUR_EXPONENT
    # Error redistribution: most of the scale is for small differences.
    return numpy.interp(
        difference**COLOUR_EXPONENT,
        (0, SHARE_OF_LARGEST * largest, largest),
        (0, SHARE_OF_SCALE, 1),
    )


def balanced(kernel):
    """Returns a kernel whose positive weights have the sum 1, and its negative ones -1."""
    positive, negative = kernel.clip(min=0), kernel.clip(max=0)
    return positive / positive.sum() - negative / negative.sum()


def feature_strengths(luminance, pixels_per_degree):
    """Returns the strengths of edges and points in every pixel, at most √2: norms of the responses
    along both axes to the first and second derivative of a Gaussian."""
    deviation = 0.5 * FEATURE_WIDTH * pixels_per_degree
    reach = math.ceil(3 * deviation)
    offsets = numpy.arange(-reach, reach + 1)
    smooth = gaussian(offsets, deviation)
    smooth /= smooth.sum()
    for derivative in (-offsets, (offsets / deviation) ** 2 - 1):
        kernel = balanced(derivative * smooth)
        yield numpy.hypot(filtered(luminance, smooth, kernel), filtered(luminance, kernel, smooth))


def feature_difference(luminance, other, pixels_per_degree):
    """Returns the difference of edges and points in [0, 1] (feature pipeline). Luminance is 1 for
    white, by the erratum of the paper: (Y + 16) / 116."""
    edges, points = (
        abs(strength - other_strength)
        for strength, other_strength in zip(
            feature_strengths(luminance, pixels_per_degree),
            feature_strengths(other, pixels_per_degree),
        )
    )
    return (numpy.maximum(edges, points) / math.sqrt(2)) ** FEATURE_EXPONENT


def flip_map(image, reference, pixels_per_degree=PIXELS_PER_DEGREE):
    """Returns FLIP of two images as a display shows them: values are clipped to [0, 1]. The
    observer sees so many pixels in a degree of the visual angle, at least 1. Raises RunError for
    images of different sizes and for values that are not finite."""
    if image.shape != reference.shape:
        raise RunError(f"image: its shape {image.shape} is not {reference.shape} of the reference")
    require_finite(image, "image")
    require_finite(reference, "reference")
    channels, others = (
        opponent_channels(numpy.clip(picture.astype(float), 0, 1)) for picture in (image, reference)
    )
    colour = colour_difference(channels, others, pixels_per_degree)
    # Final difference. The exponent is above 0: features along both axes at once are below √2.
    return colour ** (1 - feature_difference(channels[0], others[0], pixels_per_degree))


def tone_mapped(picture):
    """Returns a display image of radiances above 0: K. Narkowicz' fit of the ACES tone curve, with
    the factor 0.6 that HDR-FLIP applies first."""
    x = 0.6 * picture
    return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)


def exposures(reference):
    """Returns the exposures of HDR-FLIP in stops, at least two and about a stop apart: from that
    which exposes the brightest pixel of the reference to that which exposes its median. A black
    reference has the exposure 0."""
    luminance = numpy.clip(reference, 0, None) @ TO_XYZ[1]
    brightest = luminance.max()
    if brightest == 0:
        return numpy.zeros(1)
    # tone_mapped(exposed) = EXPOSED, a quadratic equation
    quadratic = (2.51 - 2.43 * EXPOSED, 0.03 - 0.59 * EXPOSED, -0.14 * EXPOSED)
    exposed = numpy.roots(quadratic).max() / 0.6
    median = max(numpy.median(luminance), DARKEST * brightest)
    first, last = math.log2(exposed / brightest), math.log2(exposed / median)
    return numpy.linspace(first, last, max(2, math.ceil(last - first)))


def hdr_flip_map(image, reference, pixels_per_degree=PIXELS_PER_DEGREE):
    """Returns HDR-FLIP: the largest FLIP of the tone-mapped images over the exposures of the
    reference. Values below 0 count as 0. Raises RunError as flip_map does."""
    require_finite(image, "image")
    require_finite(reference, "reference")
    shown = [numpy.clip(picture.astype(float), 0, None) for picture in (image, reference)]
    return numpy.maximum.reduce(
        [
            flip_map(*(tone_mapped(2.0**stops * picture) for picture in shown), pixels_per_degree)
            for stops in exposures(reference)
        ]
    )


# Metrics by name: their label, and the function of an image and its reference that returns the map.
METRICS = {"flip": ("FLIP", flip_map), "hdr_flip": ("HDR-FLIP", hdr_flip_map)}
