// SPDX-License-Identifier: MIT
// Tests that docs/algorithms.md says of every algorithm what the registry says.
#include "renderer/integrators/algorithm.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "renderer/testing/errors.h"
#include "renderer/testing/temporary_folder.h"

namespace rtrays {
namespace {

using Row = std::vector<std::string>;

/// Returns the cells of a row of a Markdown table, without the blanks around them. The list is
/// empty if the line is no such row.
Row cells_of(const std::string &line) {
    Row cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, '|');) {
        const size_t begin = cell.find_first_not_of(' '), end = cell.find_last_not_of(' ');
        cells.push_back(begin == std::string::npos ? "" : cell.substr(begin, end + 1 - begin));
    }
    if (!cells.empty()) {
        cells.erase(cells.begin());
    }
    return cells;
}

/// Returns the first table of the page whose first cell is `corner`: its head, then its rows.
std::vector<Row> table_of_page(const std::string &corner) {
    std::istringstream page(bytes_of(RTRAYS_SCENES "/../docs/algorithms.md"));
    std::vector<Row> table;
    for (std::string line; std::getline(page, line);) {
        const Row cells = cells_of(line);
        if (table.empty() ? !cells.empty() && cells.front() == corner : cells.size() > 1) {
            table.push_back(cells);
        } else if (!table.empty()) {
            break;
        }
    }
    EXPECT_GT(table.size(), 2u) << corner;
    table.erase(table.begin() + 1);  // the rule under the head
    return table;
}

/// Returns the entries below each algorithm's column, by the row's first cell. Every algorithm must
/// have a column, in the order of the registry.
std::map<std::string, std::map<std::string, std::string>> columns_of_page(
    const std::string &corner) {
    const std::vector<Row> table = table_of_page(corner);
    EXPECT_EQ(Row(table.front().begin() + 1, table.front().end()), algorithm_names());
    std::map<std::string, std::map<std::string, std::string>> columns;
    for (size_t i = 1; i < table.size(); ++i) {
        EXPECT_EQ(table[i].size(), table.front().size()) << table[i].front();
        for (size_t column = 1; column < table[i].size(); ++column) {
            columns[table.front()[column]][table[i].front()] = table[i][column];
        }
    }
    return columns;
}

TEST(AlgorithmsPage, SaysWhatEveryAlgorithmComputes) {
    std::vector<Row> expected;
    for (const Algorithm *algorithm : all_algorithms()) {
        expected.push_back({std::string("`") + algorithm->name + "`", algorithm->computes,
                            algorithm->is_random ? "x" : ""});
    }
    std::vector<Row> listed;
    const std::vector<Row> table = table_of_page("algorithm");
    for (size_t i = 1; i < table.size(); ++i) {
        listed.emplace_back(table[i].begin(), table[i].begin() + 3);
    }
    EXPECT_EQ(listed, expected);
}

// The table of stages is that of figure 3.7 of the thesis.
TEST(AlgorithmsPage, ListsTheStagesOfEveryAlgorithm) {
    // The page omits stages that only maintain counters.
    const std::set<Stage> bookkeeping = {Stage::begin_round, Stage::end_shadow_rays,
                                         Stage::end_round};
    const auto columns = columns_of_page("stage");
    for (const Algorithm *algorithm : all_algorithms()) {
        std::set<std::string> listed, used;
        for (const auto &[stage, entry] : columns.at(algorithm->name)) {
            if (!entry.empty()) {
                listed.insert(stage);
            }
        }
        for (const Pass &pass : algorithm_passes(*algorithm, {FeatureMask::all(), 1, true, 2})) {
            for (const std::vector<RoundStage> *stages : {&pass.round, &pass.tail}) {
                for (const RoundStage &stage : *stages) {
                    if (bookkeeping.count(stage.stage) == 0) {
                        used.insert(to_string(stage.stage));
                    }
                }
            }
        }
        EXPECT_EQ(listed, used) << algorithm->name;
    }
}

TEST(AlgorithmsPage, SaysWhatEveryAlgorithmSees) {
    const auto columns = columns_of_page("light");
    for (const Algorithm *algorithm : all_algorithms()) {
        std::map<std::string, std::string> expected;
        for (const auto &[path, text] : path_classes) {
            expected[text] = name_in(visibilities, algorithm->sees.of(path));
        }
        EXPECT_EQ(columns.at(algorithm->name), expected) << algorithm->name;
    }
}

/// A path without its ends: a letter S or D for each vertex.
using Vertices = std::string;

/// Returns all sequences of at most `length` vertices.
std::vector<Vertices> all_vertices(size_t length) {
    std::vector<Vertices> all = {""};
    for (size_t i = 0; i < all.size(); ++i) {
        if (all[i].size() < length) {
            all.push_back(all[i] + "S");
            all.push_back(all[i] + "D");
        }
    }
    return all;
}

enum class LightKind { area, infinite, delta };

