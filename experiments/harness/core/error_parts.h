// SPDX-License-Identifier: MIT
// Divides the error of an image by what the camera sees first.
#pragma once

#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

#include "reference/first_hit.h"
#include "renderer/base/image.h"

namespace rtrays {

/// Classes of the pixels of an image, row by row.
using FirstHits = std::vector<FirstHit>;

/// One number for each class of pixels, indexed by `FirstHit`.
using ByFirstHit = std::array<double, first_hit_names.size()>;

/// Returns the part of the mean squared error that the pixels of each class cause: the sum of their
/// squared differences, divided by the values of the full image. The parts add up to the MSE.
/// Throws `Error` (bad input) if the sizes differ.
ByFirstHit divide_mse(const Image &image, const Image &reference, const FirstHits &classes);

/// Returns the share of pixels of each class.
ByFirstHit pixel_shares(const FirstHits &classes);

/// Returns a picture of the classes: red, green and blue are 1 in the pixels of the first, second
/// and third class.
Image picture_of(const FirstHits &classes, int width, int height);

/// Returns the classes of such a picture.
FirstHits first_hits_of(const Image &picture);

/// Writes and reads one number for each class, by its name.
nlohmann::json to_json(const ByFirstHit &numbers);
ByFirstHit parse_by_first_hit(const nlohmann::json &json);

}  // namespace rtrays
