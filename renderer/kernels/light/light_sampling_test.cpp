// SPDX-License-Identifier: MIT
// Tests light sampling with the device code compiled for the host: every sampler against its
// density and against closed forms. Tests of sphere and disc lights are in shapes_light_test.cpp.
//
// Six chi-square tests share a family-wise level of 0.01, so each has the level 0.01 / 6
// (Bonferroni). Planted errors show that the sample counts suffice to detect 2 %.
#define FEATURE_triangles 1
#define FEATURE_lights 1
#define FEATURE_many_lights 1
#define FEATURE_area_lights 1
#define FEATURE_light_triangles 1
#define FEATURE_point_lights 1
#define FEATURE_spot_lights 1
#define FEATURE_directional_lights 1
#define FEATURE_infinite_lights 1
#define FEATURE_dome 1
#define FEATURE_environment 1
#include "testing/other_features.h"

#include "renderer/testing/float_traps.h"

#include "renderer/base/angles.h"
#include "renderer/kernels/light/light.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "renderer/compile/compile_scene.h"
#include "renderer/testing/chi_square.h"
#include "renderer/testing/scene_view.h"

namespace rtrays {
namespace {

constexpr uint32_t sample_count = 400000;
constexpr double level = 0.01 / 6;

uint4 words(uint32_t i, uint32_t block) {
    return random_words(7, STREAM_CAMERA, i, 0, block);
}

/// Returns the p-value of directions against a density per solid angle, on a grid of y and azimuth.
template <typename Sample, typename Density>
double direction_p(const Sample &sample, const Density &pdf_w) {
    constexpr int y_bins = 24, phi_bins = 32;
    std::vector<uint64_t> observed(y_bins * phi_bins);
    std::vector<double> expected(y_bins * phi_bins);
    for (uint32_t i = 0; i < sample_count; ++i) {
        const float3 w = sample(i);
        const int y = std::clamp(static_cast<int>((static_cast<double>(w.y) + 1.0) / 2.0 * y_bins),
                                 0, y_bins - 1);
        const double phi =
            std::atan2(static_cast<double>(w.x), static_cast<double>(-w.z)) / (2.0 * pi);
        const int column =
            std::clamp(static_cast<int>((phi < 0 ? phi + 1 : phi) * phi_bins), 0, phi_bins - 1);
        ++observed[static_cast<size_t>(y * phi_bins + column)];
    }
    for (int y = 0; y < y_bins; ++y) {
        for (int column = 0; column < phi_bins; ++column) {
            const auto density = [&](double height, double turn) {
                const double r = std::sqrt(1.0 - height * height);
                return static_cast<double>(pdf_w(make_float3(
                    static_cast<float>(r * std::sin(2.0 * pi * turn)), static_cast<float>(height),
                    static_cast<float>(-r * std::cos(2.0 * pi * turn)))));
            };
            expected[static_cast<size_t>(y * phi_bins + column)] =
                sample_count * 2.0 * pi *
                integrate(density, 2.0 * y / y_bins - 1.0, 2.0 * (y + 1) / y_bins - 1.0,
                          double(column) / phi_bins, double(column + 1) / phi_bins);
        }
    }
    return chi_square_p(observed, expected);
}

/// An environment of 16 x 9 texels with one bright texel, a dark half and a black row.
struct Environment {
    TextureImage image;
    CompiledScene compiled;
    double integral;

    Environment() {
        image.width = 16;
        image.height = 9;
        std::mt19937 random(3);
        for (int i = 0; i < image.width * image.height * 3; ++i) {
            const int texel = i / 3, row = texel / image.width;
            const float value = static_cast<float>(random() % 1000 + 1) * 1e-3f;
            image.floats.push_back(row == 6 || row == 7 ? 0.0f
                                   : texel == 35        ? 50.0f
                                   : row > 4            ? 0.05f * value
                                                        : value);
        }
        integral = compile_environment(image, compiled);
    }