/// Returns whether a strategy of the algorithm samples the path. It hits the light, connects its
/// last vertex to a point on the light, connects its first vertex to the camera, or connects two
/// vertices. No connection ends at a vertex S.
bool is_sampled(const Algorithm &algorithm, const Vertices &path, LightKind light) {
    const bool hits = light != LightKind::delta,
               connects_light = !path.empty() && path.back() == 'D',
               connects_camera = path.empty() ? light == LightKind::area : path.front() == 'D';
    const std::string name = algorithm.name;
    if (name == "ray_casting") {
        return path.empty() || path == "D";
    }
    if (name == "whitted") {
        const size_t ideal = path.find_first_not_of('S');
        return ideal == Vertices::npos || (ideal + 1 == path.size() && connects_light);
    }
    return (algorithm.traces_camera_paths && (hits || connects_light)) ||
           (algorithm.traces_light_paths() && connects_camera) ||
           (name == "bdpt" && path.find("DD") != Vertices::npos);
}

/// Returns whether the path has the pattern of a class, as "E S ... D L".
bool has_pattern(const Vertices &path, const std::string &text) {
    std::string pattern;
    for (const char letter : text.substr(0, text.find(':'))) {
        pattern += letter == '.' && (pattern.empty() || pattern.back() != '*') ? "[SD]*"
                   : letter == 'S' || letter == 'D' ? std::string(1, letter)
                                                    : "";
    }
    return std::regex_match(path, std::regex(pattern));
}

/// Returns whether a class contains paths to such a light.
bool has_light(PathClass path, LightKind light) {
    switch (path) {
        case PathClass::area_lights:
            return light == LightKind::area;
        case PathClass::infinite_lights:
            return light == LightKind::infinite;
        case PathClass::caustics:
        case PathClass::mirrored_caustics:
            return light != LightKind::delta;
        case PathClass::delta_light_caustics:
        case PathClass::mirrored_delta_light_caustics:
        case PathClass::mirrored_light_of_delta_light_caustics:
            return light == LightKind::delta;
        case PathClass::infinite_light_outside:
        case PathClass::nearly_specular:
            return false;  // decided by more than the sequence of vertices
        case PathClass::direct_light:
        case PathClass::diffuse_reflection:
        case PathClass::mirrors:
            return true;
    }
    return false;
}

// The rows of the table follow from the strategies: every path of at most six vertices is in a
// class, and an algorithm sees a class if it samples all of its paths.
TEST(Algorithms, SeeWhatTheirStrategiesSample) {
    for (const Algorithm *algorithm : all_algorithms()) {
        std::map<PathClass, std::set<bool>> sampled;
        for (const LightKind light : {LightKind::area, LightKind::infinite, LightKind::delta}) {
            for (const Vertices &path : all_vertices(6)) {
                if (light == LightKind::delta && path.find('D') == Vertices::npos) {
                    continue;  // such a light is a point: neither the camera nor a mirror shows it
                }
                const auto last = std::find_if(std::rbegin(path_classes), std::rend(path_classes),
                                               [&](const Named<PathClass> &row) {
                                                   return has_light(row.value, light) &&
                                                          has_pattern(path, row.name);
                                               });
                ASSERT_NE(last, std::rend(path_classes)) << path;
                sampled[last->value].insert(is_sampled(*algorithm, path, light));
            }
        }
        EXPECT_EQ(sampled.size(), std::size(path_classes) - 2) << "all but two rows are tested";
        for (const auto &[path, seen] : sampled) {
            const Visibility expected = seen.size() == 2 ? Visibility::in_part
                                        : *seen.begin()  ? Visibility::yes
                                                         : Visibility::no;
            EXPECT_EQ(algorithm->sees.of(path), expected)
                << algorithm->name << ", " << name_in(path_classes, path);
        }
    }
}

TEST(Algorithms, AreFoundByName) {
    for (const Algorithm *algorithm : all_algorithms()) {
        EXPECT_EQ(&algorithm_named(algorithm->name), algorithm);
    }
    expect_input_error(
        "unknown algorithm 'magic'; algorithms are: ray_casting, whitted, path_tracing",
        [] { algorithm_named("magic"); });
}

TEST(Algorithms, HaveNoFeatureOfOthers) {
    for (const Algorithm *algorithm : all_algorithms()) {
        for (const Pass &pass : algorithm_passes(*algorithm, {FeatureMask::all(), 1, true, 2})) {
            for (const Feature feature : {Feature::vertex_connections, Feature::branches}) {
                EXPECT_EQ(pass.features.has(feature), algorithm->features.has(feature))
                    << algorithm->name;
            }
        }
    }
}

// Layers of strategies add up to the image only if one pass adds the emission that paths hit.
TEST(Algorithms, AddTheHitsOfCameraPathsInOnePass) {
    for (const Algorithm *algorithm : all_algorithms()) {
        for (const bool separate : {false, true}) {
            int adding = 0;
            for (const Pass &pass :
                 algorithm_passes(*algorithm, {FeatureMask::all(), 1, true, 2, separate})) {
                adding += pass.kind != PassKind::light && pass.adds_hits ? 1 : 0;
            }
            EXPECT_EQ(adding, algorithm->traces_camera_paths ? 1 : 0) << algorithm->name;
        }
    }
}

}  // namespace
}  // namespace rtrays
