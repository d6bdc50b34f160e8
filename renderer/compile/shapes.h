// SPDX-License-Identifier: MIT
// Compiles shapes that are not triangles into records and bounding spheres.
#pragma once

#include <vector>

#include "renderer/scene/stores.h"
#include "renderer/shared/features.h"
#include "renderer/shared/scene_records.h"

namespace rtrays {

/// Returns the records of the shapes, in their order, without their lights: `light` is NO_EMITTER.
/// Throws `Error` (bad input) that names the shape if float cannot represent or invert its
/// transform, or if a Julia set's surface is empty or too large for float.
std::vector<ShapeRecord> compile_shapes(const ShapeArrays &shapes);

/// Returns bounding spheres of the shapes, in groups of SHAPE_LANES
/// (kernels/geometry/shape_bounds.h).
std::vector<ShapeBounds> bound_shapes(const std::vector<ShapeRecord> &shapes);

/// Returns which of the features `shapes`, `quadrics` and `julia` the scene has.
FeatureMask shape_features(const ShapeArrays &shapes);

}  // namespace rtrays
