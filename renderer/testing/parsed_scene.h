// SPDX-License-Identifier: MIT
// Small scenes that are read from text.
#pragma once

#include <string>

#include "renderer/import/json/scene_json.h"
#include "renderer/testing/scene_builder.h"

namespace rtrays {

/// Returns a scene with a camera and the given nodes. Files are relative to the temporary folder of
/// the tests.
inline Scene parse(const std::string &nodes, const std::string &sections = "") {
    const std::string text =
        R"({"version": 1, "film": {"width": 8, "height": 4}, )" + sections +
        R"("nodes": [{"name": "eye", "camera": {"type": "pinhole", "fov": 60, "fov_axis": "x"}}, )" +
        nodes + "]}";
    Scene scene = parse_scene_json(text, "in.json", "in", testing::TempDir());
    expect_consistent(scene.graph());
    return scene;
}

}  // namespace rtrays
