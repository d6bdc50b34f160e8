// SPDX-License-Identifier: MIT
// Tests guided scattering, with the device code compiled for the host: directions against their
// density, and weights against those of the material.
//
// Two chi-square tests share a family-wise level of 0.01 (Cells).
#include <gtest/gtest.h>

#include "renderer/testing/bsdf_cases.h"

#include "renderer/compile/guide_table.h"
#include "renderer/kernels/bsdf/guided_scattering.h"
#include "renderer/testing/emission_cells.h"

namespace rtrays {
namespace {

constexpr uint32_t sample_count = 1'000'000;

/// A guide with one table, whose bins differ by up to three orders of magnitude, and a material.
struct Guided {
    TestMaterial material;
    std::vector<uint32_t> guide = std::vector<uint32_t>(1);
    uint32_t table = 0;
    MaterialRecord record;

    explicit Guided(TestMaterial of) : material(std::move(of)), record(material.record()) {
        std::vector<double> bins;
        for (uint32_t bin = 0; bin < GUIDE_BINS; ++bin) {
            bins.push_back(std::exp(7.0 * ((bin * 37u) % 101) / 101));
        }
        table = append_guide_table(bins, guide);
    }

    SceneView view() const {
        SceneView scene{};
        scene.materials = &record;
        scene.components = material.components.data();
        scene.scatter_guide = guide.data();
        return scene;
    }
};

/// Returns a frame whose normal is the z axis, so that the horizon is an edge of bins.
SurfaceFrame upright_frame() {
    const float3 up = make_float3(0, 0, 1);
    return make_surface_frame(up, up, make_float3(1, 0, 0), make_float2(0, 0),
                              normalize(make_float3(0.5f, -0.3f, 0.7f)));
}

/// Returns the probability of each bin: the integral of the density, by the midpoints of a grid.
std::vector<double> bin_probabilities(const Guided &guided, const SurfaceFrame &frame) {
    constexpr uint32_t across = 32;
    const SceneView scene = guided.view();
    std::vector<double> bins(GUIDE_BINS);
    for (uint32_t i = 0; i < GUIDE_ROWS * across; ++i) {
        for (uint32_t j = 0; j < GUIDE_COLUMNS * across; ++j) {
            const float3 wi =
                sample_uniform_sphere((static_cast<float>(i) + 0.5f) / (GUIDE_ROWS * across),
                                      (static_cast<float>(j) + 0.5f) / (GUIDE_COLUMNS * across));
            const float pdf_w = bsdf_evaluate(&scene, 0, frame, wi).pdf_w;
            bins[i / across * GUIDE_COLUMNS + j / across] +=
                static_cast<double>(guided_pdf_w(&scene, guided.table, pdf_w, wi)) * 4 * pi /
                (GUIDE_BINS * across * across);
        }
    }
    return bins;
}

uint4 words_of(uint32_t i) {
    return random_words(17, STREAM_CAMERA, i, 0, 0);
}

// Diffuse, and diffuse under a smooth coat, whose delta is sampled too.
TEST(GuidedScattering, FollowsItsDensity) {
    for (const TestMaterial &material :
         {TestMaterial{"lambert", {component(BXDF_LAMBERT)}}, car_paint(false)}) {
        const Guided guided(material);
        const SurfaceFrame frame = upright_frame();
        const SceneView scene = guided.view();
        std::vector<double> probability = bin_probabilities(guided, frame);
        std::vector<size_t> counts(GUIDE_BINS + 2);
        double delta_probability = 0;
        for (uint32_t i = 0; i < sample_count; ++i) {
            float by_material = 0;
            const BsdfSample sample =
                sample_guided(&scene, 0, frame, guided.table, words_of(i), &by_material);
            if (!(sample.pdf_w > 0)) {
                ++counts[GUIDE_BINS];
            } else if (std::isinf(sample.pdf_w)) {
                ++counts[GUIDE_BINS + 1];
                delta_probability = static_cast<double>(sample.probability);
            } else {
                const GuideBin bin = sphere_bin(sample.wi);
                ++counts[bin.row * GUIDE_COLUMNS + bin.column];
                const float pdf_w = bsdf_evaluate(&scene, 0, frame, sample.wi).pdf_w;
                EXPECT_NEAR(sample.pdf_w, guided_pdf_w(&scene, guided.table, pdf_w, sample.wi),
                            1e-4f * sample.pdf_w);
                EXPECT_NEAR(by_material * sample.pdf_w, pdf_w, 1e-5f * pdf_w);
                EXPECT_LE(by_material, 1.0f / (1.0f - GUIDE_SHARE));
            }
        }
        double lost = 1 - delta_probability;
        for (const double of_bin : probability) {
            lost -= of_bin;
        }
        EXPECT_GT(lost, 0.01) << "directions below the horizon";
        probability.push_back(lost);
        if (delta_probability > 0) {
            probability.push_back(delta_probability);
        }
        Cells cells(probability);
        for (size_t cell = 0; cell < probability.size(); ++cell) {
            cells.observed[cell] = counts[cell];
        }
        cells.samples = sample_count;
        cells.expect_fit(material.name);
    }
}

// The mean of the weights is the albedo, whatever the guide.
TEST(GuidedScattering, KeepsTheMeanOfTheWeights) {
    for (const TestMaterial &material :
         {TestMaterial{"lambert", {weighted(component(BXDF_LAMBERT), 0.7f)}},
          TestMaterial{"oren_nayar", {oren_nayar(0.6f)}}, car_paint(false)}) {
        const Guided guided(material);
        const SurfaceFrame frame = upright_frame();
        const SceneView scene = guided.view();
        struct {
            double sum = 0, squares = 0;
        } of[2];
        for (uint32_t i = 0; i < sample_count; ++i) {
            for (const uint32_t table : {NO_GUIDE_TABLE, guided.table}) {
                float by_material = 0;
                const BsdfSample sample =
                    sample_guided(&scene, 0, frame, table, words_of(i), &by_material);
                const double weight = sample.pdf_w > 0 ? static_cast<double>(sample.weight.y) : 0.0;
                auto &estimate = of[table == NO_GUIDE_TABLE ? 0 : 1];
                estimate.sum += weight;
                estimate.squares += weight * weight;
                if (table == NO_GUIDE_TABLE) {
                    EXPECT_EQ(by_material, 1.0f);
                }
            }
        }
        const auto mean = [&](int i) { return of[i].sum / sample_count; };
        const auto error = [&](int i) {
            return std::sqrt(std::max(of[i].squares / sample_count - mean(i) * mean(i), 0.0) /
                             sample_count);
        };
        EXPECT_NEAR(mean(1), mean(0), 4 * std::hypot(error(0), error(1)) + 1e-6) << material.name;
        EXPECT_LT(error(1), 0.002 * mean(1)) << "statistical power";
    }
}

}  // namespace
}  // namespace rtrays
