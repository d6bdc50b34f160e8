// SPDX-License-Identifier: MIT
// Which emitters a camera may see directly.
#pragma once

#include "renderer/compile/compile_scene.h"

namespace rtrays {

/// Returns false only if no emitting surface reaches into the view of `camera`, whatever is in
/// between. Returns true without a test for cameras with a lens and for orthographic ones.
bool emitters_in_view(const CompiledScene &compiled, const CameraRecord &camera);

}  // namespace rtrays