    EnvironmentSample sample(uint32_t i) const {
        return sample_environment(compiled.environment_ends.data(), compiled.lighting, words(i, 1));
    }
    float pdf_w(float3 d) const {
        return environment_pdf_w(compiled.environment_ends.data(), compiled.lighting, d);
    }
    float3 radiance(float3 d) const {
        return environment_radiance(compiled.environment_texels.data(), compiled.lighting, d);
    }
};

TEST(EnvironmentLight, SamplesItsDensity) {
    const Environment environment;
    EXPECT_GT(direction_p([&](uint32_t i) { return environment.sample(i).direction; },
                          [&](float3 d) { return environment.pdf_w(d); }),
              level);
}

TEST(EnvironmentLight, PlantedErrorOfTwoPercentIsRejected) {
    const Environment environment;
    const auto wrong = [&](float3 d) { return environment.pdf_w(d) * (d.y > 0.0f ? 1.02f : 1.0f); };
    EXPECT_LT(direction_p([&](uint32_t i) { return environment.sample(i).direction; }, wrong),
              level);
}

TEST(EnvironmentLight, SampleCarriesTheDensityOfItsDirectionAndNoLightIsMissed) {
    const Environment environment;
    int other_cell = 0;
    for (uint32_t i = 0; i < 100000; ++i) {
        const EnvironmentSample sample = environment.sample(i);
        ASSERT_NEAR(length(sample.direction), 1.0f, 1e-6f);
        ASSERT_GT(sample.pdf_w, 0.0f);
        // On the edge of a cell, rounding may move the direction into the next cell.
        other_cell +=
            std::abs(environment.pdf_w(sample.direction) / sample.pdf_w - 1.0f) > 1e-5f ? 1 : 0;
        const uint4 w = words(i, 2);
        const float3 anywhere = sample_uniform_sphere(uniform_float(w.x), uniform_float(w.y));
        ASSERT_TRUE(environment.pdf_w(anywhere) > 0.0f || environment.radiance(anywhere).x < 1e-6f);
    }
    EXPECT_LT(other_cell, 20);
}

// Compares the radiance with an independent bilinear formula, and its integral with the estimate of
// the sampler.
TEST(EnvironmentLight, RadianceIsBilinearBetweenTexelCentres) {
    const Environment environment;
    const auto texel = [&](int x, int y, int channel) {
        const int row = std::clamp(y, 0, environment.image.height - 1);
        const int column =
            (x % environment.image.width + environment.image.width) % environment.image.width;
        return static_cast<double>(environment.image.floats[static_cast<size_t>(
            3 * (row * environment.image.width + column) + channel)]);
    };
    const auto bilinear = [&](double x, double y, int channel) {
        const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
        const double fx = x - x0, fy = y - y0;
        return (texel(x0, y0, channel) * (1 - fx) + texel(x0 + 1, y0, channel) * fx) * (1 - fy) +
               (texel(x0, y0 + 1, channel) * (1 - fx) + texel(x0 + 1, y0 + 1, channel) * fx) * fy;
    };
    const int width = environment.image.width, height = environment.image.height;
    double integral = 0;  // quadrature over the image of the mean of the channels
    constexpr int steps = 40;
    for (int i = 0; i < width * steps; ++i) {
        for (int j = 0; j < height * steps; ++j) {
            const double x = (i + 0.5) / steps - 0.5, y = (j + 0.5) / steps - 0.5;
            const double solid_angle =
                2 * pi / (width * steps) *
                (std::cos(pi * j / (height * steps)) - std::cos(pi * (j + 1) / (height * steps)));
            integral +=
                solid_angle * (bilinear(x, y, 0) + bilinear(x, y, 1) + bilinear(x, y, 2)) / 3;
        }
    }
    double sum = 0, squares = 0;
    constexpr uint32_t n = 400000;
    for (uint32_t i = 0; i < n; ++i) {
        const EnvironmentSample sample = environment.sample(i);
        const float3 d = sample.direction;
        const double phi =
            std::atan2(static_cast<double>(d.x), static_cast<double>(-d.z)) / (2 * pi);
        const double x = (phi < 0 ? phi + 1 : phi) * environment.image.width - 0.5;
        const double y = std::acos(static_cast<double>(d.y)) / pi * environment.image.height - 0.5;
        const double green = bilinear(x, y, 1);
        const float3 radiance = environment.radiance(d);
        ASSERT_NEAR(static_cast<double>(radiance.y), green, 2e-4 * (1 + green));
        const double value = static_cast<double>(radiance.x + radiance.y + radiance.z) /
                             (3.0 * static_cast<double>(sample.pdf_w));
        sum += value;
        squares += value * value;
    }
    const double mean = sum / n;
    const double error = std::sqrt((squares / n - mean * mean) / n);
    EXPECT_NEAR(mean, integral, 4.0 * error);
    EXPECT_NEAR(environment.integral, integral, 0.1 * integral);  // used by light selection
    EXPECT_LT(error, 0.002 * mean);
}

TEST(EnvironmentLight, PolesAndOneTexelAreSafe) {
    TextureImage image;
    image.width = image.height = 1;
    image.floats = {1, 2, 3};
    CompiledScene compiled;
    EXPECT_NEAR(compile_environment(image, compiled), 4 * pi * 2, 1e-12);
    for (const float3 d : {make_float3(0, 1, 0), make_float3(0, -1, 0), make_float3(0, 0, 1),
                           make_float3(-1e-30f, 0, 1), make_float3(1e-20f, 1, 0)}) {
        EXPECT_EQ(environment_radiance(compiled.environment_texels.data(), compiled.lighting, d).z,
                  3.0f);
        EXPECT_NEAR(environment_pdf_w(compiled.environment_ends.data(), compiled.lighting, d),
                    1 / (4 * pi), 1e-6);
    }
}

TEST(DomeLight, DirectionsAreUniform) {
    const auto sample = [](uint32_t i) {
        const uint4 w = words(i, 4);
        return sample_uniform_sphere(uniform_float(w.x), uniform_float(w.y));
    };
    EXPECT_GT(direction_p(sample, [](float3) { return 1.0 / (4 * pi); }), level);
    EXPECT_LT(direction_p(sample,
                          [](float3 d) { return (1.0 + (d.y > 0.0f ? 0.02 : -0.02)) / (4 * pi); }),
              level);
}

/// Two mesh lights of two and three triangles with unequal areas.
struct MeshLights {
    CompiledScene compiled;
    std::vector<double> area;

