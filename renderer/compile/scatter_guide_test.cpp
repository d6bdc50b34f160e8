// SPDX-License-Identifier: MIT
// Tests the builder of scatter guides: cells, tables, extreme hits, and what is left out.
#include "renderer/compile/scatter_guide.h"

#include <gtest/gtest.h>

// Must precede all device code.
#include "testing/all_features.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <random>

#include "renderer/import/json/scene_json.h"
#include "renderer/kernels/bsdf/guided_scattering.h"

namespace rtrays {
namespace {

float3 position_of(const TrainingHit &hit) {
    return make_float3(hit.position[0], hit.position[1], hit.position[2]);
}

TrainingHit hit_at(float x, float y, float z, uint32_t side, uint32_t bin, float power = 1) {
    return {{x, y, z}, power, side, bin};
}

/// Returns hits on some sides of a surface that extends differently along the axes.
std::vector<TrainingHit> random_hits(size_t count, uint32_t sides, float scale = 1) {
    std::mt19937 random(3);
    const auto below = [&](uint32_t n) { return static_cast<uint32_t>(random() % n); };
    const auto uniform = [&](float end) {
        return end * (static_cast<float>(below(1u << 20)) * 0x1p-20f);
    };
    std::vector<TrainingHit> hits(count);
    for (TrainingHit &hit : hits) {
        const float extents[3] = {scale, 5 * scale, 0.1f * scale};
        std::transform(extents, extents + 3, hit.position, uniform);
        hit.power = uniform(1) + 0.1f;
        hit.side = below(sides);
        hit.bin = below(GUIDE_BINS);
    }
    return hits;
}

uint32_t cell_of(const ScatterGuide &guide, const TrainingHit &hit) {
    return guide_cell(guide.words.data(), position_of(hit), hit.side);
}

double probability(const ScatterGuide &guide, uint32_t table, uint32_t bin) {
    const GuideBin place = {bin / GUIDE_COLUMNS, bin % GUIDE_COLUMNS};
    return static_cast<double>(guide_bin_density(guide.words.data(), table, place)) / GUIDE_BINS;
}

double total(const ScatterGuide &guide, uint32_t table) {
    double sum = 0;
    for (uint32_t bin = 0; bin < GUIDE_BINS; ++bin) {
        const double of_bin = probability(guide, table, bin);
        EXPECT_GT(of_bin, 0.04 / GUIDE_BINS);
        sum += of_bin;
    }
    return sum;
}

TEST(ScatterGuide, NeedsAMirrorAndADiffuseSurface) {
    const auto is_guidable = [](const std::string &materials) {
        std::string nodes;
        for (const char name : materials) {
            nodes += fmt::format(
                R"({{"name": "{0}", "geometry": {{"type": "disc"}}, "material": "{0}"}},)", name);
        }
        return is_scatter_guidable(compile_scene(
            parse_scene_json(
                R"({"version": 1, "film": {"width": 1, "height": 1}, "materials": {
                "d": {"type": "lambert", "reflectance": [0.5, 0.5, 0.5]},
                "m": {"type": "mirror", "reflectance": [0.5, 0.5, 0.5]},
                "g": {"type": "glass", "eta": 1.5}},
                "nodes": [)" +
                    nodes +
                    R"({"name": "camera", "camera": {"type": "pinhole", "fov": 40, "fov_axis": "x"}},
                    {"name": "lamp", "light": {"type": "point", "intensity": [1, 1, 1]}}]})",
                "materials", "materials"),
            {}));
    };
    EXPECT_TRUE(is_guidable("dm"));
    EXPECT_TRUE(is_guidable("dg"));
    EXPECT_FALSE(is_guidable("d"));
    EXPECT_FALSE(is_guidable("mg"));
}

