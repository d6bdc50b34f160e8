// SPDX-License-Identifier: MIT
// The meshes that rays are traced through, each with a place to look from.
#pragma once

#include <string>
#include <vector>

#include "renderer/tests/bvh_meshes.h"

namespace rtrays::benchmarks {

/// From where primary rays start, and whereto.
struct View {
    Eigen::Vector3f origin;
    Eigen::Vector3f direction;  ///< of any length
    float degrees;              ///< field of view, both ways
};

struct BenchmarkScene {
    std::string name;
    View view;
};

/// The Cornell box, procedural meshes of stated triangle counts, and those models of the folder
/// $RTRAYS_MESHES that are there (../shared/meshes of a checkout unless it is set).
std::vector<BenchmarkScene> benchmark_scenes();

/// Throws `Error` when the scene's file cannot be read.
test::Mesh load_benchmark_mesh(const std::string &name);

}  // namespace rtrays::benchmarks
