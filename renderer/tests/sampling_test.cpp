// SPDX-License-Identifier: MIT
// Every sampler against its density by chi-square: the shipped device code compiled for the host.
//
// Three tests that may reject by chance share a family-wise level of 0.01: each decides at 0.01 / 3 (Bonferroni). The
// planted errors show that the sample counts see 2 %. (The camera's only random choice is the place in the pixel, two
// uniform numbers: the first of the three.)
#define FEATURE_lambert 1
#define FEATURE_lights 1
#define FEATURE_many_lights 1
#define FEATURE_light_triangles 1
#include "renderer/kernels/bsdf/bsdf.h"
#include "renderer/kernels/camera/perspective.h"
#include "renderer/kernels/light/area_light.h"
#include "renderer/kernels/light/mis.h"
#include "renderer/kernels/sampling/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>

#include "renderer/pipeline/compile_scene.h"
#include "renderer/tests/chi_square.h"

namespace rtrays {
namespace {

constexpr double level = 0.01 / 3;
constexpr double pi = 3.14159265358979323846;
constexpr uint32_t sample_count = 1'000'000;

uint4 words(uint32_t sample, uint32_t block = 0) { return random_words(11, 0, 3, sample, block); }

// The known-answer vectors of Random123's own test suite (kat_vectors: philox4x32 10).
TEST(Random, PhiloxKnownAnswers) {
    const uint4 zero = random_words(0, 0, 0, 0, 0);
    EXPECT_EQ(zero.x, 0x6627e8d5u);
    EXPECT_EQ(zero.y, 0xe169c58du);
    EXPECT_EQ(zero.z, 0xbc57ac4cu);
    EXPECT_EQ(zero.w, 0x9b00dbd8u);
    const uint4 ones = random_words(~0u, ~0u, ~0u, ~0ul, ~0u);
    EXPECT_EQ(ones.x, 0x408f276du);
    EXPECT_EQ(ones.y, 0x41c83b0eu);
    EXPECT_EQ(ones.z, 0xa20bc7c6u);
    EXPECT_EQ(ones.w, 0x6d5451fdu);
}

TEST(Random, CountsBeyond32Bits) {
    EXPECT_NE(random_words(1, 0, 0, 5, 0).x, random_words(1, 0, 0, 5 + (1ul << 32), 0).x);
}

TEST(Random, UniformFloatsStayBelowOne) {
    EXPECT_EQ(uniform_float(0), 0.0f);
    EXPECT_LT(uniform_float(~0u), 1.0f);
}

TEST(ChiSquare, GivesKnownProbabilitiesAndLeavesNoSampleOut) {
    // One degree of freedom: erfc(sqrt(x / 2)); two: exp(-x / 2).
    EXPECT_NEAR(chi_square_p({600, 400}, {500, 500}) / std::erfc(std::sqrt(20.0)), 1.0, 1e-9);
    EXPECT_NEAR(chi_square_p({104, 100, 84}, {96, 96, 96}) / std::exp(-(64.0 + 16 + 144) / 96 / 2), 1.0, 1e-9);
    EXPECT_EQ(chi_square_p({1, 500, 499}, {0, 500, 500}), 0.0);
    EXPECT_LT(chi_square_p({50, 100, 1000}, {1e-6, 100, 1000}), 1e-5) << "where next to none is expected";
}

TEST(Random, UniformFloatsPassChiSquareInPairs) {
    constexpr int bins = 64;
    std::vector<uint64_t> observed(bins * bins);
    for (uint32_t i = 0; i < sample_count; ++i) {
        const uint4 w = words(i);
        ++observed[static_cast<size_t>(uniform_float(w.x) * bins) * bins + static_cast<size_t>(uniform_float(w.y) * bins)];
    }
    EXPECT_GT(chi_square_p(observed, std::vector<double>(bins * bins, sample_count / double(bins * bins))), level);
}

/// p-value of directions in the frame of `n` against a density per solid angle, on a grid of cos theta and phi.
double direction_p(const std::function<float3(uint32_t)> &sample, const std::function<double(float3)> &pdf_w, float3 n) {
    constexpr int z_bins = 20, phi_bins = 40;
    const Frame frame = frame_from_z(n);
    std::vector<uint64_t> observed(z_bins * phi_bins);
    std::vector<double> expected(z_bins * phi_bins);
    for (uint32_t i = 0; i < sample_count; ++i) {
        const float3 w = sample(i);
        const double z = std::clamp(static_cast<double>(dot(w, frame.z)), -1.0, 1.0);
        const double phi = std::atan2(static_cast<double>(dot(w, frame.y)), static_cast<double>(dot(w, frame.x))) + pi;
        const int zi = std::min(static_cast<int>((z + 1.0) / 2.0 * z_bins), z_bins - 1);
        const int pi_bin = std::min(static_cast<int>(phi / (2.0 * pi) * phi_bins), phi_bins - 1);
        ++observed[static_cast<size_t>(zi * phi_bins + pi_bin)];
    }
    for (int zi = 0; zi < z_bins; ++zi) {
        for (int phi_bin = 0; phi_bin < phi_bins; ++phi_bin) {
            const auto density = [&](double z, double phi) {
                const double r = std::sqrt(1.0 - z * z);
                return pdf_w(to_world(frame, make_float3(static_cast<float>(r * std::cos(phi - pi)),
                                                         static_cast<float>(r * std::sin(phi - pi)), static_cast<float>(z))));
            };
            expected[static_cast<size_t>(zi * phi_bins + phi_bin)] =
                sample_count * integrate(density, 2.0 * zi / z_bins - 1.0, 2.0 * (zi + 1) / z_bins - 1.0,
                                         2.0 * pi * phi_bin / phi_bins, 2.0 * pi * (phi_bin + 1) / phi_bins);
        }
    }
    return chi_square_p(observed, expected);
}

const float3 tilted = normalize(make_float3(0.3f, -0.8f, -0.5f));

float3 lambert_direction(uint32_t i) {
    const uint4 w = words(i, 1);
    return bsdf_sample(BxdfRecord{}, tilted, uniform_float(w.x), uniform_float(w.y)).wi;
}

TEST(Lambert, SamplesItsDensity) {
    EXPECT_GT(direction_p(lambert_direction, [](float3 w) { return static_cast<double>(bsdf_pdf(tilted, w)); }, tilted), level);
}

TEST(Lambert, PlantedErrorOfTwoPercentIsRejected) {
    const auto wrong = [](float3 w) {  // cos^1.02, normalised
        return 2.02 / (2.0 * pi) * std::pow(std::max(static_cast<double>(dot(w, tilted)), 0.0), 1.02);
    };
    EXPECT_LT(direction_p(lambert_direction, wrong, tilted), level);
}

TEST(Lambert, SampleAgreesWithEvaluateAndPdf) {
    BxdfRecord material{};
    std::copy_n(std::array{0.25f, 0.5f, 0.75f}.data(), 3, material.weight);
    for (uint32_t i = 0; i < 1000; ++i) {
        const uint4 w = words(i, 2);
        const BsdfSample sample = bsdf_sample(material, tilted, uniform_float(w.x), uniform_float(w.y));
        const float cosine = dot(tilted, sample.wi);
        ASSERT_GT(cosine, 0.0f);
        EXPECT_NEAR(length(sample.wi), 1.0f, 1e-6f);
        EXPECT_NEAR(sample.pdf_w, bsdf_pdf(tilted, sample.wi), 1e-6f);
        const float3 f = bsdf_evaluate(material, tilted, sample.wi);
        EXPECT_NEAR(f.y * cosine / sample.pdf_w, sample.weight.y, 2e-6f / cosine);
    }
}

// White furnace: the albedo is the reflectance, from every side.
TEST(Lambert, ReflectsItsAlbedo) {
    BxdfRecord material{};
    std::copy_n(std::array{0.25f, 0.5f, 1.0f}.data(), 3, material.weight);
    const auto reflected = [&](double z, double) {
        const auto w = make_float3(static_cast<float>(std::sqrt(1 - z * z)), 0.0f, static_cast<float>(z));
        return static_cast<double>(bsdf_evaluate(material, make_float3(0, 0, 1), w).z) * z;
    };
    EXPECT_NEAR(integrate(reflected, 0, 1, 0, 2 * pi), 1.0, 1e-3);
    EXPECT_EQ(bsdf_evaluate(material, tilted, -tilted).x, 0.0f);
}

TEST(Frame, IsOrthonormalInAllDirections) {
    for (uint32_t i = 0; i < 10000; ++i) {
        const uint4 w = words(i, 3);
        const float z = 2.0f * uniform_float(w.x) - 1.0f;
        const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
        const float3 n = i == 0   ? make_float3(0, 0, -1)
                         : i == 1 ? make_float3(0, 0, 1)
                                  : normalize(make_float3(r * cospi(2 * uniform_float(w.y)), r * sinpi(2 * uniform_float(w.y)), z));
        const Frame f = frame_from_z(n);
        EXPECT_NEAR(dot(f.x, f.y), 0.0f, 1e-6f);
        EXPECT_NEAR(dot(f.x, f.z), 0.0f, 1e-6f);
        EXPECT_NEAR(length(f.x), 1.0f, 1e-6f);
        EXPECT_NEAR(dot(cross(f.x, f.y), f.z), 1.0f, 1e-6f);
    }
}

TEST(SelectionTable, ProbabilitiesAreThoseOfTheWords) {
    const SelectionTable table = selection_table({0.0, 1.0, 2.0, 0.0, 5.0, 1e-20, 0.0});
    double sum = 0, previous = 0;
    for (size_t i = 0; i < table.end.size(); ++i) {
        const double end = i + 1 == table.end.size() ? 0x1p32 : table.end[i];
        EXPECT_EQ(table.probability[i], (end - previous) * 0x1p-32);
        previous = end;
        sum += table.probability[i];
    }
    EXPECT_EQ(sum, 1.0);
    EXPECT_EQ(table.probability[0], 0.0);
    EXPECT_NEAR(table.probability[4], 5.0 / 8.0, 1e-9);
}

/// Two mesh lights of two and three triangles with unequal areas.
struct Lights {
    std::vector<LightRecord> lights;
    std::vector<EmitterTriangle> emitters;
    std::vector<SurfaceTriangle> surfaces;
    std::vector<double> area;

