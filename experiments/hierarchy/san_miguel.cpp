// SPDX-License-Identifier: MIT
#include "experiments/hierarchy/san_miguel.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/base/files.h"
#include "renderer/import/model_file.h"

namespace rtrays {

namespace fs = std::filesystem;

namespace {

std::string read_gzip(const fs::path &path) {
    const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
    std::string content;
    std::string piece(1 << 20, '\0');
    for (;;) {
        const int bytes =
            file == nullptr ? -1 : gzread(file.get(), piece.data(), static_cast<unsigned>(piece.size()));
        if (bytes < 0) {
            throw input_error(fmt::format("{}: cannot be read as gzip", path.string()));
        }
        if (bytes == 0) {
            return content;
        }
        content.append(piece.data(), static_cast<size_t>(bytes));
    }
}

/// The model is read as any PLY file is, from a copy that lives as long as that takes.
std::shared_ptr<MeshCore> load_gzipped_ply(const fs::path &path) {
    const fs::path copy = fs::temp_directory_path() / (content_hash(path.string()) + ".rtrays.ply");
    write_file(copy, read_gzip(path));
    MeshFileOptions options;
    options.normals = MeshFileOptions::Normals::none;
    std::shared_ptr<MeshCore> mesh = load_mesh_file(copy, "san_miguel", options);
    fs::remove(copy);
    return mesh;
}

bool belongs_to(const std::string &object, SanMiguelPart part) {
    const auto is_one_of = [&](const std::vector<std::string> &kinds) {
        return std::any_of(kinds.begin(), kinds.end(),
                           [&](const std::string &kind) { return object.rfind(kind + "_", 0) == 0; });
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

/// One object with vertices of its own, empty where it is not wanted.
test::Mesh cut_out(const MeshCore &model, size_t first, size_t count) {
    test::Mesh object;
    std::vector<uint32_t> used;
    for (size_t i = first; i < first + count; ++i) {
        for (const uint32_t vertex : model.triangles()[i]) {
            used.push_back(vertex);
        }
    }
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (const uint32_t vertex : used) {
        object.positions.push_back(model.vertices()[vertex].cast<float>());
    }
    for (size_t i = first; i < first + count; ++i) {
        const auto place = [&](size_t corner) {
            const uint32_t vertex = model.triangles()[i][corner];
            return static_cast<uint32_t>(std::lower_bound(used.begin(), used.end(), vertex) - used.begin());
        };
        object.triangles.push_back({place(0), place(1), place(2)});
    }
    return object;
}

void add_instance(test::Mesh &mesh, const test::Mesh &object, const Eigen::Matrix<double, 3, 4> &to_world) {
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (const Eigen::Vector3f &p : object.positions) {
        mesh.positions.push_back((to_world * p.cast<double>().homogeneous()).cast<float>());
    }
    for (const auto &[a, b, c] : object.triangles) {
        mesh.triangles.push_back({first + a, first + b, first + c});
    }
}

}  // namespace

test::Mesh load_san_miguel(const fs::path &model_file, const fs::path &instances, SanMiguelPart part) {
    const std::shared_ptr<MeshCore> model = load_gzipped_ply(model_file);
    std::istringstream file(read_file(instances));
    std::vector<test::Mesh> objects;
    test::Mesh mesh{"san_miguel", {}, {}};
    size_t number = 1;
    for (std::string line; std::getline(file, line); ++number) {
        std::istringstream words(line);
        std::string what, name;
        size_t object = 0, first = 0, count = 0;
        words >> what;
        if (what.empty() || what.front() == '#') {
            continue;
        }
        words >> object;
        bool right = !words.fail();
        if (what == "object") {
            words >> name >> first >> count;
            right = right && !words.fail() && object == objects.size() &&
                    first + count <= model->triangles().size();
            if (right) {
                objects.push_back(belongs_to(name, part) ? cut_out(*model, first, count) : test::Mesh{});
            }
        } else {
            Eigen::Matrix<double, 3, 4> to_world;
            for (int i = 0; i < 12; ++i) {
                words >> to_world(i / 4, i % 4);
            }
            right = right && what == "instance" && !words.fail() && object < objects.size();
            if (right) {
                add_instance(mesh, objects[object], to_world);
            }
        }
        if (!right) {
            throw input_error(fmt::format("{}:{}: neither an object of {} nor an instance of one above: {}",
                                          instances.string(), number, model_file.string(), line));
        }
    }
    return mesh;
}

}  // namespace rtrays
