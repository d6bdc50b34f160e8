// SPDX-License-Identifier: MIT
// Tests ray casting and Whitted ray tracing against closed forms in every pixel, and against path
// tracing for scenes in which both see the same paths. Neither algorithm uses random numbers, so
// only the error of path tracing is statistical.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "renderer/base/angles.h"
#include "renderer/device/context.h"
#include "renderer/import/json/scene_json.h"
#include "renderer/import/load_scene.h"
#include "renderer/kernels/sampling/random.h"
#include "renderer/session/render_session.h"
#include "renderer/testing/errors.h"

namespace rtrays {
namespace {

constexpr int size = 16;
constexpr double fov = 60;  ///< field of view, degrees

DeviceContext &device() {
    static DeviceContext context;
    return context;
}

/// Returns a scene with the given nodes and a camera at z = 5 that looks along -z.
Scene scene_of(const std::string &nodes) {
    return parse_scene_json(R"({"version": 1, "film": {"width": 16, "height": 16}, "nodes": [
        {"name": "camera", "transform": [{"look_at": {"origin": [0, 0, 5], "target": [0, 0, 0], "up": [0, 1, 0]}}],
         "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x"}}, )" +
                                nodes + "]}",
                            "test", "test");
}

RenderSettings settings_of(const std::string &algorithm,
                           const std::vector<std::string> &assignments = {}) {
    RenderSettings settings;
    settings.algorithm = &algorithm_named(algorithm);
    settings.stream_capacity = 300;
    for (const std::string &assignment : assignments) {
        apply_setting(settings, assignment);
    }
    return settings;
}

Image render(const Scene &scene, const RenderSettings &settings, uint64_t samples = 1) {
    RenderSession session(scene, settings, device());
    session.render(0, samples);
    return session.develop();
}

/// Returns the direction through the centre of pixel `i`, scaled to z = -1.
Eigen::Vector3d direction_of(size_t i) {
    const double pixel = 2 * std::tan(fov * pi / 360) / size;
    const double x = static_cast<double>(i % size), y = static_cast<double>(i / size);
    return {(x + 0.5 - size / 2.0) * pixel, -(y + 0.5 - size / 2.0) * pixel, -1};
}

/// Expects the value radiance(direction) in every pixel of the channel.
template <typename Radiance>
void expect_pixels(const Image &image, const std::string &channel, const Radiance &radiance,
                   double relative) {
    double largest = 0;
    for (size_t i = 0; i < image.pixel_count(); ++i) {
        const double expected = radiance(direction_of(i)),
                     found = static_cast<double>(image.channel(channel)[i]);
        ASSERT_NEAR(found, expected, relative * std::abs(expected)) << channel << " of pixel " << i;
        largest = std::max(largest, expected);
    }
    EXPECT_GT(largest, 0) << "statistical power";
}

const char *floor_and_lamp = R"(
    {"name": "floor", "geometry": {"type": "plane"}, "material": {"type": "lambert", "reflectance": [0.8, 0.5, 0.2]}},
    {"name": "lamp", "transform": [{"translate": [0.5, -0.25, 2]}], "light": {"type": "point", "intensity": [10, 20, 40]}})";

/// Returns the radiance of a floor point under the point light: rho / pi I cos / r^2.
double floor_radiance(const Eigen::Vector3d &point, double reflectance, double intensity) {
    const Eigen::Vector3d way = Eigen::Vector3d(0.5, -0.25, 2) - point;
    return reflectance / pi * intensity * way.z() / std::pow(way.norm(), 3);
}

TEST(RayCasting, ShowsWhatAPointLightSendsToAPlane) {
    for (const char *algorithm : {"ray_casting", "whitted"}) {
        const Image image = render(scene_of(floor_and_lamp), settings_of(algorithm));
        for (const auto &[channel, reflectance, intensity] :
             {std::tuple("R", 0.8, 10.0), std::tuple("G", 0.5, 20.0), std::tuple("B", 0.2, 40.0)}) {
            expect_pixels(
                image, channel,
                [&, r = reflectance, i = intensity](const Eigen::Vector3d &d) {
                    return floor_radiance(Eigen::Vector3d(0, 0, 5) + 5 * d, r, i);
                },
                1e-5);
        }
    }
}

