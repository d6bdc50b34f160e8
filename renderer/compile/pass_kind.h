// SPDX-License-Identifier: MIT
// Kinds of passes: what their paths are, and which contributions a pass adds to the image.
#pragma once

#include "renderer/base/named.h"

namespace rtrays {

/// Kind of a pass. The image of an algorithm is the sum over its passes. Each kind occurs at most
/// once.
enum class PassKind {
    camera,          ///< paths from the camera, with all strategies that end them
    light,           ///< paths from the lights, connected to the camera
    implicit_paths,  ///< paths from the camera that hit an emitter
    explicit_paths,  ///< paths from the camera, connected to a point sampled on a light
    connections,     ///< paths from the camera, connected to stored vertices of light paths
};

/// Names of passes in films, images, reports and messages.
inline constexpr Named<PassKind> pass_kinds[] = {{PassKind::camera, "camera"},
                                                 {PassKind::light, "light"},
                                                 {PassKind::implicit_paths, "implicit"},
                                                 {PassKind::explicit_paths, "explicit"},
                                                 {PassKind::connections, "connections"}};

constexpr const char *to_string(PassKind kind) {
    return name_in(pass_kinds, kind);
}

}  // namespace rtrays
