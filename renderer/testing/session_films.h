// SPDX-License-Identifier: MIT
// Sessions of tests: the device that they share, settings of small films, and what they render.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "renderer/compile/device_scene.h"
#include "renderer/device/context.h"
#include "renderer/session/pilot.h"
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

/// Returns what the pilot of a session with these settings finds.
inline Pilot pilot_of(const Scene &scene, const RenderSettings &settings) {
    const auto shared = std::make_shared<DeviceScene>(
        scene, device_scene_settings(settings, device().info()), device());
    return run_pilot(shared, scene, settings);
}

/// The mean of the red channel and its standard error, and the mean of the variances of its pixels.
struct ImageMean {
    double value = 0, error = 0, variance = 0;
};

/// Renders samples of a scene and returns the mean of the image.
inline ImageMean mean_of(const Scene &scene, const RenderSettings &settings, uint64_t samples) {
    RenderSession session(scene, settings, device());
    session.render(0, samples);
    const Image image = session.develop();
    const std::vector<float> &red = image.channel("R"), &variance = image.channel("variance.R");
    const auto count = static_cast<double>(red.size());
    ImageMean mean;
    for (size_t i = 0; i < red.size(); ++i) {
        mean.value += static_cast<double>(red[i]) / count;
        mean.variance += static_cast<double>(variance[i]) / count;
    }
    mean.error = std::sqrt(mean.variance / count);
    return mean;
}

/// Returns how many standard errors lie between two means.
inline double errors_off(const ImageMean &a, const ImageMean &b) {
    return std::abs(a.value - b.value) / std::hypot(a.error, b.error);
}

/// Expects the mean of the red channel within 5 standard errors and a fraction `bias` of it.
inline void expect_mean(const Scene &scene, const RenderSettings &settings, double expected,
                        double bias, const std::string &what = "") {
    const ImageMean mean = mean_of(scene, settings, 256);
    EXPECT_NEAR(mean.value, expected, 5 * mean.error + bias * expected)
        << what << ", " << settings.algorithm->name;
    EXPECT_LT(mean.error, 0.02 * expected) << "statistical power";
}

}  // namespace rtrays::test