    Lights() {
        const std::array<int, 2> counts = {2, 3};
        const SelectionTable selection = selection_table({1.0, 2.0});
        for (uint32_t k = 0; k < 2; ++k) {
            std::vector<double> areas;
            for (int i = 0; i < counts[k]; ++i) {
                areas.push_back(0.5 * (i + 1) * 2.0);
            }
            const SelectionTable table = selection_table(areas);
            const auto first = static_cast<uint32_t>(emitters.size());
            for (int i = 0; i < counts[k]; ++i) {
                const auto x = static_cast<float>(surfaces.size() * 10);
                surfaces.push_back({{x, 0, 0}, 0, {x + static_cast<float>(i + 1), 0, 0}, static_cast<uint32_t>(emitters.size()), {x, 2, 0}, 3, {0, 0, 1}, 0});
                emitters.push_back({static_cast<uint32_t>(surfaces.size() - 1), k, table.end[static_cast<size_t>(i)],
                                    static_cast<float>(table.probability[static_cast<size_t>(i)] / areas[static_cast<size_t>(i)])});
                area.push_back(areas[static_cast<size_t>(i)]);
            }
            LightRecord light{};
            light.selection = static_cast<float>(selection.probability[k]);
            light.selection_end = selection.end[k];
            light.first_triangle = first;
            light.triangle_count = static_cast<uint32_t>(counts[k]);
            lights.push_back(light);
        }
    }

