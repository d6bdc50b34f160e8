// SPDX-License-Identifier: MIT
// Conversion of environment images between our layout and Mitsuba's.
// Mitsuba's envmap (3.9, src/emitters/envmap.cpp, eval_spectrum) places the first image row at the
// upper pole and the last one at the lower pole. Our rows (stores.h) have their centres half a row
// away from the poles. Both layouts agree along u.
#pragma once

#include "renderer/scene/stores.h"

namespace rtrays::mitsuba {

/// Returns the image in Mitsuba's layout, with the same radiance in every direction. An image of h
/// rows becomes one of 2 h + 1 rows. Odd rows are ours, even rows are means of their neighbours,
/// and the rows at the poles repeat their neighbour. A single column becomes two, the minimum.
TextureImage to_mitsuba_envmap(const TextureImage &image);

/// Returns the image converted from Mitsuba's layout. The result of `to_mitsuba_envmap` is restored
/// exactly. The h rows of any other image become m (h - 1) rows, m = 2 to 32 between each pair, for
/// at most 2^20 texels if m is above 2. Linear interpolation between these rows matches Mitsuba's,
/// except within 1/(2 m) of a row from each of Mitsuba's rows. There it differs by up to 1/(4 m) of
/// the second difference of rows. 8-bit texels are decoded by the sRGB curve, as in Mitsuba. Throws
/// `Error` (bad input) for an image below 2 x 3 texels, which Mitsuba rejects.
TextureImage from_mitsuba_envmap(const TextureImage &image);

}  // namespace rtrays::mitsuba