TEST(RayCasting, AddsUpAllLights) {
    const auto lit = [&](const std::string &lamps) {
        return render(
                   scene_of(
                       R"({"name": "floor", "geometry": {"type": "plane"}, "material": {"type": "lambert",
                                   "reflectance": [0.8, 0.5, 0.2]}}, )" +
                       lamps),
                   settings_of("ray_casting"))
            .channel("G");
    };
    const std::string point = R"({"name": "lamp", "transform": [{"translate": [0.5, -0.25, 2]}],
                                  "light": {"type": "point", "intensity": [10, 20, 40]}})";
    const std::string sun =
        R"({"name": "sun", "transform": [{"look_at": {"origin": [1, 3, 2], "target": [0, 0, 0],
                                "up": [0, 1, 0]}}], "light": {"type": "directional", "irradiance": [1, 0.8, 0.5]}})";
    const std::vector<float> first = lit(point), second = lit(sun), both = lit(point + ", " + sun);
    for (size_t i = 0; i < both.size(); ++i) {
        ASSERT_FLOAT_EQ(both[i], first[i] + second[i]);
    }
    EXPECT_GT(first[0], 0);
    EXPECT_GT(second[0], 0);
}

TEST(RayCasting, EndsAtMirrors) {
    const Scene scene =
        scene_of(std::string(R"({"name": "mirror", "transform": [{"translate": [0, 0, 1]}],
        "geometry": {"type": "rectangle"}, "material": {"type": "mirror", "reflectance": [1, 1, 1]}}, )") +
                 floor_and_lamp);
    const Image image = render(scene, settings_of("ray_casting"));
    EXPECT_EQ(image.channel("G")[8 * size + 8], 0);
    EXPECT_GT(image.channel("G")[0], 0);
    const nlohmann::json report =
        RenderSession(scene, settings_of("ray_casting"), device()).report();
    EXPECT_EQ(report["settings"]["integrator.max_depth"], "1");
    EXPECT_EQ(report["settings"]["integrator.sampler"], "regular");
}

// A white surface that faces the camera in the middle of the scene has the radiance 1. No visible
// point is in shadow.
TEST(RayCasting, LightsADarkSceneFromTheCamera) {
    const Scene scene = scene_of(R"({"name": "square", "geometry": {"type": "rectangle"},
        "transform": [{"scale": [0.5, 0.5, 1]}], "material": {"type": "lambert", "reflectance": [1, 0.5, 0.25]}})");
    for (const char *algorithm : {"ray_casting", "whitted"}) {
        const Image image = render(scene, settings_of(algorithm));
        const auto centre = static_cast<size_t>(8 * size + 8);
        const double cosine = 1 / direction_of(centre).norm();
        for (const auto &[channel, reflectance] :
             {std::pair("R", 1.0), std::pair("G", 0.5), std::pair("B", 0.25)}) {
            EXPECT_NEAR(image.channel(channel)[centre], reflectance * std::pow(cosine, 3), 1e-5)
                << algorithm;
        }
    }
    EXPECT_EQ(render(scene, settings_of("path_tracing")).channel("R")[8 * size + 8], 0)
        << "other algorithms render the dark scene as it is";
}

// The mirror at z = 0 shows the wall at z = 8 behind the camera as a camera at z = -5 sees it.
TEST(Whitted, ShowsTheMirrorImage) {
    const Image image = render(scene_of(R"(
        {"name": "mirror", "geometry": {"type": "plane"}, "material": {"type": "mirror", "reflectance": [0.9, 0.6, 0.3]}},
        {"name": "wall", "geometry": {"type": "plane"}, "material": {"type": "lambert", "reflectance": [0.5, 0.5, 0.5]},
         "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": 180}}, {"translate": [0, 0, 8]}]},
        {"name": "lamp", "transform": [{"translate": [1, 0.5, 6]}], "light": {"type": "point", "intensity": [10, 20, 40]}})"),
                               settings_of("whitted"));
    for (const auto &[channel, reflectance, intensity] :
         {std::tuple("R", 0.9, 10.0), std::tuple("G", 0.6, 20.0), std::tuple("B", 0.3, 40.0)}) {
        expect_pixels(
            image, channel,
            [&, r = reflectance, i = intensity](const Eigen::Vector3d &d) {
                const Eigen::Vector3d point =
                    Eigen::Vector3d(0, 0, -5) + 13 * Eigen::Vector3d(d.x(), d.y(), 1);
                const Eigen::Vector3d way = Eigen::Vector3d(1, 0.5, 6) - point;
                const double direct = 0.5 / pi * i * -way.z() / std::pow(way.norm(), 3);
                // In reality, the lamp's mirror image also lights the wall. Whitted ray tracing
                // cannot find that path, because it is a caustic.
                return r * direct;
            },
            1e-5);
    }
}

