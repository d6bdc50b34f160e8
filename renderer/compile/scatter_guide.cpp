// SPDX-License-Identifier: MIT
#include "renderer/compile/scatter_guide.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "renderer/compile/guide_table.h"

namespace rtrays {

namespace {

/// Least number of hits of a cell that is one of two halves.
constexpr size_t hits_of_half = 32;
/// Least number of hits of a cell with a table.
constexpr size_t hits_of_table = 16;
constexpr size_t most_cells = 4096;

/// Share of a table that does not follow the hits.
constexpr double uniform_share = 0.05;

using Hits = std::vector<TrainingHit>;
using HitIterator = Hits::iterator;

bool is_usable(const TrainingHit &hit) {
    return hit.power > 0 && std::isfinite(hit.power) &&
           std::all_of(std::begin(hit.position), std::end(hit.position),
                       [](float x) { return std::isfinite(x); });
}

std::vector<double> bins_of(HitIterator begin, HitIterator end) {
    std::vector<double> bins(GUIDE_BINS);
    double sum = 0;
    for (HitIterator hit = begin; hit != end; ++hit) {
        for_each_bin_around(hit->bin, [&](size_t bin, double weight) {
            const double power = weight * static_cast<double>(hit->power);
            bins[bin] += power;
            sum += power;
        });
    }
    for (double &bin : bins) {
        bin = (1.0 - uniform_share) * (bin / sum) + uniform_share / GUIDE_BINS;
    }
    return bins;
}

/// Builds the trees of a guide.
class TreeBuilder {
  public:
    explicit TreeBuilder(size_t hits)
        : least_half_(std::max(hits_of_half, (hits + most_cells - 1) / most_cells)) {
        guide_.words.resize(GUIDE_SIDES);
    }

    void add_side(uint32_t side, HitIterator begin, HitIterator end) {
        const uint32_t root = add_nodes(1);
        guide_.words[side] = root;
        build(root, begin, end);
    }

    ScatterGuide take() { return std::move(guide_); }

  private:
    uint32_t add_nodes(size_t count) {
        const auto first = static_cast<uint32_t>(guide_.words.size());
        guide_.words.resize(first + count * GUIDE_NODE_WORDS);
        return first;
    }

    void link(uint32_t node, uint32_t target, uint32_t axis) {
        guide_.words[node] = target << GUIDE_LINK_BITS | axis;
    }

    /// Each level halves the hits, so that no tree is deep.
    void build(uint32_t node, HitIterator begin, HitIterator end) {
        const auto count = static_cast<size_t>(end - begin);
        if (count < hits_of_table) {
            return link(node, NO_GUIDE_TABLE, GUIDE_LEAF);
        }
        const uint32_t axis = longest_axis(begin, end);
        if (count < 2 * least_half_ || axis == GUIDE_LEAF) {
            return link(node, append_guide_table(bins_of(begin, end), guide_.words), GUIDE_LEAF);
        }
        const HitIterator middle = begin + static_cast<std::ptrdiff_t>(count / 2);
        std::nth_element(begin, middle, end, [axis](const TrainingHit &a, const TrainingHit &b) {
            return a.position[axis] < b.position[axis];
        });
        const uint32_t first = add_nodes(2);
        link(node, first, axis);
        std::memcpy(&guide_.words[node + 1], &middle->position[axis], sizeof(float));
        build(first, begin, middle);
        build(first + GUIDE_NODE_WORDS, middle, end);
    }

    /// Returns the axis along which hits extend farthest; GUIDE_LEAF if all are at one place.
    static uint32_t longest_axis(HitIterator begin, HitIterator end) {
        uint32_t longest = GUIDE_LEAF;
        double extent = 0;
        for (uint32_t axis = 0; axis < 3; ++axis) {
            const auto [low, high] =
                std::minmax_element(begin, end, [axis](const TrainingHit &a, const TrainingHit &b) {
                    return a.position[axis] < b.position[axis];
                });
            const double size = static_cast<double>(high->position[axis]) -
                                static_cast<double>(low->position[axis]);
            if (size > extent) {
                extent = size;
                longest = axis;
            }
        }
        return longest;
    }

    ScatterGuide guide_;
    size_t least_half_;
};

}  // namespace

bool is_scatter_guidable(const CompiledScene &scene) {
    return scene.features.has(Feature::delta) && scene.features.has(Feature::lights) &&
           std::any_of(scene.materials.begin(), scene.materials.end(),
                       [](const MaterialRecord &material) {
                           return (material.flags & MATERIAL_GUIDED) != 0;
                       });
}

ScatterGuide make_scatter_guide(const std::vector<TrainingHit> &hits) {
    std::array<Hits, GUIDE_SIDES> by_side;
    size_t count = 0;
    for (const TrainingHit &hit : hits) {
        if (is_usable(hit)) {
            by_side.at(hit.side).push_back(hit);
            ++count;
        }
    }
    TreeBuilder builder(count);
    for (uint32_t side = 0; side < GUIDE_SIDES; ++side) {
        builder.add_side(side, by_side[side].begin(), by_side[side].end());
    }
    return builder.take();
}

}  // namespace rtrays