    MeshLights() {
        const std::array<int, 2> counts = {2, 3};
        const SelectionTable selection = selection_table({1.0, 2.0});
        for (uint32_t k = 0; k < 2; ++k) {
            std::vector<double> areas;
            for (int i = 0; i < counts[k]; ++i) {
                areas.push_back(0.5 * (i + 1) * 2.0);
            }
            const SelectionTable table = selection_table(areas);
            LightRecord light{};
            light.kind = LIGHT_MESH;
            light.selection = static_cast<float>(selection.probability[k]);
            light.selection_end = selection.end[k];
            light.first_triangle = static_cast<uint32_t>(compiled.emitter_triangles.size());
            light.triangle_count = static_cast<uint32_t>(counts[k]);
            compiled.lights.push_back(light);
            for (size_t i = 0; i < areas.size(); ++i) {
                const auto triangle = static_cast<uint32_t>(compiled.surface_triangles.size());
                const auto x = static_cast<float>(triangle * 10);
                compiled.surface_triangles.push_back({{x, 0, 0},
                                                      0,
                                                      {x + static_cast<float>(i + 1), 0, 0},
                                                      triangle,
                                                      {x, 2, 0},
                                                      3,
                                                      {0, 0, 1},
                                                      0});
                compiled.emitter_triangles.push_back(
                    {triangle, k, table.end[i],
                     static_cast<float>(table.probability[i] / areas[i])});
                area.push_back(areas[i]);
            }
        }
        compiled.lighting.light_count = 2;
        compiled.lighting.infinite_light = NO_EMITTER;
    }

    LightSample sample(float3 from, uint32_t i) const {
        const SceneView view = view_of(compiled);
        return sample_lights(&view, SELECT_LIGHT, from, words(i, 5));
    }
    float pdf_a(uint32_t triangle) const {
        const SceneView view = view_of(compiled);
        return light_pdf_a(&view, compiled.lights[compiled.emitter_triangles[triangle].light],
                           triangle, triangle, make_float3(0, 0, 0), SurfacePoint{});
    }

