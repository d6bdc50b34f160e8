// SPDX-License-Identifier: MIT
#pragma once

#include "renderer/scene/stores.h"

namespace rtrays::mitsuba {

/// Mitsuba's envmap (3.9, src/emitters/envmap.cpp, eval_spectrum) has the first row of its image at
/// the upper pole and the last one at the lower pole, ours (stores.h) their centres half a row away
/// from them. Along u both agree.
///
/// The same radiance of every direction in Mitsuba's form: 2 h + 1 rows, of which the odd ones are
/// ours, those between them are their means and the ones at the poles repeat their neighbours. One
/// column becomes two, as Mitsuba wants.
TextureImage to_mitsuba_envmap(const TextureImage &image);

/// From Mitsuba's form. What `to_mitsuba_envmap` made comes back as it was. Of any other image the
/// rows, h of them, become 2 (h - 1) at a quarter and three quarters between each pair: linear
/// interpolation between these is Mitsuba's everywhere but within a quarter of a row from one of
/// Mitsuba's, where it is off by up to 1/8 of the second difference of rows. 8 bits are decoded by
/// the sRGB curve, as there. Throws `Error` (bad input) for an image below 2 x 3 texels, which
/// Mitsuba refuses.
TextureImage from_mitsuba_envmap(const TextureImage &image);

}  // namespace rtrays::mitsuba
