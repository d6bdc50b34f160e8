// SPDX-License-Identifier: MIT
// Truncated bidirectional path tracing (thesis 2.8): path tracing and light tracing, added.
//
// A path x0 x1 ... xk from the camera to a light may be sampled by three strategies. The image is
// the sum over a camera pass and a light pass, and no vertices are stored. Each path carries one
// running scalar, from which its weight against the other two strategies follows. Numbers are
// equations of docs/mis-weights.md:
//
//   pass    strategy  adds a contribution in               density  running scalar  weight
//   camera  implicit  evaluate_emission: the path hits     (2)      R, (11)         (13); for k = 1
//                     the light                                                     with (17)
//   camera  explicit  sample_light: x(k-1) is connected    (3)      R, (11)         (13)
//                     to a point sampled on the light
//   light   light     connect_camera: each hit, as x1, is  (4)      Q, (15)         (16)
//                     connected to the lens; the
//                     contribution is (9)
//   light   light,    generate_light_paths: the point on   n_L p_o  none            (1) with (17)
//           k = 1     the light is connected to the lens
//
// evaluate_emission sets R at the first hit. generate_light_paths and connect_camera set the start
// of Q. extend_path continues R and Q at every vertex. The last strategy exists with
// integrator.seen_emitters=mis alone; otherwise implicit paths with k = 1 have weight 1. Without
// light paths or lights the camera pass alone is left, and the image is that of path tracing.
#include "renderer/integrators/algorithm.h"
#include "renderer/integrators/light_tracing.h"
#include "renderer/integrators/path_tracing.h"

namespace rtrays {

namespace {

std::vector<Pass> truncated_bdpt_passes(const PassRequest &request) {
    std::vector<Pass> passes = camera_passes(request);
    if (request.traces_light_paths && request.features.has(Feature::lights)) {
        passes.push_back(light_pass(request, /*weighted=*/true));
    }
    return passes;
}

}  // namespace

constexpr Algorithm algorithms::truncated_bdpt = [] {
    Algorithm a;
    a.name = "truncated_bdpt";
    a.computes = "the sum of camera paths and light paths";
    // In the mirror image of a caustic, x1 and x(k-1) have delta events. Only implicit paths find
    // it, and none hits a point, spot or directional light.
    a.sees = Sight::everything()
                 .without(PathClass::mirrored_delta_light_caustics)
                 .without(PathClass::mirrored_light_of_delta_light_caustics);
    a.may_be_implicit = true;
    a.light_paths = LightPaths::any;
    a.stops_pixels = true;
    a.passes = truncated_bdpt_passes;
    return a;
}();

}  // namespace rtrays