    /// Returns the p-value over triangles and, within each, four parts of equal area.
    double p(double planted) const {
        std::vector<uint64_t> observed(area.size() * 4);
        for (uint32_t i = 0; i < sample_count; ++i) {
            const float3 at = sample(make_float3(20, 0, 1e4f), i).target;
            const auto triangle = static_cast<size_t>(at.x / 10.0f + 1e-4f);
            const SurfaceTriangle &t = compiled.surface_triangles[triangle];
            const float u = (at.x - t.p0[0]) / (t.p1[0] - t.p0[0]);
            const float v = at.y / 2.0f;
            const size_t part = u > 0.5f       ? 1
                                : v > 0.5f     ? 2
                                : u + v < 0.5f ? 0
                                               : 3;  // part of the medial subdivision
            ++observed[triangle * 4 + part];
        }
        std::vector<double> expected(observed.size());
        for (size_t i = 0; i < expected.size(); ++i) {
            const double error = i / 4 == 4 ? 1.0 + planted : 1.0;
            expected[i] = sample_count * static_cast<double>(pdf_a(static_cast<uint32_t>(i / 4))) *
                          area[i / 4] / 4.0 * error;
        }
        return chi_square_p(observed, expected);
    }
};

TEST(MeshLight, SamplesItsDensity) {
    EXPECT_GT(MeshLights().p(0.0), level);
}

TEST(MeshLight, PlantedErrorOfTwoPercentIsRejected) {
    EXPECT_LT(MeshLights().p(0.02), level);
}

// The density per solid angle is the density per area times d^2 / cos, and 0 from behind.
TEST(MeshLight, DensityIsPerSolidAngle) {
    const MeshLights lights;
    const float3 from = make_float3(3, -2, 5);
    for (uint32_t i = 0; i < 1000; ++i) {
        const LightSample sample = lights.sample(from, i);
        const float3 way = sample.target - from;
        const auto triangle = static_cast<uint32_t>(sample.target.x / 10.0f + 1e-4f);
        const double cosine = 5.0 / static_cast<double>(length(way));
        EXPECT_NEAR(static_cast<double>(sample.pdf_w),
                    static_cast<double>(lights.pdf_a(triangle)) *
                        static_cast<double>(dot(way, way)) / cosine,
                    1e-4 * static_cast<double>(sample.pdf_w));
        EXPECT_EQ(lights.sample(make_float3(3, -2, -5), i).pdf_w, 0.0f);
        EXPECT_EQ(lights.sample(make_float3(3, -2, 0), i).pdf_w, 0.0f);
    }
}

LightSample sample_single(const LightRecord &light, float3 from) {
    SceneView scene{};
    scene.lights = &light;
    scene.lighting.light_count = 1;
    scene.lighting.far_distance = 1e6f;
    return sample_lights(&scene, 0, from, words(1, 6));
}

LightRecord delta_light(uint32_t kind) {
    LightRecord light{};
    light.kind = kind;
    light.selection = 0.5f;
    for (int i = 0; i < 3; ++i) {
        light.radiance[i] = static_cast<float>(i + 1);
    }
    light.axis_z[2] = 1;
    return light;
}

TEST(PointLight, IrradianceFallsWithTheSquareOfTheDistanceOver12Decades) {
    const LightRecord light = delta_light(LIGHT_POINT);
    for (int decade = -6; decade <= 6; ++decade) {
        const auto distance = static_cast<float>(std::pow(10.0, decade));
        const LightSample sample = sample_single(light, make_float3(0, distance, 0));
        EXPECT_NEAR(sample.radiance.z * distance * distance, 3.0f, 1e-5f);
        EXPECT_EQ(sample.pdf_w, 0.5f);
        EXPECT_NEAR(sample.wi.y, -1.0f, 1e-6f);
    }
    const test::InvalidAllowed in_the_light_itself;
    EXPECT_EQ(sample_single(light, make_float3(0, 0, 0)).pdf_w, 0.0f);
}

TEST(SpotLight, FallsLinearlyWithTheAngleBetweenItsCones) {
    LightRecord light = delta_light(LIGHT_SPOT);
    const double inner = 0.3, outer = 0.5;
    light.outer_angle = static_cast<float>(outer);
    light.versine_outer = static_cast<float>(1 - std::cos(outer));
    light.versine_range = static_cast<float>(std::cos(inner) - std::cos(outer));
    light.angle_scale = static_cast<float>(1 / (outer - inner));
    for (const auto &[angle, share] :
         {std::pair(0.0, 1.0), std::pair(0.29, 1.0), std::pair(0.35, 0.75), std::pair(0.45, 0.25),
          std::pair(0.4999, 0.0005)}) {
        const LightSample sample =
            sample_single(light, make_float3(static_cast<float>(2 * std::sin(angle)), 0,
                                             static_cast<float>(-2 * std::cos(angle))));
        EXPECT_NEAR(sample.radiance.x, share / 4, 1e-5) << angle;
    }
    EXPECT_EQ(sample_single(light, make_float3(0, 2, -1)).pdf_w, 0.0f);
    EXPECT_EQ(sample_single(light, make_float3(0, 0, 1)).pdf_w, 0.0f);
}

TEST(DirectionalLight, ComesFromItsAxisWithItsIrradiance) {
    const LightSample sample = sample_single(delta_light(LIGHT_DIRECTIONAL), make_float3(5, 6, 7));
    EXPECT_EQ(sample.radiance.y, 2.0f);
    EXPECT_EQ(sample.wi.z, 1.0f);
    EXPECT_EQ(sample.pdf_w, 0.5f);
    EXPECT_EQ(sample.is_delta, 1u);
}

}  // namespace
}  // namespace rtrays
