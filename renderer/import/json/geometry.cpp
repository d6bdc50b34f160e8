// SPDX-License-Identifier: MIT
#include "renderer/import/json/geometry.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "renderer/base/notice.h"
#include "renderer/import/models/geometry.h"
#include "renderer/import/models/model_file.h"
#include "renderer/import/models/triangulate.h"
#include "renderer/scene/cores/mesh.h"
#include "renderer/scene/cores/morphed_mesh.h"
#include "renderer/scene/cores/shape.h"

namespace rtrays {

namespace {

void add_polygon(const Json &polygon, size_t index, const std::string &name,
                 MeshCore::Geometry &geometry) {
    std::vector<uint32_t> corners;
    for (const Json &item : polygon) {
        const auto corner = item.get<uint64_t>();
        if (corner >= geometry.vertices.size()) {
            throw input_error(fmt::format(
                "mesh '{}': polygon {} has vertex index {}, but there are only {} vertices", name,
                index, corner, geometry.vertices.size()));
        }
        corners.push_back(static_cast<uint32_t>(corner));
    }
    try {
        const std::vector<Triangle> parts = triangulate(geometry.vertices, corners);
        geometry.triangles.insert(geometry.triangles.end(), parts.begin(), parts.end());
    } catch (const Error &error) {
        throw input_error(fmt::format("mesh '{}': polygon {} {}", name, index, error.what()));
    }
}

/// Returns the mesh, with a notice if the normals of triangles oppose their winding.
std::shared_ptr<MeshCore> with_opposed_noted(std::shared_ptr<MeshCore> mesh) {
    ModelNotes notes(fmt::format("mesh '{}'", mesh->name()));
    note_opposed(*mesh, notes);
    notes.tell();
    return mesh;
}

std::shared_ptr<Core> read_mesh(const Json &value, const std::string &name,
                                const SceneSource &source, const std::string &path) {
    check_keys(value, "mesh", {"vertices", "polygons"}, {"normals", "uvs", "colours"});
    MeshCore::Geometry geometry;
    for (const Json &vertex : value.at("vertices")) {
        geometry.vertices.push_back(vector3(vertex));
    }
    if (value.contains("normals")) {
        for (const Json &normal : value.at("normals")) {
            geometry.normals.push_back(vector3(normal));
        }
    }
    if (value.contains("uvs")) {
        for (const Json &uv : value.at("uvs")) {
            geometry.uvs.emplace_back(uv[0].get<double>(), uv[1].get<double>());
        }
    }
    if (value.contains("colours")) {
        for (const Json &colour : value.at("colours")) {
            geometry.colours.push_back(vector3(colour));
        }
    }
    const Json &polygons = value.at("polygons");
    size_t i = 0;
    try {
        for (; i < polygons.size(); ++i) {
            add_polygon(polygons[i], i, name, geometry);
        }
    } catch (const Error &error) {
        source.located(fmt::format("{}/polygons/{}", path, i),
                       [&]() -> void { throw Error(error); });
    }
    return with_opposed_noted(std::make_shared<MeshCore>(name, std::move(geometry)));
}

std::shared_ptr<Core> read_morph(const Json &value, const std::string &name,
                                 const SceneSource &source, const std::string &path) {
    check_keys(value, "morph", {"keyframes"}, {});
    std::vector<MorphedMesh::Key> keys;
    const Json &keyframes = value.at("keyframes");
    for (size_t i = 0; i < keyframes.size(); ++i) {
        const std::string at = fmt::format("{}/keyframes/{}/geometry", path, i);
        const std::shared_ptr<Core> core =
            read_geometry(keyframes[i].at("geometry"), name, source, at);
        const auto *mesh = dynamic_cast<const MeshCore *>(core.get());
        if (mesh == nullptr || mesh->is_animated()) {
            source.located(at, [&]() -> void {
                throw input_error(fmt::format(
                    "mesh '{}': keyframe {} must be a mesh, file, rectangle or box", name, i));
            });
        }
        keys.push_back({keyframes[i].at("time"), mesh->geometry()});
    }
    return std::make_shared<MorphedMesh>(name, std::move(keys));
}

}  // namespace

std::shared_ptr<Core> read_geometry(const Json &value, const std::string &name,
                                    const SceneSource &source, const std::string &path) {
    return source.located(path, [&]() -> std::shared_ptr<Core> {
        const std::string type = value.at("type");
        if (type == "mesh") {
            return read_mesh(value, name, source, path);
        }
        if (type == "morph") {
            return read_morph(value, name, source, path);
        }
        if (type == "file") {
            check_keys(value, type, {"file"}, {"shading_normals"});
            const std::string normals = value.value("shading_normals", "stored");
            MeshFileOptions options;
            options.normals = normals == "none"     ? MeshFileOptions::Normals::none
                              : normals == "smooth" ? MeshFileOptions::Normals::smooth
                                                    : MeshFileOptions::Normals::stored;
            return with_opposed_noted(load_mesh_file(source.file(value.at("file")), name, options));
        }
        if (type == "rectangle" || type == "box") {
            check_keys(value, type, {}, {});
            return std::make_shared<MeshCore>(name, type == "box" ? box() : rectangle());
        }
        const ShapeType &shape = find_type(shape_types(), type, "geometry");
        return std::make_shared<ShapeCore>(
            name, type, parameter_values(value, type, shape.parameters, {}, source, path));
    });
}

}  // namespace rtrays
