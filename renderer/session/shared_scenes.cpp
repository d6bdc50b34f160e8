// SPDX-License-Identifier: MIT
#include "renderer/session/shared_scenes.h"

#include <algorithm>

#include "renderer/compile/device_scene.h"

namespace rtrays {

SharedScenes::SharedScenes(const Scene &scene, DeviceContext &device)
    : scene_(scene), device_(device) {}
SharedScenes::~SharedScenes() = default;

RenderSession SharedScenes::session(const RenderSettings &settings) {
    const DeviceSceneSettings wanted = device_scene_settings(settings, device_.info());
    auto found = std::find_if(shared_.begin(), shared_.end(),
                              [&](const auto &scene) { return scene->settings() == wanted; });
    if (found == shared_.end()) {
        shared_.push_back(std::make_shared<DeviceScene>(scene_, wanted, device_));
        found = shared_.end() - 1;
    }
    return {*found, scene_, settings};
}

}  // namespace rtrays
