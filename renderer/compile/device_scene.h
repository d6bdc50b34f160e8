// SPDX-License-Identifier: MIT
// A scene on a device: compiled records, their buffers, and the hierarchy over the triangles.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "renderer/bvh/builder.h"
#include "renderer/bvh/refit.h"
#include "renderer/compile/compile_scene.h"
#include "renderer/compile/scene_buffers.h"

namespace rtrays {

/// Settings of a scene on a device. Sessions that share the scene have them in common.
struct DeviceSceneSettings {
    CompileSettings compile;
    BvhBuildParameters bvh;
    /// When triangles move, the hierarchy is refitted, as long as the old tree fits them. Otherwise
    /// it is rebuilt.
    bool refits = false;
};

inline bool operator==(const DeviceSceneSettings &a, const DeviceSceneSettings &b) {
    return a.compile == b.compile && a.refits == b.refits && a.bvh.layout == b.bvh.layout &&
           a.bvh.method == b.bvh.method && a.bvh.bins == b.bvh.bins && a.bvh.axes == b.bvh.axes;
}

/// A scene on a device, without a film size and without an algorithm: any number of sessions may
/// render it. `update` compiles, copies and rebuilds only what has changed in the scene graph: a
/// camera costs nothing, a colour its record, moved triangles their range and the hierarchy.
class DeviceScene {
  public:
    /// Compiles the scene. Buffers and hierarchy are made when a session requires them. Throws
    /// `Error` (bad input) for a scene that the device cannot represent.
    DeviceScene(const Scene &scene, const DeviceSceneSettings &settings, DeviceContext &device);

    /// Continues with the current state of `scene`, which may also be another scene. Sessions must
    /// then be updated before they render. Throws `Error` (bad input) for a scene that the device
    /// cannot represent; another update must then succeed first.
    void update(const Scene &scene);

    /// Makes the buffers, and the hierarchy, that stages with these features read. `scene` must be
    /// in the state of the last update.
    void require(const Scene &scene, FeatureMask features);

    DeviceContext &device() const { return *device_; }
    const DeviceSceneSettings &settings() const { return settings_; }
    const CompiledScene &compiled() const { return compiled_; }

    /// Number of updates that changed the scene or failed.
    uint64_t version() const { return version_; }

    /// `Scene::hash` at the last update.
    const std::string &hash() const { return hash_; }

    /// Returns the camera for a film of the given size in pixels.
    CameraRecord camera(int width, int height) const {
        CameraRecord record = compile_camera(cameras_, active_camera_, width, height);
        set_camera_start(cameras_, active_camera_, compiled_.extent, record);
        return record;
    }

    /// Returns the inputs of stages that read the scene. `features` must have been required.
    StageArguments arguments(FeatureMask features, const Buffer<uint32_t> &emission_guide,
                             const Buffer<uint32_t> &scatter_guide) const {
        return buffers_.arguments(compiled_, bvh_, features, emission_guide, scatter_guide);
    }

    const Bvh &bvh() const { return bvh_; }
    /// Profile and wall time of the last build or refit.
    const std::map<std::string, Profiler::Stage> &bvh_stages() const { return bvh_stages_; }
    double bvh_wall_seconds() const { return bvh_wall_seconds_; }
    bool is_refitted() const { return refitter_ != nullptr; }

    /// Calls visit(buffer) for every buffer of the hierarchy and the scene.
    template <typename Visit>
    void visit_buffers(const Visit &visit) const {
        bvh_.visit([&](const auto &nodes, const auto &triangles) {
            visit(nodes);
            visit(triangles);
        });
        buffers_.visit(visit);
    }

  private:
    void build_bvh(BvhBuilder &builder, const MeshArrays &meshes);
    bool refit_bvh(const MeshArrays &meshes);

    DeviceContext *device_;
    DeviceSceneSettings settings_;
    SceneRevision revision_;  ///< that of `compiled_`; empty after an update that failed
    CameraArrays cameras_;
    size_t active_camera_ = 0;
    CompiledScene compiled_;
    SceneBuffers buffers_;
    std::string hash_;
    uint64_t version_ = 0;

    std::optional<BvhBuilder> builder_;      ///< set once a hierarchy has been built
    std::unique_ptr<BvhRefitter> refitter_;  ///< set once the hierarchy has been refitted
    Bvh bvh_;
    size_t bvh_vertices_ = 0;  ///< number of vertices from which the hierarchy was built
    std::map<std::string, Profiler::Stage> bvh_stages_;
    double bvh_wall_seconds_ = 0;
};

}  // namespace rtrays