TEST(ScatterGuide, DividesTheHitsOfASideIntoCellsOfSimilarNumbers) {
    const std::vector<TrainingHit> hits = random_hits(20'000, GUIDE_SIDES);
    const ScatterGuide guide = make_scatter_guide(hits);
    std::map<uint32_t, size_t> hits_of_cell;
    for (const TrainingHit &hit : hits) {
        ++hits_of_cell[cell_of(guide, hit)];
    }
    EXPECT_GT(hits_of_cell.size(), 20'000u / 64);
    for (const auto &[table, count] : hits_of_cell) {
        ASSERT_NE(table, NO_GUIDE_TABLE);
        EXPECT_GE(count, 32u);
        EXPECT_LT(count, 64u);
        EXPECT_NEAR(total(guide, table), 1, 1e-5);
    }
}

// All light of a cell comes from one bin, or from two with different powers.
TEST(ScatterGuide, SmoothsThePowerOverNeighbouringBins) {
    const uint32_t row = 5, bin = row * GUIDE_COLUMNS, other = 9 * GUIDE_COLUMNS + 20;
    std::vector<TrainingHit> hits;
    for (int i = 0; i < 20; ++i) {
        hits.push_back(hit_at(0, static_cast<float>(i), 0, 3, bin, 3));
        hits.push_back(hit_at(0, static_cast<float>(i), 0, 3, other, 1));
    }
    const ScatterGuide guide = make_scatter_guide(hits);
    const uint32_t table = cell_of(guide, hits[0]);
    ASSERT_NE(table, NO_GUIDE_TABLE);
    const auto expect = [&](uint32_t at, double share) {
        EXPECT_NEAR(probability(guide, table, at), 0.95 * share + 0.05 / GUIDE_BINS, 1e-6) << at;
    };
    expect(bin, 0.75 / 4);
    expect(bin + 1, 0.75 / 8);
    expect(bin + GUIDE_COLUMNS - 1, 0.75 / 8);  // the last column is next to the first
    expect(bin - GUIDE_COLUMNS, 0.75 / 8);
    expect(bin + GUIDE_COLUMNS + 1, 0.75 / 16);
    expect(other, 0.25 / 4);
    expect(other + 2, 0);
}

TEST(ScatterGuide, KeepsSidesApart) {
    const std::vector<TrainingHit> hits = random_hits(1000, 2);
    const ScatterGuide guide = make_scatter_guide(hits);
    for (uint32_t side = 0; side < GUIDE_SIDES; ++side) {
        EXPECT_EQ(guide_cell(guide.words.data(), position_of(hits[0]), side) != NO_GUIDE_TABLE,
                  side < 2)
            << side;
    }
    // Normals on the edge of two sides belong to one of them.
    const std::pair<float3, uint32_t> normals[] = {{make_float3(1, 0, 0), 0},
                                                   {make_float3(-0.8f, 0.6f, 0), 1},
                                                   {make_float3(0.1f, 0.9f, -0.2f), 2},
                                                   {make_float3(0, -1, 0), 3},
                                                   {make_float3(0, 0, 1), 4},
                                                   {make_float3(0.5f, 0.5f, -0.7f), 5},
                                                   {make_float3(0, 0, 0), 4}};
    for (const auto &[normal, side] : normals) {
        EXPECT_EQ(guide_side(normal), side);
    }
    EXPECT_LT(guide_side(make_float3(0.6f, -0.6f, 0.6f)), GUIDE_SIDES);
}

TEST(ScatterGuide, HasNoTableWithFewHits) {
    for (const size_t count : {0, 15, 16}) {
        const ScatterGuide guide = make_scatter_guide(random_hits(count, 1));
        for (uint32_t side = 0; side < GUIDE_SIDES; ++side) {
            EXPECT_EQ(guide_cell(guide.words.data(), make_float3(0, 0, 0), side) != NO_GUIDE_TABLE,
                      side == 0 && count == 16);
        }
    }
}

// Places of any size, hits that are all at one place, and powers whose squares overflow or vanish.
TEST(ScatterGuide, BearsExtremeHits) {
    for (const float scale : {1e-38f, 1e-20f, 1e20f, 6e37f}) {
        std::vector<TrainingHit> hits = random_hits(2000, 1, scale);
        for (size_t i = 0; i < hits.size(); ++i) {
            hits[i].power = i % 3 == 0 ? 1e-38f : i % 3 == 1 ? 1e-10f : 3e38f;
        }
        const ScatterGuide guide = make_scatter_guide(hits);
        for (const TrainingHit &hit : hits) {
            const uint32_t table = cell_of(guide, hit);
            ASSERT_NE(table, NO_GUIDE_TABLE) << scale;
            ASSERT_NEAR(total(guide, table), 1, 1e-5) << scale;
        }
    }
    const std::vector<TrainingHit> same(5000, hit_at(1, 2, 3, 4, 77));
    const ScatterGuide guide = make_scatter_guide(same);
    EXPECT_EQ(guide.words.size(), GUIDE_SIDES * (1 + GUIDE_NODE_WORDS) + GUIDE_TABLE_WORDS);
    EXPECT_NEAR(total(guide, cell_of(guide, same[0])), 1, 1e-5);
}

TEST(ScatterGuide, LeavesOutHitsThatAreNotFiniteOrHaveNoPower) {
    std::vector<TrainingHit> hits = random_hits(300, 1);
    const ScatterGuide expected = make_scatter_guide(hits);
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float power : {0.0f, -1.0f, infinity, std::nanf("")}) {
        hits.insert(hits.begin() + 100, hit_at(0, 0, 0, 0, 3, power));
    }
    hits.push_back(hit_at(std::nanf(""), 0, 0, 0, 3));
    hits.push_back(hit_at(0, infinity, 0, 0, 3));
    EXPECT_EQ(make_scatter_guide(hits).words, expected.words);
}

TEST(ScatterGuide, HasABoundOfItsSize) {
    const ScatterGuide guide = make_scatter_guide(random_hits(400'000, GUIDE_SIDES));
    EXPECT_LE(guide.words.size(), 4096u * (GUIDE_TABLE_WORDS + 2 * GUIDE_NODE_WORDS) + 100);
    EXPECT_GT(guide.words.size(), 2048u * GUIDE_TABLE_WORDS);
}

}  // namespace
}  // namespace rtrays
