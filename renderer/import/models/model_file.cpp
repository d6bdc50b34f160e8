// SPDX-License-Identifier: MIT
#include "renderer/import/models/model_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "renderer/base/angles.h"
#include "renderer/base/error.h"
#include "renderer/base/lower_case.h"
#include "renderer/import/models/geometry.h"
#include "renderer/import/models/ply.h"
#include "renderer/import/models/scene.h"
#include "renderer/import/models/surface.h"
#include "renderer/import/models/wavefront.h"
#include "renderer/scene/cores/camera.h"
#include "renderer/scene/cores/light.h"
#include "renderer/scene/cores/transform.h"
#include "renderer/scene/cores/visibility.h"
#include "renderer/scene/graph.h"

namespace rtrays {

namespace {

bool is_ply(const std::filesystem::path &path) {
    return lower_extension(path) == ".ply";
}

bool is_obj(const std::filesystem::path &path) {
    return lower_extension(path) == ".obj";
}

/// Adds a camera that looks down on the model slightly from the side. The image just contains the
/// bounding sphere of the model.
void add_camera(Scene &scene, ModelNames &names, ModelNotes &notes) {
    constexpr double fov = 40;
    const Eigen::AlignedBox3d bounds = scene.graph().bounds();
    const double size = 0.5 * bounds.diagonal().norm();
    const double radius = size > 0 ? size : 1;
    const Eigen::Vector3d towards = Eigen::Vector3d(0.5, 0.35, 1).normalized();
    const Eigen::Vector3d origin =
        bounds.center() + radius / std::sin(0.5 * fov * degree) * towards;
    const std::string name = names.unique("camera", "camera");
    Node &node = add_model_node(scene.graph().root(), name,
                                look_at(origin, bounds.center(), Eigen::Vector3d::UnitY()));
    node.set_core(std::make_shared<CameraCore>(
        name, "pinhole", ParameterValues{{"fov", fov}, {"fov_axis", std::string("smaller")}}));
    notes.add(fmt::format("the file has no camera; added '{}', which sees the full model", name));
}

void add_dome(Scene &scene, ModelNames &names, ModelNotes &notes) {
    const std::string name = names.unique("dome", "dome");
    Node &node = add_model_node(scene.graph().root(), name, Eigen::Matrix4d::Identity());
    node.set_core(std::make_shared<LightCore>(
        name, "dome", ParameterValues{{"radiance", Eigen::Vector3d(1, 1, 1)}}));
    notes.add(fmt::format("the file has no light; added the light '{}' of radiance 1", name));
}

}  // namespace

bool is_model_file(const std::filesystem::path &path) {
    const std::string extension = lower_extension(path);
    // Assimp associates other formats with these extensions.
    const bool is_scene = extension == ".json" || extension == ".xml";
    return is_ply(path) || is_obj(path) ||
           (extension.size() > 1 && !is_scene && assimp_reads(extension));
}

std::shared_ptr<MaterialCore> default_model_material(
    const std::string &name, const std::shared_ptr<Texture> &vertex_colours) {
    if (vertex_colours != nullptr) {
        return std::make_shared<MaterialCore>(
            name, "lambert", ParameterValues{{"reflectance", Eigen::Vector3d(1, 1, 1)}},
            ParameterTextures{{"reflectance", vertex_colours}});
    }
    return std::make_shared<MaterialCore>(name, "lambert",
                                          ParameterValues{{"reflectance", ModelSurface{}.diffuse}});
}

Node &add_model_node(Node &parent, const std::string &name, const Eigen::Matrix4d &transform) {
    auto node = std::make_unique<Node>(name);
    node->set_core(std::make_shared<TransformCore>(name, transform));
    node->set_core(std::make_shared<VisibilityCore>(name, true));
    return parent.add_child(std::move(node));
}

std::shared_ptr<MeshCore> load_mesh_file(const std::filesystem::path &path, const std::string &name,
                                         const MeshFileOptions &options) {
    using Normals = MeshFileOptions::Normals;
    ModelNotes notes(path.string());
    MeshCore::Geometry geometry = is_ply(path)   ? read_ply(path, notes, options.quiet).geometry
                                  : is_obj(path) ? read_obj_geometry(path, notes, options.quiet)
                                                 : read_model_geometry(path, notes, options.quiet);
    if (options.normals == Normals::none) {
        geometry.normals.clear();
    } else if (options.normals == Normals::smooth && geometry.normals.empty()) {
        make_smooth_normals(geometry);
    }
    if (options.flip_v) {
        for (Eigen::Vector2d &uv : geometry.uvs) {
            uv.y() = 1 - uv.y();
        }
    }
    try {
        const auto mesh = std::make_shared<MeshCore>(name, std::move(geometry));
        notes.tell();
        return mesh;
    } catch (const Error &error) {
        throw Error(error.exit_code(), fmt::format("{}: {}", path.string(), error.what()));
    }
}

Scene load_model(const std::filesystem::path &path, bool quiet, bool is_part) {
    Scene scene;
    scene.set_name(path.stem().string());
    ModelNames names;
    ModelNotes notes(path.string());
    const auto read = is_ply(path)   ? read_ply_scene
                      : is_obj(path) ? read_obj_scene
                                     : read_model_scene;
    read(path, scene, names, notes, quiet);
    try {
        scene.update(0);
        if (scene.meshes().name.empty()) {
            throw input_error("the file has no triangles");
        }
        if (!is_part && scene.cameras().name.empty()) {
            add_camera(scene, names, notes);
        }
        if (!is_part && scene.lights().name.empty()) {
            add_dome(scene, names, notes);
        }
        scene.update(0);
        scene.recentre();
    } catch (const Error &error) {
        throw Error(error.exit_code(), fmt::format("{}: {}", path.string(), error.what()));
    }
    notes.tell();
    return scene;
}

}  // namespace rtrays
