// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "renderer/scene/stores.h"
#include "renderer/shared/features.h"
#include "renderer/shared/scene_records.h"

namespace rtrays {

/// The shapes as the device reads them, in their order. `light` is still the index into LightArrays
/// (`no_index`, which is NO_EMITTER, for none).
/// @throws Error (input_error) for a transform that float cannot hold or invert, and for a Julia
/// set whose surface is empty or beyond float; the message names the node.
std::vector<ShapeRecord> compile_shapes(const ShapeArrays &shapes);

/// Balls around them, in eights (kernels/geometry/shape_bounds.h).
std::vector<ShapeBounds> bound_shapes(const std::vector<ShapeRecord> &shapes);

/// Which of `shapes`, `quadrics`, `julia` the scene has.
FeatureMask shape_features(const ShapeArrays &shapes);

}  // namespace rtrays