/// Returns the reflectance of a smooth boundary of index 1.5 from outside.
double fresnel(double cosine) {
    const double refracted = std::sqrt(1 - (1 - cosine * cosine) / 2.25);
    const double s = (cosine - 1.5 * refracted) / (cosine + 1.5 * refracted);
    const double p = (1.5 * cosine - refracted) / (1.5 * cosine + refracted);
    return (s * s + p * p) / 2;
}

const char *slab_under_sky = R"(
    {"name": "front", "geometry": {"type": "plane"}, "material": {"type": "glass", "eta": 1.5}},
    {"name": "back", "geometry": {"type": "plane"}, "material": {"type": "glass", "eta": 1.5},
     "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": 180}}, {"translate": [0, 0, -0.5]}]},
    {"name": "sky", "light": {"type": "dome", "radiance": [1, 1, 1]}})";

// Under uniform light, a slab of glass shows F after one event and (1 - F)^2 F^(n - 2) after n
// events. One sample contains all orders of reflection and transmission up to the limit. Without a
// limit, they sum to 1.
TEST(Whitted, FollowsEveryOrderOfReflectionInASlab) {
    for (const int depth : {1, 2, 3, 5, 8, 12}) {
        const Image image =
            render(scene_of(slab_under_sky),
                   settings_of("whitted", {"integrator.max_depth=" + std::to_string(depth)}));
        expect_pixels(
            image, "G",
            [&](const Eigen::Vector3d &d) {
                const double f = fresnel(1 / d.norm());
                double sum = f;
                for (int n = 2; n <= depth; ++n) {
                    sum += (1 - f) * (1 - f) * std::pow(f, n - 2);
                }
                return sum;
            },
            1e-5);
    }
    const nlohmann::json report =
        RenderSession(scene_of(slab_under_sky), settings_of("whitted"), device()).report();
    EXPECT_EQ(report["settings"]["integrator.max_depth"], "8");
    EXPECT_EQ(report["branch_bytes_per_path"], 8 * 48)
        << "hit, direction, throughput, depth, component";
}

// The limit that docs/scene-format.md gives for the gap between surfaces. A ray that leaves a
// window must hit the lamp behind the gap.
TEST(Whitted, SeesASurfaceBehindANarrowGap) {
    for (const auto &[x, gap] : {std::pair(0.0, 1e-5), std::pair(1000.0, 1e-3)}) {
        const auto centre_at = [&, at = x](double distance) {
            const auto square = [&](const char *name, double square_x, double z) {
                return fmt::format(
                    R"(, {{"name": "{}", "geometry": {{"type": "rectangle"}}, "transform": [{{"translate": [{}, 0, {}]}}], )",
                    name, square_x, z);
            };
            const std::string black =
                R"("material": {"type": "lambert", "reflectance": [0, 0, 0], "emission": )";
            const Scene scene = parse_scene_json(
                fmt::format(R"({{"version": 1, "film": {{"width": 16, "height": 16}}, "nodes": [
                    {{"name": "camera", "transform": [{{"translate": [{}, 0, 5]}}],
                      "camera": {{"type": "pinhole", "fov": 60, "fov_axis": "x"}}}})",
                            at) +
                    square("lamp", at, 0) + black + "[1, 1, 1]}}" + square("window", at, distance) +
                    R"("material": {"type": "refraction", "eta": 1.5, "transmittance": [1, 1, 1]}})" +
                    square("other", -at, -1) + black + "[0, 0, 0]}}]}",
                "test", "test");
            return render(scene, settings_of("whitted")).channel("G")[8 * size + 8];
        };
        EXPECT_EQ(centre_at(gap), centre_at(100 * gap)) << x;
        EXPECT_GT(centre_at(gap), 0) << x;
    }
}

TEST(Whitted, CutsBranchesBelowAThreshold) {
    // Inside the slab, each reflection has less than 5 % of the transmitted light. With a threshold
    // of 0.06, only the transmission is followed.
    const Image image = render(scene_of(slab_under_sky),
                               settings_of("whitted", {"integrator.termination=adaptive",
                                                       "integrator.adaptive_threshold=0.06"}));
    const auto centre = static_cast<size_t>(8 * size + 8);
    const double f = fresnel(1 / direction_of(centre).norm());
    EXPECT_NEAR(image.channel("G")[centre], (1 - f) * (1 - f), 1e-5);
}

