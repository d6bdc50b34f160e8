// SPDX-License-Identifier: MIT
// The rays of path tracing by kind, in the order in which a renderer would trace them.
#pragma once

#include <string>
#include <vector>

#include "experiments/hierarchy/meshes.h"
#include "renderer/tests/embree_scene.h"

namespace rtrays {

enum class Query { nearest, any };

/// A kind of ray and what is asked of it.
struct RayKind {
    std::string name;
    Query query;
    bool coherent;  ///< neighbours start together and go the same way
};

/// primary: through random points of the image plane, row by row. The others start where those hit,
/// on the side they came from. shadow: to a random point of a square of a tenth of the scene's
/// width, nine tenths up in it; ambient occlusion: cosine-distributed, a tenth of the scene's
/// diagonal long; diffuse: cosine-distributed, endless.
const std::vector<RayKind> &ray_kinds();

/// About `count` rays of the kind. Hits are found by Embree: the rays do not depend on what is
/// measured.
std::vector<RayRecord> make_rays(const std::string &kind, const test::Mesh &mesh, const View &view,
                                 const test::EmbreeScene &embree, size_t count);

}  // namespace rtrays
