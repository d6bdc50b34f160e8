// SPDX-License-Identifier: MIT
// Truncated bidirectional path tracing (thesis 2.8): path tracing and light tracing, added.
//
// A path x0 x1 ... xk from the camera to a light may be sampled by three strategies. The image is
// the sum over two passes, and no vertices are stored. Each path carries one running scalar, from
// which its weight against the other two strategies follows. Numbers are equations of
// docs/mis-weights.md:
//
//   pass    strategy  adds a contribution in               density  running scalar  weight
//   camera  implicit  evaluate_emission: the path hits     (2)      R, (11)         (13), and (17)
//                     the light                                                     for k = 1
//   camera  explicit  sample_light: x(k-1) is connected    (3)      R, (11)         (13)
//                     to a point sampled on the light
//   light   light     connect_camera: x1 is connected to   (4)      Q, (15)         (16)
//                     the lens; the contribution is (9)
//   light   light,    connect_emitter: the point on the    (4)      none            (17)
//           k = 1     light itself is connected
//
// evaluate_emission sets R at the first hit, extend_path continues R and Q at every vertex. The
// last strategy exists with integrator.seen_emitters=mis alone.
#include "renderer/integrators/algorithm.h"
#include "renderer/integrators/light_tracing.h"
#include "renderer/integrators/path_tracing.h"

namespace rtrays {

namespace {

std::vector<Pass> truncated_bdpt_passes(const PassRequest &request) {
    std::vector<Pass> passes = camera_passes(request);
    if (request.light_paths && request.features.has(Feature::lights)) {
        passes.push_back(light_pass(request, true));
    }
    return passes;
}

}  // namespace

constexpr Algorithm algorithms::truncated_bdpt = [] {
    Algorithm a;
    a.name = "truncated_bdpt";
    a.computes = "the sum of camera paths and light paths";
    // Both ends of a mirrored caustic have delta events: only an implicit path finds it.
    a.sees = Sight::everything().without(PathClass::mirrored_delta_light_caustics);
    a.light_paths = LightPaths::any;
    a.stops_pixels = true;
    a.passes = truncated_bdpt_passes;
    return a;
}();

}  // namespace rtrays
