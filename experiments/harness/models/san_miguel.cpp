// SPDX-License-Identifier: MIT
#include "experiments/harness/models/san_miguel.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/import/models/geometry.h"
#include "renderer/import/models/ply.h"
#include "renderer/import/models/scene.h"
#include "renderer/import/models/wavefront.h"
#include "renderer/scene/cores/mesh.h"
#include "renderer/scene/graph.h"

namespace rtrays {

namespace fs = std::filesystem;
using Geometry = MeshCore::Geometry;

namespace {

std::string read_gzip(const fs::path &path) {
    const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
    std::string content;
    std::string piece(1 << 20, '\0');
    for (;;) {
        const int bytes =
            file == nullptr ? -1
                            : gzread(file.get(), piece.data(), static_cast<unsigned>(piece.size()));
        if (bytes < 0) {
            throw input_error(fmt::format("cannot read {} as gzip", path.string()));
        }
        if (bytes == 0) {
            return content;
        }
        content.append(piece.data(), static_cast<size_t>(bytes));
    }
}

/// Reads a gzipped PLY file through a temporary, uncompressed copy.
Geometry read_gzipped_ply(const fs::path &path, ModelNotes &notes) {
    const fs::path copy = fs::temp_directory_path() / (content_hash(path.string()) + ".rtrays.ply");
    write_file(copy, read_gzip(path));
    Geometry geometry = read_ply(copy, notes, true).geometry;
    fs::remove(copy);
    return geometry;
}

struct Object {
    std::string name;
    size_t first, count;  ///< range of triangles of the model
    size_t material;
};

struct Instance {
    size_t object;
    Eigen::Matrix4d to_world;
};

struct Layout {
    std::vector<Object> objects;
    std::vector<Instance> instances;
};

/// Reads the list of a model with `triangles` triangles.
Layout read_layout(const fs::path &path, size_t triangles) {
    std::istringstream file(read_file(path));
    Layout layout;
    size_t number = 1;
    for (std::string line; std::getline(file, line); ++number) {
        std::istringstream words(line);
        std::string what;
        words >> what;
        if (what.empty() || what.front() == '#') {
            continue;
        }
        size_t id = 0;
        words >> id;
        bool right = false;
        if (what == "object") {
            Object object{};
            words >> object.name >> object.first >> object.count >> object.material;
            right = !words.fail() && id == layout.objects.size() && object.first <= triangles &&
                    object.count <= triangles - object.first;
            layout.objects.push_back(std::move(object));
        } else {
            Instance instance{id, Eigen::Matrix4d::Identity()};
            for (int i = 0; i < 12; ++i) {
                words >> instance.to_world(i / 4, i % 4);
            }
            right = what == "instance" && !words.fail() && id < layout.objects.size();
            layout.instances.push_back(instance);
        }
        if (!right) {
            throw input_error(
                fmt::format("{}:{}: expected an object of a model with {} triangles or an instance "
                            "of a previous object, got: {}",
                            path.string(), number, triangles, line));
        }
    }
    return layout;
}

/// Transforms all instances to world space and merges them by group. `group_of(object)` returns the
/// group's number, or nothing to omit the object.
template <class GroupOf>
std::map<size_t, Geometry> place(const Geometry &model, const Layout &layout,
                                 const GroupOf &group_of) {
    std::vector<int64_t> owner(model.triangles.size(), -1);
    for (size_t i = 0; i < layout.objects.size(); ++i) {
        std::fill_n(owner.begin() + static_cast<std::ptrdiff_t>(layout.objects[i].first),
                    layout.objects[i].count, static_cast<int64_t>(i));
    }
    const std::map<int64_t, Geometry> parts = split_geometry(model, owner);
    std::map<size_t, Geometry> placed;
    for (const auto &[object, to_world] : layout.instances) {
        const auto part =
            parts.find(static_cast<int64_t>(object));  // missing if it has no triangles
        const std::optional<size_t> group = group_of(layout.objects[object]);
        if (part != parts.end() && group) {
            append_geometry(placed[*group], part->second, to_world);
        }
    }
    return placed;
}

bool belongs_to(const std::string &object, SanMiguelPart part) {
    const auto is_one_of = [&](const std::vector<std::string> &kinds) {
        return std::any_of(kinds.begin(), kinds.end(), [&](const std::string &kind) {
            return object.rfind(kind + "_", 0) == 0;
        });
    };
    switch (part) {
        case SanMiguelPart::building_and_furniture:
            return is_one_of({"sanmiguel", "mesas_abajo", "mesas_arriba", "macetas"});
        case SanMiguelPart::building_and_plants:
            return is_one_of({"sanmiguel", "plantas"});
        default:
            return true;
    }
}

}  // namespace

test::Mesh load_san_miguel(const fs::path &model_file, const fs::path &instances,
                           SanMiguelPart part) {
    ModelNotes notes(model_file.string());
    Geometry model = read_gzipped_ply(model_file, notes);
    model.normals.clear();
    model.uvs.clear();
    const Layout layout = read_layout(instances, model.triangles.size());
    const Geometry whole = place(model, layout, [&](const Object &object) {
        return belongs_to(object.name, part) ? std::optional<size_t>(0) : std::nullopt;
    })[0];
    test::Mesh mesh{"san_miguel", {}, {}};
    mesh.positions.reserve(whole.vertices.size());
    for (const Eigen::Vector3d &vertex : whole.vertices) {
        mesh.positions.push_back(vertex.cast<float>());
    }
    mesh.triangles.assign(whole.triangles.begin(), whole.triangles.end());
    return mesh;
}

Scene load_san_miguel_scene(const fs::path &model_file, const fs::path &instances,
                            const fs::path &materials_file) {
    ModelNotes notes(model_file.string());
    Scene scene;
    const std::vector<std::shared_ptr<MaterialCore>> materials =
        read_model_materials(materials_file, scene, notes);
    const Geometry model = read_gzipped_ply(model_file, notes);
    const Layout layout = read_layout(instances, model.triangles.size());
    for (const Object &object : layout.objects) {
        if (object.material >= materials.size()) {
            throw input_error(fmt::format("{}: object '{}' has material {}, but {} has only {}",
                                          instances.string(), object.name, object.material,
                                          materials_file.string(), materials.size()));
        }
    }
    const auto material_of = [](const Object &object) {
        return std::optional<size_t>(object.material);
    };
    for (auto &[index, geometry] : place(model, layout, material_of)) {
        const std::string &name = materials[index]->name();
        Node &node = add_model_node(scene.graph().root(), name, Eigen::Matrix4d::Identity());
        node.set_core(materials[index]);
        node.set_core(std::make_shared<MeshCore>(name, std::move(geometry)));
    }
    notes.tell();
    return scene;
}

}  // namespace rtrays
