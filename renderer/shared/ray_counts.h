// SPDX-License-Identifier: MIT
// Ray counts by depth, which a run records on request.
//
// The depth of a ray is the number of scattering events of its path so far: 0 for rays from the
// start of a path. A shadow ray has the depth of its path. The last bin also counts all greater
// depths.
#pragma once

#define RAY_DEPTHS 64
#define RAY_KINDS 2
#define RAY_NEAREST 0  ///< closest-hit rays
#define RAY_SHADOW 1   ///< any-hit rays
