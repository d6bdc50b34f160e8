// SPDX-License-Identifier: MIT
#include "renderer/compile/device_scene.h"

#include <utility>

#include "renderer/base/clock.h"

namespace rtrays {

namespace {

/// Returns whether two cameras take the same picture.
bool are_equal(const CameraArrays &a, size_t i, const CameraArrays &b, size_t j) {
    return i < a.name.size() && a.world_from_camera[i] == b.world_from_camera[j] &&
           a.fov[i] == b.fov[j] && a.fov_axis[i] == b.fov_axis[j] &&
           a.view_size[i] == b.view_size[j] && a.aperture_radius[i] == b.aperture_radius[j] &&
           a.focus_distance[i] == b.focus_distance[j];
}

/// Returns the parts that differ between two revisions.
SceneParts changed_parts(const SceneRevision &before, const SceneRevision &after) {
    if (before.scene != after.scene) {
        return SceneParts::all();
    }
    SceneParts parts;
    parts.materials = before.materials != after.materials;
    parts.triangles = before.geometry != after.geometry || before.surfaces != after.surfaces;
    parts.shapes = before.shapes != after.shapes;
    parts.lights = before.lights != after.lights;
    return parts;
}

}  // namespace

DeviceScene::DeviceScene(const Scene &scene, const DeviceSceneSettings &settings,
                         DeviceContext &device)
    : device_(&device), settings_(settings) {
    update(scene);
}

void DeviceScene::update(const Scene &scene) {
    const SceneRevision revision = scene.revision();
    const auto active = static_cast<size_t>(scene.active_camera());
    SceneParts parts = changed_parts(revision_, revision);
    const bool is_current = !(parts.materials || parts.triangles || parts.shapes || parts.lights) &&
                            are_equal(cameras_, active_camera_, scene.cameras(), active);
    if (is_current) {
        return;
    }
    const bool moved = revision_.scene != revision.scene || revision_.geometry != revision.geometry;
    if (revision_.scene == 0) {
        compiled_ = CompiledScene();  // after a failed update it may differ from the buffers
    }
    revision_ = SceneRevision();  // until all of the following has succeeded
    ++version_;
    cameras_ = scene.cameras();
    active_camera_ = active;
    const CompiledScene former =
        recompile(scene.arrays(), camera(scene.film_width(), scene.film_height()),
                  settings_.compile, parts, compiled_);
    buffers_.update(*device_, former, compiled_, parts);
    if (builder_ && moved && !refit_bvh(scene.meshes())) {
        build_bvh(*builder_, scene.meshes());
    }
    hash_ = scene.hash();
    revision_ = revision;
}

void DeviceScene::require(const Scene &scene, FeatureMask features) {
    buffers_.require(*device_, compiled_, features);
    if (features.has(Feature::triangles) && !builder_) {
        BvhBuilder builder(*device_, settings_.bvh);
        build_bvh(builder, scene.meshes());
        builder_.emplace(std::move(builder));
    }
}

void DeviceScene::build_bvh(BvhBuilder &builder, const MeshArrays &meshes) {
    refitter_.reset();
    const auto start = SteadyClock::now();
    bvh_ = builder.build(meshes.position, meshes.triangle);
    bvh_vertices_ = meshes.position.size();
    device_->finish();
    bvh_wall_seconds_ = seconds_since(start);
    bvh_stages_ = device_->profiler().take();
}

bool DeviceScene::refit_bvh(const MeshArrays &meshes) {
    if (!settings_.refits || meshes.position.size() != bvh_vertices_ ||
        meshes.triangle.size() != bvh_.report().triangles + bvh_.report().left_out) {
        return false;
    }
    const auto start = SteadyClock::now();
    const BvhInput input(*device_, meshes.position, meshes.triangle);
    if (refitter_ == nullptr) {
        refitter_ = std::make_unique<BvhRefitter>(*device_, bvh_);
    }
    const bool fits = refitter_->refit(bvh_, input.positions, input.indices);
    bvh_wall_seconds_ = seconds_since(start);
    bvh_stages_ = device_->profiler().take();
    return fits;
}

}  // namespace rtrays
