// SPDX-License-Identifier: MIT
// Rays counted by depth, where a run asks for it: the scattering events of the path so far, 0 for
// rays from where it begins; that of a shadow ray is its path's. The last bin holds all from there
// on.
#pragma once

#define RAY_DEPTHS 64
#define RAY_KINDS 2
#define RAY_NEAREST 0  ///< closest-hit rays
#define RAY_SHADOW 1   ///< any-hit rays