    /// p-value over triangles and, within each, four parts of equal area.
    double p(double planted) const {
        std::vector<uint64_t> observed(surfaces.size() * 4);
        for (uint32_t i = 0; i < sample_count; ++i) {
            const LightSample s = sample_light_point(lights.data(), emitters.data(), surfaces.data(), 2, words(i, 5));
            const auto triangle = static_cast<size_t>(s.point.position.x / 10.0f + 1e-4f);
            const SurfaceTriangle &t = surfaces[triangle];
            const float u = (s.point.position.x - t.p0[0]) / (t.p1[0] - t.p0[0]);
            const float v = s.point.position.y / 2.0f;
            const size_t part = u > 0.5f ? 1 : v > 0.5f ? 2 : u + v < 0.5f ? 0 : 3;  // of the medial subdivision
            ++observed[triangle * 4 + part];
        }
        std::vector<double> expected(observed.size());
        for (size_t i = 0; i < expected.size(); ++i) {
            const EmitterTriangle &e = emitters[i / 4];
            const double error = i / 4 == 4 ? 1.0 + planted : 1.0;
            expected[i] = sample_count * static_cast<double>(light_pdf_a(lights[e.light], e)) * area[i / 4] / 4.0 * error;
        }
        return chi_square_p(observed, expected);
    }
};

TEST(AreaLight, SamplesItsDensity) { EXPECT_GT(Lights().p(0.0), level); }

TEST(AreaLight, PlantedErrorOfTwoPercentIsRejected) { EXPECT_LT(Lights().p(0.02), level); }

TEST(Camera, RaysHitTheCornersOfTheFieldOfView) {
    CameraArrays cameras;
    cameras.name = {"camera"};
    cameras.world_from_camera = {Eigen::Matrix4d::Identity()};
    cameras.fov = {pi / 2};
    cameras.aperture_radius = {0};
    cameras.focus_distance = {1};
    using Axis = CameraArrays::FovAxis;
    // A film of 40 x 20 pixels; tan of half the field is 1 along the named axis.
    for (const auto &[axis, x, y] : {std::tuple(Axis::x, 1.0f, 0.5f), std::tuple(Axis::y, 2.0f, 1.0f),
                                     std::tuple(Axis::smaller, 2.0f, 1.0f), std::tuple(Axis::larger, 1.0f, 0.5f)}) {
        cameras.fov_axis = {axis};
        const CameraRecord camera = compile_camera(cameras, 0, 40, 20);
        const float3 corner = camera_direction(camera, 0, 0);  // top left
        EXPECT_NEAR(corner.x / -corner.z, -x, 1e-6f);
        EXPECT_NEAR(corner.y / -corner.z, y, 1e-6f);
        const float3 centre = camera_direction(camera, 20, 10);
        EXPECT_NEAR(centre.z, -1.0f, 1e-6f);
        EXPECT_NEAR(camera.pixel_area, x * 2 / 40 * y * 2 / 20, 1e-6f);
    }
}

TEST(PowerHeuristic, StaysInRangeAndSumsToOne) {
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float beta : {1.0f, 2.0f, 3.5f}) {
        for (const float ratio : {0.0f, 1e-38f, 0.1f, 1.0f, 7.0f, 1e38f, infinity}) {
            const float one = power_heuristic(ratio, beta);
            const float other = power_heuristic(1.0f / ratio, beta);
            EXPECT_NEAR(one + other, 1.0f, 1e-6f) << ratio;
        }
    }
}

}  // namespace
}  // namespace rtrays
