// SPDX-License-Identifier: MIT
// Tests the builder of emission guides: exact tables, extreme moments, and what it rejects.
#include "renderer/compile/emission_guide.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "renderer/compile/guide_table.h"
#include "renderer/testing/errors.h"

namespace rtrays {
namespace {

/// Returns a scene with point lights of given probabilities.
CompiledScene point_lights(const std::vector<double> &probabilities) {
    CompiledScene scene;
    const SelectionTable table = selection_table(probabilities);
    for (const uint32_t end : table.end) {
        LightRecord light{};
        light.kind = LIGHT_POINT;
        light.selection_end = end;
        scene.lights.push_back(light);
    }
    return scene;
}

/// Returns the number of words of entry `i` of a table of `count` ends from `first` on.
double words_of(const EmissionGuide &guide, size_t first, size_t count, size_t i) {
    const double begin = i == 0 ? 0.0 : guide.words.at(first + i - 1);
    return (i + 1 == count ? 0x1p32 : static_cast<double>(guide.words.at(first + i))) - begin;
}

double selection(const EmissionGuide &guide, size_t lights, size_t light) {
    return words_of(guide, 0, lights, light) * 0x1p-32;
}

/// Returns the probability of a bin, given its light.
double probability(const EmissionGuide &guide, size_t lights, size_t light, size_t bin) {
    const size_t table = guide.words.at(lights + light), row = bin / GUIDE_COLUMNS;
    return words_of(guide, table, GUIDE_ROWS, row) *
           words_of(guide, table + GUIDE_ROWS + row * GUIDE_COLUMNS, GUIDE_COLUMNS,
                    bin % GUIDE_COLUMNS) *
           0x1p-64;
}

/// Returns moments that are 0, except for one bin of the first light.
EmissionMoments one_bin(const CompiledScene &scene, size_t bin, double moment) {
    EmissionMoments moments(scene.lights.size(), std::vector<double>(GUIDE_BINS));
    moments[0][bin] = moment;
    return moments;
}

constexpr double tolerance = 1e-8;  // a few words out of those of a row

TEST(EmissionGuide, IsExactIfFlat) {
    const CompiledScene scene = point_lights({0.7, 0.1, 0.2});
    const EmissionGuide guide = flat_guide(scene);
    ASSERT_EQ(guide.words.size(), 6 + 3 * GUIDE_TABLE_WORDS);
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(guide.words[i], scene.lights[i].selection_end);
        const size_t table = guide.words[3 + i];
        EXPECT_EQ(table, 6 + i * GUIDE_TABLE_WORDS);
        for (size_t row = 0; row < GUIDE_ROWS; ++row) {
            EXPECT_EQ(words_of(guide, table, GUIDE_ROWS, row), 0x1p28);
        }
        for (size_t column = 0; column < GUIDE_COLUMNS; ++column) {
            EXPECT_EQ(words_of(guide, table + GUIDE_ROWS, GUIDE_COLUMNS, column), 0x1p27);
        }
    }
    EXPECT_NO_THROW(require_guide_for(scene, guide));
    EXPECT_TRUE(flat_guide(CompiledScene()).words.empty());
}

TEST(EmissionGuide, KeepsAQuarterOfTheUniformTable) {
    const CompiledScene scene = point_lights({0.5, 0.5});
    for (const size_t full : {size_t{0}, size_t{77}, size_t{GUIDE_BINS - 1}}) {
        // The smallest number, and one whose square overflows.
        for (const double moment :
             {1.0, std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max()}) {
            const EmissionGuide guide = make_guide(scene, one_bin(scene, full, moment));
            EXPECT_EQ(guide.words, make_guide(scene, one_bin(scene, full, 3.0)).words);
            double sum = 0;
            for (size_t bin = 0; bin < GUIDE_BINS; ++bin) {
                const double expected = (bin == full ? 0.75 : 0.0) + 0.25 / GUIDE_BINS;
                EXPECT_NEAR(probability(guide, 2, 0, bin), expected, tolerance);
                EXPECT_NEAR(probability(guide, 2, 1, bin), 1.0 / GUIDE_BINS, tolerance)
                    << "a light that no path leaves towards the camera";
                sum += probability(guide, 2, 0, bin);
            }
            EXPECT_DOUBLE_EQ(sum, 1.0);
            EXPECT_NEAR(selection(guide, 2, 0), 0.875, tolerance);
            EXPECT_NEAR(selection(guide, 2, 1), 0.125, tolerance);
            EXPECT_NO_THROW(require_guide_for(scene, guide));
        }
    }
}

TEST(EmissionGuide, FollowsTheRootsOfTheMoments) {
    const CompiledScene scene = point_lights({0.2, 0.2, 0.6});
    EmissionMoments moments(3);
    moments[0].assign(GUIDE_BINS, 9.0);
    moments[1].assign(GUIDE_BINS, 1.0);
    for (size_t bin = 0; bin < GUIDE_BINS / 2; ++bin) {
        moments[1][bin] = 49.0;
    }
    const EmissionGuide guide = make_guide(scene, moments);
    // Roots 3 against (7 + 1) / 2 = 4, of the 0.4 that both have together.
    EXPECT_NEAR(selection(guide, 3, 0), 0.75 * 0.4 * 3 / 7 + 0.25 * 0.2, tolerance);
    EXPECT_NEAR(selection(guide, 3, 1), 0.75 * 0.4 * 4 / 7 + 0.25 * 0.2, tolerance);
    EXPECT_NEAR(selection(guide, 3, 2), 0.6, tolerance) << "nothing is known of it";
    EXPECT_NEAR(probability(guide, 3, 0, 5), 1.0 / GUIDE_BINS, tolerance);
    EXPECT_NEAR(probability(guide, 3, 1, 5), (0.75 * 7 / 4 + 0.25) / GUIDE_BINS, tolerance);
    EXPECT_NEAR(probability(guide, 3, 1, 500), (0.75 * 1 / 4 + 0.25) / GUIDE_BINS, tolerance);
    EXPECT_NEAR(probability(guide, 3, 2, 5), 1.0 / GUIDE_BINS, tolerance);
}

TEST(EmissionGuide, IsFlatIfNothingArrives) {
    const CompiledScene scene = point_lights({0.7, 0.3});
    const std::vector<uint32_t> flat = flat_guide(scene).words;
    EXPECT_EQ(make_guide(scene, one_bin(scene, 0, 0.0)).words, flat);
    EXPECT_EQ(make_guide(scene, EmissionMoments(2)).words, flat);
    EmissionMoments huge(2, std::vector<double>(GUIDE_BINS, std::numeric_limits<double>::max()));
    const EmissionGuide guide = make_guide(scene, huge);
    EXPECT_NEAR(probability(guide, 2, 0, 3), 1.0 / GUIDE_BINS, tolerance);
    EXPECT_NEAR(selection(guide, 2, 0), 0.75 * 0.5 + 0.25 * 0.7, tolerance);
}

/// Returns a light path that found `value` in trial 2.
PathTrials path_from(uint32_t light, uint32_t bin, float value, float density) {
    PathTrials path{};
    path.value[2] = value;
    path.start = light * GUIDE_BINS + bin;
    path.start_density = density;
    return path;
}

TEST(EmissionGuide, IsTrainedByTheMeanSquaresOfPaths) {
    CompiledScene scene = point_lights({0.4, 0.4, 0.2});
    scene.lights[1].kind = LIGHT_SPOT;  // takes no table
    const std::vector<PathTrials> found = {path_from(0, 7, 6, 0.5f), path_from(0, 7, 2, 0.5f),
                                           path_from(0, 9, 0, 0.5f), path_from(1, 0, 3, 2)};
    const EmissionMoments moments = emission_moments(scene, found, 2);
    ASSERT_EQ(moments[0].size(), GUIDE_BINS);
    // Squares 9 and 1 in bin 7, 0 in bin 9. Their mean counts as 8 paths, that around a bin as
    // well.
    const double mean = 10.0 / 3;
    const auto expected = [&](double sum, double paths, double around, double paths_around) {
        return (sum + 8 * (around + 8 * mean) / (paths_around + 8)) / (paths + 8);
    };
    EXPECT_DOUBLE_EQ(moments[0][7], expected(10, 2, 10, 2));
    EXPECT_DOUBLE_EQ(moments[0][8], expected(0, 0, 5, 1.5));
    EXPECT_DOUBLE_EQ(moments[0][9], expected(0, 1, 0, 1));
    EXPECT_DOUBLE_EQ(moments[0][7 + GUIDE_COLUMNS - 1], expected(0, 0, 2.5, 0.5)) << "corner";
    EXPECT_DOUBLE_EQ(moments[0][100], mean);
    EXPECT_DOUBLE_EQ(moments[0][31], mean) << "no neighbours";
    ASSERT_EQ(moments[1].size(), 1u);
    EXPECT_DOUBLE_EQ(moments[1][0], 36);
    EXPECT_TRUE(moments[2].empty()) << "nothing is known of it";
    EXPECT_EQ(make_guide(scene, emission_moments(scene, found, 1)).words, flat_guide(scene).words)
        << "paths that found nothing";
    const EmissionMoments edge = emission_moments(scene, {path_from(0, 0, 3, 1)}, 2);
    EXPECT_DOUBLE_EQ(edge[0][31], edge[0][1]) << "the last column is beside the first";
    EXPECT_DOUBLE_EQ(edge[0][1], 9);
    EXPECT_EQ(make_guide(scene, emission_moments(scene, {}, 2)).words, flat_guide(scene).words);
}

// The smallest and the largest numbers, and those that are not finite.
TEST(EmissionGuide, IsTrainedByExtremePaths) {
    const CompiledScene scene = point_lights(std::vector<double>(64, 1.0));
    const auto guide_of = [&](float value) {
        std::vector<PathTrials> paths;
        for (uint32_t light = 0; light < 64; ++light) {
            for (uint32_t bin = 0; bin < GUIDE_BINS; ++bin) {
                paths.push_back(path_from(light, bin, light == 5 ? value : 0.0f, 0x1p-6f));
            }
        }
        return make_guide(scene, emission_moments(scene, paths, 2));
    };
    const EmissionGuide guide = guide_of(1);
    EXPECT_NEAR(selection(guide, 64, 5), 0.75 + 0.25 / 64, tolerance);
    EXPECT_NEAR(selection(guide, 64, 6), 0.25 / 64, tolerance);
    using Limits = std::numeric_limits<float>;
    EXPECT_EQ(guide_of(Limits::max()).words, guide.words);
    EXPECT_EQ(guide_of(Limits::denorm_min()).words, guide.words);
    EXPECT_EQ(guide_of(Limits::infinity()).words, flat_guide(scene).words);
    EXPECT_EQ(guide_of(Limits::quiet_NaN()).words, flat_guide(scene).words);
}

TEST(EmissionGuide, HasTablesForLightsThatTakeThem) {
    CompiledScene scene = point_lights({0.5, 0.5});
    scene.lights[0].kind = LIGHT_SPOT;
    EmissionMoments moments(2);
    moments[0] = {1.0};
    moments[1].assign(GUIDE_BINS, 1.0);
    const EmissionGuide guide = make_guide(scene, moments);
    EXPECT_EQ(guide.words.size(), 4 + GUIDE_TABLE_WORDS);
    EXPECT_EQ(guide.words[2], NO_GUIDE_TABLE);
    EXPECT_EQ(guide.words[3], 4u);
    EXPECT_NO_THROW(require_guide_for(scene, guide));

    // A mesh of two triangles, flat to rounding or bent, and one without area.
    CompiledScene mesh;
    mesh.surface_triangles.resize(3);
    mesh.emitter_triangles = {{0, 0, 0, 0}, {1, 0, 0, 0}, {2, 0, 0, 0}};
    mesh.lights.resize(1);
    mesh.lights[0].kind = LIGHT_MESH;
    mesh.lights[0].triangle_count = 3;
    mesh.lights[0].axis_z[0] = mesh.surface_triangles[0].normal[0] = 1;
    mesh.surface_triangles[1].normal[0] = 1;
    mesh.surface_triangles[1].normal[1] = 1e-7f;
    EXPECT_TRUE(takes_guide_table(mesh, 0));
    mesh.surface_triangles[1].normal[1] = 1e-3f;
    EXPECT_FALSE(takes_guide_table(mesh, 0));
    mesh.surface_triangles[1].normal[0] = -1;
    EXPECT_FALSE(takes_guide_table(mesh, 0));
    mesh.surface_triangles.assign(3, SurfaceTriangle{});
    mesh.lights[0].axis_z[0] = 0;
    EXPECT_FALSE(takes_guide_table(mesh, 0)) << "no triangle has a normal";
}

TEST(EmissionGuide, RejectsWhatItCannotUse) {
    const CompiledScene scene = point_lights({0.5, 0.5});
    for (const double moment : {-1.0, std::numeric_limits<double>::infinity(),
                                std::numeric_limits<double>::quiet_NaN()}) {
        expect_input_error("light 0 has the moment",
                           [&] { make_guide(scene, one_bin(scene, 3, moment)); });
    }
    expect_input_error("moments of 2 lights", [&] { make_guide(scene, EmissionMoments(3)); });
    expect_input_error("light 1 has 7 moments", [&] {
        make_guide(scene, {{}, std::vector<double>(7)});
    });
    const CompiledScene many = point_lights(std::vector<double>(most_guided_lights + 1, 1.0));
    EXPECT_FALSE(supports_guide(many));
    expect_input_error("65 lights, and at most 64", [&] { flat_guide(many); });
    expect_input_error("65 lights, and at most 64", [&] { make_guide(many, EmissionMoments(65)); });
}

TEST(EmissionGuide, IsOneForItsScene) {
    const CompiledScene scene = point_lights({0.5, 0.5});
    const EmissionGuide guide = flat_guide(scene);
    EXPECT_NE(guide_hash(guide.words), guide_hash(make_guide(scene, one_bin(scene, 3, 1.0)).words));
    const auto reject = [&](const EmissionGuide &wrong) {
        expect_input_error("does not fit the lights", [&] { require_guide_for(scene, wrong); });
    };
    reject(flat_guide(point_lights({1.0})));
    reject(flat_guide(point_lights({0.2, 0.2, 0.6})));
    reject({});
    // A word too many, an unknown table, a last end, a bin without words.
    for (const auto &[word, value] :
         {std::pair(size_t{3}, 7u), std::pair(size_t{2}, NO_GUIDE_TABLE), std::pair(size_t{1}, 5u),
          std::pair(size_t{4}, 0u), std::pair(size_t{30}, guide.words[29])}) {
        EmissionGuide wrong = guide;
        wrong.words[word] = value;
        reject(wrong);
    }
    EmissionGuide longer = guide;
    longer.words.push_back(1);
    reject(longer);
    CompiledScene spot = scene;
    spot.lights[1].kind = LIGHT_SPOT;
    expect_input_error("does not fit the lights", [&] { require_guide_for(spot, guide); });
}

}  // namespace
}  // namespace rtrays
