// SPDX-License-Identifier: MIT
// Makes the rays of path tracing by kind, in the order in which a renderer would trace them.
#pragma once

#include <string>
#include <vector>

#include "experiments/harness/models/meshes.h"
#include "renderer/testing/embree_scene.h"

namespace rtrays {

enum class Query { nearest, any };

/// A kind of ray and its query.
struct RayKind {
    std::string name;
    Query query;
    bool coherent;  ///< neighbouring rays have similar origins and directions
};

/// The kinds of rays:
/// * primary: through random points of the image plane, row by row.
/// * shadow: from the hits of primary rays to random points of a square. Its sides are a tenth of
///   the scene's, at nine tenths of the scene's height.
/// * ambient_occlusion: from the hits, cosine-distributed, a tenth of the scene's diagonal long.
/// * diffuse: from the hits, cosine-distributed, infinitely long.
///
/// Rays from a hit start on the side from which the primary ray came.
const std::vector<RayKind> &ray_kinds();

/// Makes at least `count` rays of the kind. Embree finds the hits, so that the rays do not depend
/// on the measured hierarchies.
std::vector<RayRecord> make_rays(const std::string &kind, const test::Mesh &mesh, const View &view,
                                 const test::EmbreeScene &embree, size_t count);

}  // namespace rtrays
