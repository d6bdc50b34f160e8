// SPDX-License-Identifier: MIT
#include "renderer/compile/emission_guide.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "renderer/base/error.h"
#include "renderer/compile/guide_table.h"

namespace rtrays {

namespace {

/// Share of a probability that does not follow the moments, so that nothing loses more than a
/// factor of four.
constexpr double usual_share = 0.25;

/// Returns the probabilities with which light paths start at the lights without a guide.
std::vector<double> usual_selection(const CompiledScene &scene) {
    std::vector<double> probabilities;
    uint32_t begin = 0;
    for (const LightRecord &light : scene.lights) {
        const bool is_last = probabilities.size() + 1 == scene.lights.size();
        const double end = is_last ? 0x1p32 : static_cast<double>(light.selection_end);
        probabilities.push_back((end - begin) * 0x1p-32);
        begin = light.selection_end;
    }
    return probabilities;
}

/// Returns the guide with given probabilities of the lights. bins(i) are the weights of the bins of
/// light i, if it takes a table.
template <typename Bins>
EmissionGuide guide_of(const CompiledScene &scene, const std::vector<double> &selection,
                       const Bins &bins) {
    EmissionGuide guide;
    if (selection.empty()) {
        return guide;
    }
    append_selection(selection, guide.words);
    const size_t count = selection.size();
    guide.words.resize(2 * count, NO_GUIDE_TABLE);
    for (size_t i = 0; i < count; ++i) {
        if (takes_guide_table(scene, i)) {
            const uint32_t table = append_guide_table(bins(i), guide.words);
            guide.words[count + i] = table;
        }
    }
    return guide;
}

void require_support(const CompiledScene &scene) {
    if (!supports_guide(scene)) {
        throw input_error(
            fmt::format("integrator.guided_emission: the scene has {} lights, and at most {} can "
                        "be guided; use off",
                        scene.lights.size(), most_guided_lights));
    }
}

/// Returns the roots of the moments of each light.
std::vector<std::vector<double>> roots_of(const CompiledScene &scene,
                                          const EmissionMoments &moments) {
    if (moments.size() != scene.lights.size()) {
        throw input_error(fmt::format("emission guide: expected moments of {} lights, got {}",
                                      scene.lights.size(), moments.size()));
    }
    std::vector<std::vector<double>> roots = moments;
    for (size_t i = 0; i < moments.size(); ++i) {
        const size_t expected = takes_guide_table(scene, i) ? GUIDE_BINS : 1;
        if (!moments[i].empty() && moments[i].size() != expected) {
            throw input_error(fmt::format("emission guide: light {} has {} moments; expected {}", i,
                                          moments[i].size(), expected));
        }
        for (double &root : roots[i]) {
            if (!(root >= 0 && std::isfinite(root))) {
                throw input_error(
                    fmt::format("emission guide: light {} has the moment {}; expected a finite "
                                "number of at least 0",
                                i, root));
            }
            root = std::sqrt(root);
        }
    }
    return roots;
}

double mean(const std::vector<double> &values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Returns the probabilities of lights with the given roots.
std::vector<double> guided_selection(const std::vector<double> &usual,
                                     const std::vector<std::vector<double>> &roots) {
    double sum = 0, known = 0;
    for (size_t i = 0; i < roots.size(); ++i) {
        sum += roots[i].empty() ? 0.0 : mean(roots[i]);
        known += roots[i].empty() ? 0.0 : usual[i];
    }
    std::vector<double> selection = usual;
    for (size_t i = 0; i < roots.size() && sum > 0; ++i) {
        if (!roots[i].empty()) {
            selection[i] =
                (1.0 - usual_share) * known * (mean(roots[i]) / sum) + usual_share * usual[i];
        }
    }
    return selection;
}

/// Paths that the prior of a bin counts as.
constexpr double prior_paths = 8;

/// A sum of squares over a number of paths.
struct PathSum {
    double squares = 0, paths = 0;

    void add(const PathSum &other, double weight) {
        squares += other.squares * weight;
        paths += other.paths * weight;
    }
    double mean() const { return squares / paths; }
};

/// Returns the sum over a bin and its eight neighbours (`for_each_bin_around`).
PathSum sum_around(const PathSum *bins, size_t bin) {
    PathSum sum;
    for_each_bin_around(bin, [&](size_t other, double weight) { sum.add(bins[other], weight); });
    return sum;
}

using Word = std::vector<uint32_t>::const_iterator;

/// Returns whether `count` ends increase up to 2^32 - 1.
bool is_selection(Word first, uint32_t count) {
    return std::is_sorted(first, first + count) && first[count - 1] == 0xffffffffu;
}

/// Returns whether the words from `first` on are a table in which all bins have words.
bool is_table(Word first) {
    const auto every_entry = [](Word ends, uint32_t count) {
        return *ends > 0 && is_selection(ends, count) &&
               std::adjacent_find(ends, ends + count) == ends + count;
    };
    bool valid = every_entry(first, GUIDE_ROWS);
    for (uint32_t row = 0; row < GUIDE_ROWS; ++row) {
        valid = valid && every_entry(first + GUIDE_ROWS + row * GUIDE_COLUMNS, GUIDE_COLUMNS);
    }
    return valid;
}

}  // namespace

bool supports_guide(const CompiledScene &scene) {
    return scene.lights.size() <= most_guided_lights;
}

bool takes_guide_table(const CompiledScene &scene, size_t light) {
    const LightRecord &record = scene.lights[light];
    if (record.kind != LIGHT_MESH) {
        return record.kind <= LIGHT_POINT;
    }
    // Normals are within a rounding error or two of each other. Those without area are zero.
    constexpr float rounding = 1e-6f;
    if (std::all_of(record.axis_z, record.axis_z + 3, [](float x) { return x == 0.0f; })) {
        return false;
    }
    const auto first = scene.emitter_triangles.begin() + record.first_triangle;
    return std::all_of(first, first + record.triangle_count, [&](const EmitterTriangle &emitter) {
        const float *normal = scene.surface_triangles[emitter.triangle].normal;
        bool same = true, zero = true;
        for (int i = 0; i < 3; ++i) {
            same = same && std::abs(normal[i] - record.axis_z[i]) <= rounding;
            zero = zero && normal[i] == 0.0f;
        }
        return same || zero;
    });
}

bool is_trainable(const CompiledScene &scene) {
    return supports_guide(scene) && !scene.lights.empty() &&
           (scene.lights.size() > 1 || takes_guide_table(scene, 0));
}

void require_trainable(const CompiledScene &scene) {
    require_support(scene);
    if (!is_trainable(scene)) {
        throw input_error(
            scene.lights.empty()
                ? "integrator.guided_emission=trained: the scene has no light to guide; use off"
                : "integrator.guided_emission=trained: the only light of the scene takes no table; "
                  "discs, spheres, point lights and flat meshes do; use off");
    }
}

EmissionMoments emission_moments(const CompiledScene &scene, const std::vector<PathTrials> &paths,
                                 size_t trial) {
    std::vector<PathSum> sums(scene.lights.size() * GUIDE_BINS);
    for (const PathTrials &path : paths) {
        const double value =
            static_cast<double>(path.value[trial]) * static_cast<double>(path.start_density);
        sums[path.start].add({std::isfinite(value) ? value * value : 0.0, 1}, 1);
    }
    EmissionMoments moments(scene.lights.size());
    for (size_t light = 0; light < moments.size(); ++light) {
        const PathSum *bins = &sums[light * GUIDE_BINS];
        PathSum all;
        for (size_t bin = 0; bin < GUIDE_BINS; ++bin) {
            all.add(bins[bin], 1);
        }
        if (all.paths > 0 && takes_guide_table(scene, light)) {
            for (size_t bin = 0; bin < GUIDE_BINS; ++bin) {
                PathSum around = sum_around(bins, bin);
                around.add(all, prior_paths / all.paths);
                PathSum own = bins[bin];
                own.add(around, prior_paths / around.paths);
                moments[light].push_back(own.mean());
            }
        } else if (all.paths > 0) {
            moments[light] = {all.mean()};
        }
    }
    return moments;
}

EmissionGuide flat_guide(const CompiledScene &scene) {
    require_support(scene);
    return guide_of(scene, usual_selection(scene),
                    [](size_t) { return std::vector<double>(GUIDE_BINS, 1.0); });
}

EmissionGuide make_guide(const CompiledScene &scene, const EmissionMoments &moments) {
    require_support(scene);
    const std::vector<std::vector<double>> roots = roots_of(scene, moments);
    const auto bins = [&](size_t light) {
        std::vector<double> weights(GUIDE_BINS, 1.0);
        const double sum = std::accumulate(roots[light].begin(), roots[light].end(), 0.0);
        for (size_t i = 0; i < GUIDE_BINS && sum > 0; ++i) {
            weights[i] = (1.0 - usual_share) * GUIDE_BINS * (roots[light][i] / sum) + usual_share;
        }
        return weights;
    };
    return guide_of(scene, guided_selection(usual_selection(scene), roots), bins);
}

void require_guide_for(const CompiledScene &scene, const EmissionGuide &guide) {
    const size_t count = scene.lights.size();
    const std::vector<uint32_t> &words = guide.words;
    bool valid = words.size() >= 2 * count &&
                 (count == 0 || is_selection(words.begin(), static_cast<uint32_t>(count)));
    size_t end = 2 * count;
    for (size_t i = 0; i < count && valid; ++i) {
        if (takes_guide_table(scene, i) || words[count + i] != NO_GUIDE_TABLE) {
            valid = takes_guide_table(scene, i) && words[count + i] == end &&
                    words.size() >= end + GUIDE_TABLE_WORDS &&
                    is_table(words.begin() + static_cast<std::ptrdiff_t>(end));
            end += GUIDE_TABLE_WORDS;
        }
    }
    if (!valid || words.size() != end) {
        throw input_error(
            "emission guide: it does not fit the lights of the scene; make it for this scene");
    }
}

}  // namespace rtrays
