// SPDX-License-Identifier: MIT
// Images of one row, for tests of errors by hand.
#pragma once

#include <vector>

#include "renderer/base/image.h"

namespace rtrays::test {

/// Returns an image of one row whose channels have the same values.
inline Image row(const std::vector<float> &values) {
    Image image = Image::rgb(static_cast<int>(values.size()), 1);
    for (const auto &name : rgb_names()) {
        image.channel(name) = values;
    }
    return image;
}

}  // namespace rtrays::test
