// SPDX-License-Identifier: MIT
// Sessions of tests: the device that they share, settings of small films, and what they render.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "renderer/device/context.h"
#include "renderer/session/render_session.h"

namespace rtrays::test {

/// The device of all sessions of a test program.
inline DeviceContext &device() {
    static DeviceContext context;
    return context;
}

/// Settings of a film of 16 x 16 pixels.
inline RenderSettings settings_of(const std::string &algorithm,
                                  const std::vector<std::string> &assignments = {}) {
    RenderSettings settings;
    settings.algorithm = &algorithm_named(algorithm);
    settings.width = settings.height = 16;
    for (const std::string &assignment : assignments) {
        apply_setting(settings, assignment);
    }
    return settings;
}

/// Renders samples into a film and returns its words.
inline std::vector<int64_t> film_words(RenderSession &session, uint64_t samples) {
    session.render(0, samples);
    const FilmState film = session.film();
    require_valid(film);
    return film.words;
}

/// Renders 4 samples of a scene and returns the words of the film.
inline std::vector<int64_t> film_words(const Scene &scene, const RenderSettings &settings) {
    RenderSession session(scene, settings, device());
    return film_words(session, 4);
}

/// Expects the same bits of a scene from one kernel for full paths, from another layout of paths,
/// and with all features compiled.
inline void expect_same_bits_however_traced(const Scene &scene) {
    const std::vector<int64_t> expected = film_words(scene, settings_of("path_tracing"));
    for (const char *assignment :
         {"device.pipeline=megakernel", "device.path_layout=interleaved", "device.features=all"}) {
        EXPECT_EQ(film_words(scene, settings_of("path_tracing", {assignment})), expected)
            << assignment;
    }
}

/// Expects the mean of the red channel within 5 standard errors and a fraction `bias` of it.
inline void expect_mean(const Scene &scene, const RenderSettings &settings, double expected,
                        double bias, const std::string &what = "") {
    RenderSession session(scene, settings, device());
    session.render(0, 256);
    const Image image = session.develop();
    const std::vector<float> &red = image.channel("R");
    const auto count = static_cast<double>(red.size());
    double mean = 0, variance = 0;
    for (size_t i = 0; i < red.size(); ++i) {
        mean += static_cast<double>(red[i]) / count;
        variance += static_cast<double>(image.channel("variance.R")[i]) / (count * count);
    }
    EXPECT_NEAR(mean, expected, 5 * std::sqrt(variance) + bias * expected)
        << what << ", " << settings.algorithm->name;
    EXPECT_LT(std::sqrt(variance), 0.02 * expected) << "statistical power";
}

}  // namespace rtrays::test