// Through a pane of glass, the wall is seen on paths E SS D L. Paths E SSSS D L and paths that
// continue from the wall need five or more events, which exceeds the limit of 4. Therefore, path
// tracing finds the same paths, but stochastically.
TEST(Whitted, IsWhatPathTracingExpects) {
    const Scene scene = scene_of(R"(
        {"name": "pane", "geometry": {"type": "box"}, "transform": [{"scale": [9, 9, 0.2]}, {"translate": [0, 0, 2]}],
         "material": {"type": "glass", "eta": 1.5, "transmittance": [1, 0.8, 0.6]}},
        {"name": "wall", "geometry": {"type": "plane"}, "material": {"type": "lambert", "reflectance": [0.8, 0.5, 0.2]}},
        {"name": "lamp", "transform": [{"translate": [0.5, -0.25, 1]}], "light": {"type": "point", "intensity": [10, 20, 40]}},
        {"name": "spot", "transform": [{"look_at": {"origin": [-1, 0, 1.5], "target": [0, 0, 0], "up": [0, 1, 0]}}],
         "light": {"type": "spot", "intensity": [3, 3, 3], "inner_degrees": 20, "outer_degrees": 60}})");
    const Image sure = render(scene, settings_of("whitted", {"integrator.max_depth=4"}), 1024);
    const Image chance =
        render(scene, settings_of("path_tracing", {"integrator.max_depth=4"}), 4096);
    for (const char *channel : {"R", "G", "B"}) {
        double difference = 0, mean = 0, variance = 0;
        const std::vector<float> &errors = chance.channel(std::string("variance.") + channel);
        for (size_t i = 0; i < sure.pixel_count(); ++i) {
            difference +=
                static_cast<double>(chance.channel(channel)[i] - sure.channel(channel)[i]) / 256;
            mean += static_cast<double>(sure.channel(channel)[i]) / 256;
            variance += static_cast<double>(errors[i]) / (256.0 * 256.0);
        }
        // Three means share a family-wise level of 0.01 (two-sided, Bonferroni).
        EXPECT_LT(std::abs(difference), 2.94 * std::sqrt(variance)) << channel;
        EXPECT_LT(std::sqrt(variance), 0.003 * mean) << "statistical power";
    }
}

TEST(Whitted, DrawsNothing) {
    const Scene scene = load_scene(RTRAYS_SCENES "/features/glass.json");
    for (const char *algorithm : {"ray_casting", "whitted"}) {
        const auto words = [&](uint32_t seed, const std::vector<std::string> &assignments) {
            RenderSettings settings = settings_of(algorithm, assignments);
            settings.width = settings.height = size;
            settings.seed = seed;
            RenderSession session(scene, settings, device());
            session.render(0, 3);
            session.render(3, 8);
            return session.film().words;
        };
        const std::vector<int64_t> first = words(1, {});
        EXPECT_EQ(words(2, {}), first) << "another seed";
        if (algorithm == std::string("whitted")) {
            EXPECT_EQ(words(1, {"device.features=all"}), first) << "all features compiled in";
        }
        EXPECT_EQ(words(1, {"device.path_layout=arrays", "device.stream_capacity=77",
                            "device.stream_chunk=5"}),
                  first);
    }
}

TEST(Whitted, LightsSoftlyByMoreSamples) {
    // Area lights are sampled at a point that is the same for all pixels and differs between
    // samples.
    const Scene scene = load_scene(RTRAYS_SCENES "/analytic/emitter_direct.json");
    RenderSettings settings = settings_of("ray_casting");
    settings.width = settings.height = 33;
    const double a = 1.0, h = 2.0, r = std::sqrt(a * a + h * h);  // half side, height
    const double expected = 0.8 / pi * 4.0 * a / r * std::atan(a / r);
    EXPECT_NEAR(render(scene, settings, 1024).channel("R")[16 * 33 + 16], expected,
                0.005 * expected);
    EXPECT_GT(render(scene, settings, 1).channel("R")[16 * 33 + 16], 0.5 * expected);
}

TEST(Whitted, RefusesWhatItDoesNotDo) {
    for (const auto &[algorithm, assignment, fragment] :
         {std::tuple("whitted", "integrator.sampler=sobol", "draws no random numbers"),
          std::tuple("whitted", "integrator.light_selection=power",
                     "samples every light at every point"),
          std::tuple("whitted", "integrator.strategies=implicit", "not supported by whitted"),
          std::tuple("path_tracing", "integrator.sampler=regular", "needs random numbers")}) {
        expect_input_error(fragment, [&, a = algorithm, s = assignment] {
            const RenderSettings settings = settings_of(a, {s});
            require_consistent(settings);
        });
    }
}

}  // namespace
}  // namespace rtrays
