// SPDX-License-Identifier: MIT
#include "experiments/harness/core/error_parts.h"

#include <fmt/format.h>

#include "experiments/harness/core/metrics.h"
#include "renderer/base/error.h"

namespace rtrays {

ByFirstHit divide_mse(const Image &image, const Image &reference, const FirstHits &classes) {
    require_same_size(image, reference);
    if (classes.size() != image.pixel_count()) {
        throw input_error(fmt::format("an image of {} pixels has {} classes of pixels",
                                      image.pixel_count(), classes.size()));
    }
    ByFirstHit parts{};
    for (const auto &name : rgb_names()) {
        const auto &values = image.channel(name);
        const auto &expected = reference.channel(name);
        for (size_t i = 0; i < values.size(); ++i) {
            const double d = static_cast<double>(values[i]) - static_cast<double>(expected[i]);
            parts[static_cast<size_t>(classes[i])] += d * d;
        }
    }
    for (double &part : parts) {
        part /= 3.0 * static_cast<double>(image.pixel_count());
    }
    return parts;
}

ByFirstHit pixel_shares(const FirstHits &classes) {
    ByFirstHit shares{};
    for (const FirstHit hit : classes) {
        shares[static_cast<size_t>(hit)] += 1.0 / static_cast<double>(classes.size());
    }
    return shares;
}

Image picture_of(const FirstHits &classes, int width, int height) {
    Image image = Image::rgb(width, height);
    const auto names = rgb_names();
    for (size_t i = 0; i < classes.size(); ++i) {
        image.channel(names[static_cast<size_t>(classes[i])])[i] = 1.0f;
    }
    return image;
}

FirstHits first_hits_of(const Image &picture) {
    FirstHits classes(picture.pixel_count());
    const auto names = rgb_names();
    for (size_t c = 0; c < names.size(); ++c) {
        const auto &values = picture.channel(names[c]);
        for (size_t i = 0; i < classes.size(); ++i) {
            if (values[i] > 0) {
                classes[i] = static_cast<FirstHit>(c);
            }
        }
    }
    return classes;
}

nlohmann::json to_json(const ByFirstHit &numbers) {
    nlohmann::json json;
    for (size_t i = 0; i < numbers.size(); ++i) {
        json[first_hit_names[i]] = numbers[i];
    }
    return json;
}

ByFirstHit parse_by_first_hit(const nlohmann::json &json) {
    ByFirstHit numbers{};
    for (size_t i = 0; i < numbers.size(); ++i) {
        json.at(first_hit_names[i]).get_to(numbers[i]);
    }
    return numbers;
}

}  // namespace rtrays
