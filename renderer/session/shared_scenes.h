// SPDX-License-Identifier: MIT
// Sessions over one scene that share what they can of it on the device.
#pragma once

#include <memory>
#include <vector>

#include "renderer/session/render_session.h"

namespace rtrays {

/// Makes sessions over one scene. Those whose settings allow it (`device_scene_settings`) share
/// buffers and hierarchy, which stay on the device until this object and all sessions are gone.
class SharedScenes {
  public:
    /// Keeps references to both.
    SharedScenes(const Scene &scene, DeviceContext &device);
    ~SharedScenes();
    SharedScenes(const SharedScenes &) = delete;
    SharedScenes &operator=(const SharedScenes &) = delete;

    /// Throws `Error` as the constructor of `RenderSession` does.
    RenderSession session(const RenderSettings &settings);

    const Scene &scene() const { return scene_; }
    DeviceContext &device() const { return device_; }

  private:
    const Scene &scene_;
    DeviceContext &device_;
    std::vector<std::shared_ptr<DeviceScene>> shared_;  ///< one for each DeviceSceneSettings
};

}  // namespace rtrays
